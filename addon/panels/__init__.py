# SPDX-License-Identifier: GPL-3.0-or-later
"""Sidebar and menus."""

from . import check, images, menus, painting, sidebar, transfer, viewing

CLASSES = (
    *menus.CLASSES, *sidebar.CLASSES, *viewing.CLASSES, *painting.CLASSES, *images.CLASSES, *transfer.CLASSES,
    *check.CLASSES,
)
