# SPDX-License-Identifier: GPL-3.0-or-later
"""Move Cone to Neighbour: the active cone along the mesh's edges, by arrow keys or clicks; Orbifold Live's Cancel."""

from __future__ import annotations

from typing import Optional

import bmesh
import bpy
from bpy.props import IntProperty
from bpy_extras.view3d_utils import location_3d_to_region_2d
from mathutils import Vector

from .. import cones, live, properties
from .cones import ConeOperator
from .jobs import mesh_problem

ARROWS = {"LEFT_ARROW": (-1, 0), "RIGHT_ARROW": (1, 0), "DOWN_ARROW": (0, -1), "UP_ARROW": (0, 1)}
ENDS = ("RET", "NUMPAD_ENTER", "ESC", "RIGHTMOUSE", "SPACE")
LEAST_COSINE = 0.3  # between an arrow and the edge that it means
HELP = "Move Cone to Neighbour: arrow keys or a click on a neighbouring vertex    Enter or Esc: Done"


def neighbours(mesh: bpy.types.Mesh, vertex: int) -> list[int]:
    """Where a cone can go from a vertex, in edit mode: along an edge, where there is no cone, and not onto or off the
    border, where it would be of another kind."""
    bm = bmesh.from_edit_mesh(mesh)
    bm.verts.ensure_lookup_table()
    taken = {item.vertex for item in mesh.orbifold.cones}
    here = bm.verts[vertex]
    edges = [edge for edge in here.link_edges if edge.is_boundary == here.is_boundary]
    found = [edge.other_vert(here) for edge in edges]
    return [other.index for other in found if other.is_boundary == here.is_boundary and other.index not in taken]


class MESH_OT_orbifold_slide_cone(ConeOperator, bpy.types.Operator):
    bl_idname = "mesh.orbifold_slide_cone"
    bl_label = "Move Cone to Neighbour"
    bl_description = (
        "Move the active cone along the edges of the mesh: by arrow keys, as they point on the screen, or by clicks on "
        "a neighbouring vertex, until Enter or Esc. Each move is one undo step"
    )
    edit_mode_only = True

    vertex: IntProperty(
        name="Vertex", description="The neighbouring vertex to move to; -1: by keys and clicks", default=-1, min=-1
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        mesh = context.active_object.data
        if not cones.mirror_is_valid(mesh):
            properties.sync(mesh)
        there = mesh.orbifold.cones
        active = min(mesh.orbifold.active_cone, len(there) - 1)
        if active < 0 or self.vertex not in neighbours(mesh, there[active].vertex):
            self.report({"ERROR"}, f"The cone cannot move to vertex {self.vertex}: choose a neighbour without a cone.")
            return {"CANCELLED"}
        _move(mesh, self.vertex)
        return {"FINISHED"}

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        if self.vertex >= 0 or bpy.app.background or context.window is None:
            return self.execute(context)
        self._area = _view(context)
        if self._area is None:
            self.report({"ERROR"}, "Open a 3D view: the cone is moved there.")
            return {"CANCELLED"}
        context.workspace.status_text_set(HELP)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        obj = context.active_object
        lost = obj is None or obj.mode != "EDIT" or not len(obj.data.orbifold.cones) or self._area.type != "VIEW_3D"
        if lost or (event.type in ENDS and event.value == "PRESS"):
            context.workspace.status_text_set(None)
            return {"CANCELLED"}  # the moves have their undo steps
        if event.value != "PRESS":
            return {"PASS_THROUGH"}
        region = next(region for region in self._area.regions if region.type == "WINDOW")
        mouse = Vector((event.mouse_x - region.x, event.mouse_y - region.y))
        if event.type in ARROWS:
            vertex = self._towards(obj, region, Vector(ARROWS[event.type]))
        elif event.type == "LEFTMOUSE" and 0 <= mouse.x < region.width and 0 <= mouse.y < region.height:
            vertex = self._nearest(obj, region, mouse)
        else:
            return {"PASS_THROUGH"}
        if vertex is not None:
            _move(obj.data, vertex)
            bpy.ops.ed.undo_push(message=self.bl_label)
            self._area.tag_redraw()
        return {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        context.workspace.status_text_set(None)

    def _towards(self, obj: bpy.types.Object, region: bpy.types.Region, arrow: Vector) -> Optional[int]:
        """The neighbour that lies most in the direction of an arrow."""
        at, others = self._seen(obj, region)
        best = max(others, key=lambda pair: _cosine(pair[1] - at, arrow), default=None)
        return best[0] if best is not None and _cosine(best[1] - at, arrow) >= LEAST_COSINE else None

    def _nearest(self, obj: bpy.types.Object, region: bpy.types.Region, mouse: Vector) -> Optional[int]:
        """The neighbour that was clicked: nearer than the cone itself."""
        at, others = self._seen(obj, region)
        best = min(others, key=lambda pair: (pair[1] - mouse).length, default=None)
        return best[0] if best is not None and (best[1] - mouse).length < (at - mouse).length else None

    def _seen(self, obj: bpy.types.Object, region: bpy.types.Region) -> tuple[Vector, list[tuple[int, Vector]]]:
        """The active cone's place on the screen, and those of its neighbours."""
        mesh, view = obj.data, self._area.spaces.active.region_3d
        vertices = bmesh.from_edit_mesh(mesh).verts
        vertices.ensure_lookup_table()
        item = mesh.orbifold.cones[min(mesh.orbifold.active_cone, len(mesh.orbifold.cones) - 1)]

        def place(vertex: int) -> Optional[Vector]:
            return location_3d_to_region_2d(region, view, obj.matrix_world @ vertices[vertex].co)

        found = [(vertex, place(vertex)) for vertex in neighbours(mesh, item.vertex)]
        return place(item.vertex) or Vector((0, 0)), [pair for pair in found if pair[1] is not None]


def _cosine(step: Vector, arrow: Vector) -> float:
    return step.dot(arrow) / step.length if step.length > 1e-6 else -1.0


def _view(context: bpy.types.Context) -> Optional[bpy.types.Area]:
    """The 3D view that the operator was called in, or the first one."""
    if context.area is not None and context.area.type == "VIEW_3D":
        return context.area
    return next((area for area in context.screen.areas if area.type == "VIEW_3D"), None)


def _move(mesh: bpy.types.Mesh, vertex: int) -> None:
    """The active cone to a neighbour. Orders and signature stay, for nothing passes a cone."""
    there = [cones.Cone(item.vertex, item.order) for item in mesh.orbifold.cones]
    active = min(mesh.orbifold.active_cone, len(there) - 1)
    there[active] = cones.Cone(vertex, there[active].order)
    live.expect(mesh)
    cones.write_cones(mesh, there)
    mesh.orbifold.active_cone = active
    properties.tell(mesh)


class MESH_OT_orbifold_cancel_live(bpy.types.Operator):
    bl_idname = "mesh.orbifold_cancel_live"
    bl_label = "Cancel Orbifold Live"
    bl_description = "Give up what Orbifold Live computes; the UVs stay as they are until the next change"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        problem = mesh_problem(context)
        if problem is None and live.progress(context.active_object.data) is None:
            problem = "Orbifold Live computes nothing now"
        if problem is not None:
            cls.poll_message_set(problem)
        return problem is None

    def execute(self, _context: bpy.types.Context) -> set[str]:
        live.cancel()
        return {"FINISHED"}


CLASSES = (MESH_OT_orbifold_slide_cone, MESH_OT_orbifold_cancel_live)
