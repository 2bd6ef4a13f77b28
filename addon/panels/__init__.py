# SPDX-License-Identifier: GPL-3.0-or-later
"""Sidebar and menus."""

from . import check, menus, sidebar, viewing

CLASSES = (*menus.CLASSES, *sidebar.CLASSES, *viewing.CLASSES, *check.CLASSES)
