# SPDX-License-Identifier: GPL-3.0-or-later
"""Check Mesh in the sidebar: what was found, a row for each kind, which selects its elements, with its mend."""

from __future__ import annotations

import bpy

from .. import checking
from ..operators.jobs import mesh_problem


class CheckPanel:
    """Mix-in: below the tab's panel, in two editors."""

    bl_label = "Check Mesh"
    bl_category = "Orbifold"
    bl_region_type = "UI"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return mesh_problem(context) is None

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        mesh = context.active_object.data
        table = mesh.orbifold.check
        layout.operator("mesh.orbifold_check", icon="VIEWZOOM")
        if not table.done:
            return
        if checking.is_stale(mesh):
            layout.label(text="The mesh has changed: check again", icon="ERROR")
        if not len(table.rows):
            layout.label(text="Nothing stands in the way", icon="CHECKMARK")
        for row in table.rows:  # one below the other: side by side they are cut off where the sidebar is narrow
            column = layout.column(align=True)
            icon = "ERROR" if row.blocks else "INFO"
            column.operator("mesh.orbifold_show_defect", text=row.text, icon=icon).kind = row.kind
            if row.kind in checking.MENDS:
                mend = column.operator("mesh.orbifold_mend", text=checking.MENDS[row.kind].label)
                mend.kind = row.kind


class VIEW3D_PT_orbifold_check(CheckPanel, bpy.types.Panel):
    bl_idname = "VIEW3D_PT_orbifold_check"
    bl_space_type = "VIEW_3D"
    bl_parent_id = "VIEW3D_PT_orbifold"


class IMAGE_PT_orbifold_check(CheckPanel, bpy.types.Panel):
    bl_idname = "IMAGE_PT_orbifold_check"
    bl_space_type = "IMAGE_EDITOR"
    bl_parent_id = "IMAGE_PT_orbifold"


CLASSES = (VIEW3D_PT_orbifold_check, IMAGE_PT_orbifold_check)
