# SPDX-License-Identifier: GPL-3.0-or-later
"""The part `Transfer` of the tab `Orbifold`: source and targets with their landmarks, and what is transferred."""

from __future__ import annotations

import bpy

from .. import transfer_settings
from ..operators.jobs import mesh_problem
from ..operators.transfer import targets_of


ROWS = 16  # landmarks that are listed at most


class VIEW3D_PT_orbifold_transfer(bpy.types.Panel):
    bl_idname = "VIEW3D_PT_orbifold_transfer"
    bl_label = "Transfer"
    bl_category = "Orbifold"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return mesh_problem(context) is None

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        settings = context.scene.orbifold_transfer
        source, targets = context.active_object, targets_of(context)
        draw_meshes(layout, source, targets)
        if targets:
            draw_landmarks(layout, source, targets[0])
        layout.operator("object.orbifold_suggest_order", icon="SORTSIZE")
        column = layout.column(align=True)
        column.label(text="Orbifold (empty: automatic)")
        column.prop(settings, "signature", text="")
        column = layout.column(align=True)
        for name in transfer_settings.NAMES:
            if name != "signature":
                transfer_settings.draw(column, settings, name)
        row = layout.row()
        row.scale_y = 1.3
        button = row.operator("object.orbifold_transfer")
        for name in transfer_settings.NAMES:
            setattr(button, name, getattr(settings, name))


def draw_meshes(
    layout: bpy.types.UILayout, source: bpy.types.Object, targets: list[bpy.types.Object]
) -> None:
    """A row for each mesh with the number of its landmarks, red where it is not that of the source."""
    wanted = len(source.data.orbifold.cones)
    column = layout.column(align=True)
    for obj, icon in ((source, "EXPORT"), *((target, "IMPORT") for target in targets)):
        count = len(obj.data.orbifold.cones)
        row = column.row()
        row.alert = count != wanted or not count
        split = row.split(factor=0.55)
        split.label(text=obj.name, icon=icon)
        split.label(text="1 landmark" if count == 1 else f"{count} landmarks")
    if not targets:
        column.label(text="Select the target meshes too", icon="INFO")


def draw_landmarks(layout: bpy.types.UILayout, source: bpy.types.Object, target: bpy.types.Object) -> None:
    """Those that correspond side by side, as vertices; red where one is missing."""
    lists = [[str(item.vertex) for item in obj.data.orbifold.cones] for obj in (source, target)]
    longest = max(map(len, lists))
    column = layout.column(align=True)
    for number in range(min(longest, ROWS)):
        row = column.row()
        texts = [own[number] if number < len(own) else "missing" for own in lists]
        row.alert = "missing" in texts
        split = row.split(factor=0.5)
        split.label(text=f"{number + 1}.  {texts[0]}")
        split.label(text=texts[1])
    if longest > ROWS:
        column.label(text=f"and {longest - ROWS} more")


CLASSES = (VIEW3D_PT_orbifold_transfer,)
