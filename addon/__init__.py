# SPDX-License-Identifier: GPL-3.0-or-later
"""Orbifold UV for Blender: registration, and the names of api.py for scripts. Where to read next: unwrapping.py."""

bl_info = {
    "name": "Orbifold UV",
    "author": "The Orbifold UV authors",
    "version": (0, 2, 0),
    "blender": (3, 4, 0),
    "location": "UV menu > Orbifold Unwrap; Sidebar > Orbifold",
    "description": "Seamless UV maps without flips, by orbifold embeddings, with a proof for each",
    "category": "UV",
}

import bpy

from . import (
    cli, handlers, image_edits, live, operators, painting, panels, preferences, previews, properties, surface,
    transfer_settings, viewing,
)
from .api import OrbifoldError, check, sphere, suggest, transfer, unwrap
from .panels import menus

__all__ = ["OrbifoldError", "check", "sphere", "suggest", "transfer", "unwrap"]

CLASSES = (*preferences.CLASSES, *operators.CLASSES, *panels.CLASSES)


def register() -> None:
    properties.register()
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    menus.register()
    handlers.register()
    image_edits.register()
    viewing.register()
    transfer_settings.register()
    live.register()
    painting.register()
    cli.register()


def unregister() -> None:
    cli.unregister()
    painting.unregister()
    live.unregister()
    transfer_settings.unregister()
    viewing.unregister()
    image_edits.unregister()
    handlers.unregister()
    menus.unregister()
    previews.clear()
    surface.forget()
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
    properties.unregister()
