# SPDX-License-Identifier: GPL-3.0-or-later
"""Check Mesh: what stands in the way of unwrapping, counted and selected; Show and Mend, for the rows of its list."""

from __future__ import annotations

from collections.abc import Sequence

import bpy
from bpy.props import EnumProperty, FloatProperty

from .. import blender_mesh, checking, core
from ..core.defects import KINDS
from .jobs import mesh_problem

KIND_ITEMS = tuple((kind, words[1][:1].upper() + words[1][1:], "") for kind, words in KINDS.items())
MEND_ITEMS = tuple(
    (kind, f"{tool.label}: {KINDS[kind][1]}", tool.description) for kind, tool in checking.MENDS.items()
)


class CheckOperator:
    """Mix-in: the active mesh, in edit and object mode."""

    bl_options = {"REGISTER", "UNDO"}
    needs_rows = True

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        problem = mesh_problem(context)
        if problem is None and cls.needs_rows and not len(context.active_object.data.orbifold.check.rows):
            problem = "There is nothing in the list: use Check Mesh first"
        if problem is not None:
            cls.poll_message_set(problem)
        return problem is None


def sentence(found: Sequence[core.Defect]) -> str:
    """Without a full stop."""
    blocking = [defect.text for defect in found if defect.blocks]
    others = [defect.text for defect in found if not defect.blocks]
    if not found:
        return "nothing stands in the way of unwrapping"
    said = f"{', '.join(blocking)}: to be mended first" if blocking else "nothing has to be mended"
    return said + (f"; also {', '.join(others)}" if others else "")


class MESH_OT_orbifold_check(CheckOperator, bpy.types.Operator):
    bl_idname = "mesh.orbifold_check"
    bl_label = "Check Mesh"
    bl_description = (
        "Count what stands in the way of unwrapping, and select all of it: non-manifold edges and vertices, flipped, "
        "repeated and zero-area faces, borders, components, isolated vertices. The sidebar lists it, with a mend for "
        "each kind"
    )
    needs_rows = False

    def execute(self, context: bpy.types.Context) -> set[str]:
        said, blocked = [], False
        objects = blender_mesh.edited(context)
        with blender_mesh.object_mode(context.active_object):
            for obj in objects:
                found = checking.defects_of(obj.data)
                checking.keep(obj.data, found)
                checking.select(context, obj.data, found)
                said.append(f"{obj.name}: {sentence(found)}.")
                blocked |= any(defect.blocks for defect in found)
        self.report({"WARNING" if blocked else "INFO"}, " ".join(said))
        return {"FINISHED"}


class MESH_OT_orbifold_show_defect(CheckOperator, bpy.types.Operator):
    bl_idname = "mesh.orbifold_show_defect"
    bl_label = "Show Defect"
    bl_description = "Go to edit mode and select all elements of this kind, and nothing else"

    kind: EnumProperty(name="Kind", description="What to select", items=KIND_ITEMS, default="edge")

    def execute(self, context: bpy.types.Context) -> set[str]:
        obj = context.active_object
        with blender_mesh.object_mode(obj):
            found = checking.defects_of(obj.data)
            checking.keep(obj.data, found)
            chosen = [defect for defect in found if defect.kind == self.kind]
            if chosen:
                checking.select(context, obj.data, chosen)
        if not chosen:
            self.report({"INFO"}, f"There are no {KINDS[self.kind][1]} any more.")
            return {"CANCELLED"}
        said = f"{chosen[0].text[:1].upper()}{chosen[0].text[1:]}"
        if obj.mode != "EDIT" and not blender_mesh.is_safe_to_edit(obj.data):
            self.report({"WARNING"}, f"{said}. Blender may hang if this mesh goes to edit mode: use Validate first.")
            return {"FINISHED"}
        if obj.mode != "EDIT":
            bpy.ops.object.mode_set(mode="EDIT")
        self.report({"INFO"}, f"{said}.")
        return {"FINISHED"}


class MESH_OT_orbifold_mend(CheckOperator, bpy.types.Operator):
    bl_idname = "mesh.orbifold_mend"
    bl_label = "Mend"
    bl_description = "Blender's own remedy, applied to all elements of this kind; then the mesh is checked again"

    kind: EnumProperty(name="Mend", description="Which remedy, and for what", items=MEND_ITEMS, default="flipped")
    distance: FloatProperty(
        name="Distance", description="Vertices that are nearer to one another are taken for one", default=1e-4,
        min=1e-6, soft_max=1.0, precision=5, subtype="DISTANCE",
    )

    @classmethod
    def description(cls, _context: bpy.types.Context, settings) -> str:
        return f"{checking.MENDS[settings.kind].description}; then check the mesh again"

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "kind")
        if checking.MENDS[self.kind].uses_distance:
            layout.prop(self, "distance")

    def execute(self, context: bpy.types.Context) -> set[str]:
        obj = context.active_object
        with blender_mesh.object_mode(obj):
            count = checking.mend(obj, self.kind, self.distance)
            found = checking.defects_of(obj.data)
            checking.keep(obj.data, found)
            checking.select(context, obj.data, found)
        if not count:
            self.report({"INFO"}, f"There are no {KINDS[self.kind][1]} any more.")
            return {"CANCELLED"}
        left = next((defect for defect in found if defect.kind == self.kind), None)
        told = f"{left.text} left; mend these by hand. Now: " if left is not None else ""
        self.report({"WARNING" if left is not None else "INFO"},
                    f"{checking.MENDS[self.kind].label}: {told}{sentence(found)}.")
        return {"FINISHED"}


CLASSES = (MESH_OT_orbifold_check, MESH_OT_orbifold_show_defect, MESH_OT_orbifold_mend)
