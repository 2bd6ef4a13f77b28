# SPDX-License-Identifier: GPL-3.0-or-later
"""Sidebar and menus."""

from . import check, menus, sidebar

CLASSES = (*menus.CLASSES, *sidebar.CLASSES, *check.CLASSES)
