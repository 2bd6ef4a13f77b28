# SPDX-License-Identifier: GPL-3.0-or-later
"""Sidebar and menus."""

from . import menus, sidebar

CLASSES = (*menus.CLASSES, *sidebar.CLASSES)
