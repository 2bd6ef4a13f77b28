# SPDX-License-Identifier: GPL-3.0-or-later
"""Picking cones in edit mode, and the buttons beside their list."""

from __future__ import annotations

import bmesh
import bpy
from bpy.props import BoolProperty, EnumProperty, IntProperty, StringProperty

from .. import cones, properties, suggestions
from .jobs import mesh_problem


class ConeOperator:
    """Mix-in: operators on a mesh that has cones, in edit and object mode."""

    bl_options = {"REGISTER", "UNDO"}
    edit_mode_only = False
    needs_cones = True

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        problem = mesh_problem(context, ("EDIT",) if cls.edit_mode_only else ("EDIT", "OBJECT"))
        if problem is None and cls.needs_cones and not len(context.active_object.data.orbifold.cones):
            problem = "The mesh has no cones: select vertices in edit mode and use Add Cones"
        if problem is not None:
            cls.poll_message_set(problem)
        return problem is None


def picked_vertices(bm: bmesh.types.BMesh) -> list[int]:
    """Selected vertices: first those that were clicked, in that order, then the others by index."""
    bm.verts.index_update()
    history = [v.index for v in list(bm.select_history) if isinstance(v, bmesh.types.BMVert) and v.select]
    clicked = set(history)
    return history + [v.index for v in bm.verts if v.select and v.index not in clicked]


class MESH_OT_orbifold_add_cones(ConeOperator, bpy.types.Operator):
    bl_idname = "mesh.orbifold_add_cones"
    bl_label = "Add Cones"
    bl_description = (
        "Append the selected vertices to the mesh's cones, in the order in which they were clicked. Vertices on the "
        "mesh's border are mirror corners. The seams will run through the cones in the sequence of the list"
    )
    edit_mode_only = True
    needs_cones = False

    def execute(self, context: bpy.types.Context) -> set[str]:
        mesh = context.active_object.data
        bm = bmesh.from_edit_mesh(mesh)
        cones.ensure_layers(bm)
        there = cones.read_cones(mesh)
        known = {cone.vertex for cone in there}
        selected = picked_vertices(bm)
        added = [vertex for vertex in selected if vertex not in known]
        if not added:
            reason = "The selected vertices are cones already" if selected else "Select vertices first"
            self.report({"WARNING"}, f"{reason}; nothing was added.")
            return {"CANCELLED"}
        if len(there) + len(added) > cones.MAX_CONES:
            self.report({"ERROR"}, f"A mesh holds at most {cones.MAX_CONES} cones; {len(added)} vertices are selected.")
            return {"CANCELLED"}
        vertices = [cone.vertex for cone in there] + added
        properties.set_cones(mesh, vertices, [cone.order for cone in there] + [None] * len(added))
        mesh.orbifold.active_cone = len(vertices) - 1
        return {"FINISHED"}


class MESH_OT_orbifold_remove_cone(ConeOperator, bpy.types.Operator):
    bl_idname = "mesh.orbifold_remove_cone"
    bl_label = "Remove Cone"
    bl_description = "Take the chosen cone off the list. The vertex itself stays"

    index: IntProperty(name="Index", description="Place in the list, -1 for the active one", default=-1, min=-1)

    def execute(self, context: bpy.types.Context) -> set[str]:
        mesh = context.active_object.data
        there = cones.read_cones(mesh)
        index = self.index if self.index >= 0 else mesh.orbifold.active_cone
        if index >= len(there):
            self.report({"ERROR"}, f"There are only {len(there)} cones.")
            return {"CANCELLED"}
        _replace(mesh, there[:index] + there[index + 1 :])
        mesh.orbifold.active_cone = max(0, min(index, len(there) - 2))
        return {"FINISHED"}


class MESH_OT_orbifold_clear_cones(ConeOperator, bpy.types.Operator):
    bl_idname = "mesh.orbifold_clear_cones"
    bl_label = "Clear Cones"
    bl_description = "Take all cones off the list. The signature stays, for new ones"

    def execute(self, context: bpy.types.Context) -> set[str]:
        cones.write_cones(context.active_object.data, [])
        suggestions.forget_replaced(context.active_object.data)
        return {"FINISHED"}


class MESH_OT_orbifold_move_cone(ConeOperator, bpy.types.Operator):
    bl_idname = "mesh.orbifold_move_cone"
    bl_label = "Move Cone"
    bl_description = "Exchange the chosen cone, with its order, with its neighbour in the list"

    direction: EnumProperty(
        name="Direction",
        items=(("UP", "Up", "Towards the start of the list"), ("DOWN", "Down", "Towards the end of the list")),
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        mesh = context.active_object.data
        there = cones.read_cones(mesh)
        index = mesh.orbifold.active_cone
        other = index + (1 if self.direction == "DOWN" else -1)
        if not 0 <= other < len(there):
            return {"CANCELLED"}
        there[index], there[other] = there[other], there[index]
        _replace(mesh, there)
        mesh.orbifold.active_cone = other
        return {"FINISHED"}


class MESH_OT_orbifold_jump_to_cone(ConeOperator, bpy.types.Operator):
    bl_idname = "mesh.orbifold_jump_to_cone"
    bl_label = "Jump to Cone"
    bl_description = "Select the chosen cone's vertex, and nothing else, and bring it into view"
    edit_mode_only = True

    index: IntProperty(name="Index", description="Place in the list, -1 for the active one", default=-1, min=-1)
    frame: BoolProperty(name="Bring into View", description="Move the 3D view to the vertex", default=True)

    def execute(self, context: bpy.types.Context) -> set[str]:
        mesh = context.active_object.data
        there = cones.read_cones(mesh)
        index = self.index if self.index >= 0 else mesh.orbifold.active_cone
        if index >= len(there):
            self.report({"ERROR"}, f"There are only {len(there)} cones.")
            return {"CANCELLED"}
        mesh.orbifold.active_cone = index
        context.tool_settings.mesh_select_mode = (True, False, False)
        bm = bmesh.from_edit_mesh(mesh)
        for element in (*bm.faces, *bm.edges, *bm.verts):
            element.select = False
        bm.select_history.clear()
        bm.verts.ensure_lookup_table()
        vertex = bm.verts[there[index].vertex]
        vertex.hide = False
        vertex.select = True
        bm.select_history.add(vertex)
        bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
        if self.frame and context.area is not None and context.area.type == "VIEW_3D":
            region = next(r for r in context.area.regions if r.type == "WINDOW")
            with context.temp_override(region=region):
                if bpy.ops.view3d.view_selected.poll():
                    bpy.ops.view3d.view_selected()
        return {"FINISHED"}


class MESH_OT_orbifold_set_signature(ConeOperator, bpy.types.Operator):
    bl_idname = "mesh.orbifold_set_signature"
    bl_label = "Set Signature"
    bl_description = "Use this signature: the cones take its orders in the sequence of the list"
    needs_cones = False

    signature: StringProperty(name="Signature")

    @classmethod
    def description(cls, _context: bpy.types.Context, settings) -> str:
        return f"Use the signature {settings.signature}: the cones take these orders in the sequence of the list"

    def execute(self, context: bpy.types.Context) -> set[str]:
        context.active_object.data.orbifold.signature = self.signature
        return {"FINISHED"}


def _replace(mesh: bpy.types.Mesh, chosen: list[cones.Cone]) -> None:
    properties.set_cones(mesh, [cone.vertex for cone in chosen], [cone.order for cone in chosen])


CLASSES = (
    MESH_OT_orbifold_add_cones,
    MESH_OT_orbifold_remove_cone,
    MESH_OT_orbifold_clear_cones,
    MESH_OT_orbifold_move_cone,
    MESH_OT_orbifold_jump_to_cone,
    MESH_OT_orbifold_set_signature,
)
