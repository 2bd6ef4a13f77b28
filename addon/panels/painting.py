# SPDX-License-Identifier: GPL-3.0-or-later
"""The part `Painting` of the tab `Orbifold`: images with the symmetry of the layout."""

from __future__ import annotations

import bpy

from .. import painting
from .sidebar import wrapped


class PaintingPanel:
    """Mix-in: one panel in two editors."""

    bl_label = "Painting"
    bl_category = "Orbifold"
    bl_region_type = "UI"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.active_object is not None and context.active_object.type == "MESH"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        column = layout.column(align=True)
        column.prop(context.window_manager, "orbifold_symmetric_painting", toggle=True, icon="BRUSH_DATA")
        image = painting.image_in(context)
        problem = painting.problem(image) if image is not None else None
        if problem is not None:
            scale = context.preferences.system.ui_scale or 1.0
            for number, line in enumerate(wrapped(problem, max(16, int(context.region.width / (7.5 * scale)) - 4))):
                column.label(text=line, icon="BLANK1" if number else "ERROR")
        layout.operator_menu_enum("image.orbifold_symmetrize", "source", icon="MOD_MIRROR")
        layout.operator("image.orbifold_new", icon="ADD")


class VIEW3D_PT_orbifold_painting(PaintingPanel, bpy.types.Panel):
    bl_idname = "VIEW3D_PT_orbifold_painting"
    bl_space_type = "VIEW_3D"


class IMAGE_PT_orbifold_painting(PaintingPanel, bpy.types.Panel):
    bl_idname = "IMAGE_PT_orbifold_painting"
    bl_space_type = "IMAGE_EDITOR"


CLASSES = (VIEW3D_PT_orbifold_painting, IMAGE_PT_orbifold_painting)
