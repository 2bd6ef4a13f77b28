# SPDX-License-Identifier: GPL-3.0-or-later
"""Sidebar and menus."""

from . import menus, sidebar, viewing

CLASSES = (*menus.CLASSES, *sidebar.CLASSES, *viewing.CLASSES)
