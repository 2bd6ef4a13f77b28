# SPDX-License-Identifier: GPL-3.0-or-later
"""What the user wants to see, kept with the scene."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty, EnumProperty, PointerProperty, StringProperty

from . import formulas, overlay

PATTERNS = (
    ("RINGS", "Rings", "For every orbifold: rings about the cones, an image that is made for the layout"),
    *((key, pattern.name, pattern.description) for key, pattern in formulas.PATTERNS.items()),
)


def _changed(_settings: "OrbifoldView", _context: bpy.types.Context) -> None:
    overlay.redraw()


class OrbifoldView(bpy.types.PropertyGroup):
    """Kept on the scene, and saved with it."""

    show_cones: BoolProperty(
        name="Cones",
        description="Draw the cones of all visible meshes in the 3D view, in the colours of the pattern and with their "
        "orders; in edit mode in the UV editor too",
        default=True,
        update=_changed,
    )
    show_cut: BoolProperty(
        name="Cut",
        description="Draw the cut of the last unwrap, or the landmark paths of the last transfer. A "
        "path on the mesh is two sides of the tile that are glued: in the UV editor, in edit mode, both have the "
        "path's colour",
        default=True,
        update=_changed,
    )
    pattern: EnumProperty(name="Pattern", description="What Pattern Material shows", items=PATTERNS)
    colour_types: StringProperty(options={"HIDDEN"})  # of the 3D views before a heat map (heat.py)


CLASSES = (OrbifoldView,)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Scene.orbifold_view = PointerProperty(type=OrbifoldView)
    overlay.register()


def unregister() -> None:
    overlay.unregister()
    del bpy.types.Scene.orbifold_view
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
