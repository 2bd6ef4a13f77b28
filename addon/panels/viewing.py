# SPDX-License-Identifier: GPL-3.0-or-later
"""The part `Show` of the tab `Orbifold`: what is drawn over the mesh and the layout."""

from __future__ import annotations

import bpy

from .. import heat, live
from ..operators.jobs import mesh_problem
from .sidebar import wrapped


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
        draw_live(layout, context)
        draw_heat(layout, context.active_object.data)
        layout.operator("object.orbifold_tile_preview", icon="MOD_ARRAY")
        column = layout.column(align=True)
        column.prop(settings, "pattern", text="")
        column.operator("object.orbifold_pattern", icon="MATERIAL")


def draw_live(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    mesh = context.active_object.data
    column = layout.column(align=True)
    column.prop(context.window_manager, "orbifold_live", toggle=True, icon="REC")
    column.operator("mesh.orbifold_slide_cone", icon="EMPTY_ARROWS").vertex = -1
    done = live.progress(mesh)
    if done is not None:
        row = column.row(align=True)
        row.label(text=f"Computing: {done:.0%}")
        row.operator("mesh.orbifold_cancel_live", text="Cancel", icon="CANCEL")
    problem = live.problem(mesh)
    if problem is not None:
        scale = context.preferences.system.ui_scale or 1.0
        for number, line in enumerate(wrapped(problem, max(16, int(context.region.width / (7.5 * scale)) - 4))):
            column.label(text=line, icon="BLANK1" if number else "ERROR")


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
