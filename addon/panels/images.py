# SPDX-License-Identifier: GPL-3.0-or-later
"""The part `Images` of the tab `Orbifold`: images to start from, and what makes them ready for other programs."""

from __future__ import annotations

import bpy

from ..operators.jobs import mesh_problem


class ImagesPanel:
    """Mix-in: one panel in two editors."""

    bl_label = "Images"
    bl_category = "Orbifold"
    bl_region_type = "UI"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return mesh_problem(context, ("EDIT", "OBJECT", "TEXTURE_PAINT")) is None

    def draw(self, context: bpy.types.Context) -> None:
        draw_starting(self.layout, context)
        draw_finishing(self.layout)


def draw_starting(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    column = layout.column(align=True)
    column.prop(context.scene.orbifold_view, "pattern", text="")
    column.operator("object.orbifold_pattern_image", icon="TEXTURE")
    layout.operator("image.orbifold_wallpaper", icon="IMAGE_DATA")


def draw_finishing(layout: bpy.types.UILayout) -> None:
    column = layout.column(align=True)
    column.operator("image.orbifold_fill_seam_margin", icon="UV_ISLANDSEL")
    column.operator("object.orbifold_bake", icon="RENDER_STILL")


class VIEW3D_PT_orbifold_images(ImagesPanel, bpy.types.Panel):
    bl_idname = "VIEW3D_PT_orbifold_images"
    bl_space_type = "VIEW_3D"


class IMAGE_PT_orbifold_images(ImagesPanel, bpy.types.Panel):
    bl_idname = "IMAGE_PT_orbifold_images"
    bl_space_type = "IMAGE_EDITOR"


CLASSES = (VIEW3D_PT_orbifold_images, IMAGE_PT_orbifold_images)
