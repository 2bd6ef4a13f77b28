# SPDX-License-Identifier: GPL-3.0-or-later
"""The part `Show` of the tab `Orbifold`: what is drawn over the mesh and the layout."""

from __future__ import annotations

import bpy

from .. import heat
from ..operators.jobs import mesh_problem


class ShowPanel:
    """Mix-in: one panel in two editors."""

    bl_label = "Show"
    bl_category = "Orbifold"
    bl_region_type = "UI"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        settings = context.scene.orbifold_view
        row = layout.row(align=True)
        row.prop(settings, "show_cones", toggle=True, icon="VERTEXSEL")
        row.prop(settings, "show_cut", toggle=True, icon="EDGESEL")
        if mesh_problem(context) is not None:
            return
        draw_heat(layout, context.active_object.data)
        layout.operator("object.orbifold_tile_preview", icon="MOD_ARRAY")


def draw_heat(layout: bpy.types.UILayout, mesh: bpy.types.Mesh) -> None:
    layout.label(text="Heat Map of the Distortion")
    row = layout.row(align=True)
    shown = heat.shown(mesh)
    for measure, name, text in ((heat.ANGLE, "ANGLE", "Angles"), (heat.AREA, "AREA", "Areas")):
        row.operator("mesh.orbifold_show_distortion", text=text, depress=shown is measure).measure = name
    row.operator("mesh.orbifold_hide_distortion", text="", icon="X")


class VIEW3D_PT_orbifold_show(ShowPanel, bpy.types.Panel):
    bl_idname = "VIEW3D_PT_orbifold_show"
    bl_space_type = "VIEW_3D"


class IMAGE_PT_orbifold_show(ShowPanel, bpy.types.Panel):
    bl_idname = "IMAGE_PT_orbifold_show"
    bl_space_type = "IMAGE_EDITOR"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.space_data.mode == "UV" or context.space_data.show_uvedit


CLASSES = (VIEW3D_PT_orbifold_show, IMAGE_PT_orbifold_show)
