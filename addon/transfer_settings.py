# SPDX-License-Identifier: GPL-3.0-or-later
"""What is ticked for Orbifold Transfer: the same in the redo panel and, kept with the scene, in the sidebar."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty, PointerProperty, StringProperty

GROUPS = dict(
    name="Vertex Groups", default=True,
    description="Weights, interpolated, by the groups' names. Groups that are locked on a target stay as they are",
)
COLOURS = dict(name="Colours", default=True, description="Colour attributes, of vertices and of face corners")
ATTRIBUTES = dict(
    name="Attributes", default=True,
    description="All other attributes of vertices, face corners and faces: numbers and vectors are interpolated, whole "
    "numbers and booleans are those of the nearest vertex. A face gets what the source's face at its middle has",
)
UV_MAPS = dict(
    name="UV Maps", default=True,
    description="Faces that a seam of the source runs through continue the island of their middle, and are selected",
)
CUT_SEAMS = dict(
    name="Cut Faces at Seams", default=False,
    description="Cut the targets' faces where seams of the source's UV maps run through them, so that the UV maps are "
    "right everywhere. The targets get new vertices and faces, and seams there",
)
TEXTURE = dict(
    name="Image Texture", default=False,
    description="Bake the image of the source's active material to the active UV map of each target, texel by texel: "
    "an image of the same size, in a copy of the material. No seam of either mesh shows",
)
FORM = dict(
    name="Form as a Shape Key", default=False,
    description="Give each target a shape key that takes the form of the source, in object coordinates",
)
FORM_BACK = dict(
    name="Form Back as a Shape Key", default=False,
    description="Give the source a shape key for each target that takes its form, in object coordinates",
)
SHAPE_KEYS = dict(
    name="Shape Keys", default=False,
    description="The source's shape keys as displacements of the target, turned with its surface and as large as it is",
)
HEAT = dict(
    name="Heat Map of Angles", default=False,
    description="Colour each target by the angle distortion of its map, as the colour attribute Orbifold Map",
)
HEAT_AREA = dict(
    name="Heat Map of Areas", default=False,
    description="Colour each target by the area distortion of its map, as the colour attribute Orbifold Map Area: red "
    "where what comes over becomes larger, blue where smaller, beside the scale of the whole. With both heat maps this "
    "one is shown",
)
SIGNATURE = dict(
    name="Orbifold",
    description="The signature with which all meshes are embedded, with as many numbers as there are landmarks. Empty: "
    "333 for three landmarks, 2222 for four in the plane, and cones of order 2 in the hyperbolic plane for more",
)
NAMES = (
    "groups", "colours", "attributes", "uv_maps", "cut_seams", "texture", "form", "form_back", "shape_keys", "heat",
    "heat_area", "signature",
)


def draw(layout: bpy.types.UILayout, settings: bpy.types.bpy_struct, name: str) -> None:
    """One of NAMES, grey where it has no effect."""
    row = layout.row()
    if name == "cut_seams":
        row.enabled = settings.uv_maps
    row.prop(settings, name)


class OrbifoldTransfer(bpy.types.PropertyGroup):
    """Kept on the scene, and saved with it."""

    groups: BoolProperty(**GROUPS)
    colours: BoolProperty(**COLOURS)
    attributes: BoolProperty(**ATTRIBUTES)
    uv_maps: BoolProperty(**UV_MAPS)
    cut_seams: BoolProperty(**CUT_SEAMS)
    texture: BoolProperty(**TEXTURE)
    form: BoolProperty(**FORM)
    form_back: BoolProperty(**FORM_BACK)
    shape_keys: BoolProperty(**SHAPE_KEYS)
    heat: BoolProperty(**HEAT)
    heat_area: BoolProperty(**HEAT_AREA)
    signature: StringProperty(**SIGNATURE)


CLASSES = (OrbifoldTransfer,)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Scene.orbifold_transfer = PointerProperty(type=OrbifoldTransfer)


def unregister() -> None:
    del bpy.types.Scene.orbifold_transfer
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
