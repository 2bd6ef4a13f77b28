# SPDX-License-Identifier: GPL-3.0-or-later
"""Seeing a layout: the heat map of its distortion, the tile among its copies, patterns."""

from __future__ import annotations

import bpy
import numpy as np
from bpy.props import EnumProperty

from .. import blender_mesh, heat, layouts, materials, procedural, tile_copies, tile_preview, viewing
from .jobs import WithProblem, mesh_problem, report_failure


def layout_problem(context: bpy.types.Context) -> str | None:
    """Why there is no layout to show; None where there may be one."""
    problem = mesh_problem(context)
    if problem is None and not layouts.has_layout(context.active_object.data):
        problem = "The mesh has no layout yet: use Orbifold Unwrap first"
    return problem


class LayoutOperator(WithProblem):
    """Mix-in: operators on the layout of the last unwrap."""

    bl_options = {"REGISTER", "UNDO"}

    problem = staticmethod(layout_problem)

    def execute(self, context: bpy.types.Context) -> set[str]:
        obj = context.active_object
        with blender_mesh.object_mode(obj):
            arrays = blender_mesh.read_mesh(obj.data)
            try:
                message = self.show(context, obj, arrays, layouts.read(obj.data, arrays))
            except blender_mesh.BlenderMeshError as error:
                report_failure(self, context, arrays, error)
                return {"CANCELLED"}
        self.report({"INFO"}, message)
        return {"FINISHED"}


class MESH_OT_orbifold_show_distortion(LayoutOperator, bpy.types.Operator):
    bl_idname = "mesh.orbifold_show_distortion"
    bl_label = "Distortion Heat Map"
    bl_description = (
        "Colour the mesh by the distortion of its layout, as the colour attribute Orbifold Angle or Orbifold Area, "
        "with a legend in the 3D view"
    )

    measure: EnumProperty(
        name="Measure",
        items=(
            ("ANGLE", "Angles", "The ratio of the longest and the shortest stretch of each triangle: 1 keeps angles"),
            ("AREA", "Areas", "The area in the layout for the area on the mesh, 1 on the average: blue is small"),
        ),
    )

    def show(self, context: bpy.types.Context, obj: bpy.types.Object, arrays: blender_mesh.MeshArrays,
             layout: layouts.Layout) -> str:
        measure = heat.ANGLE if self.measure == "ANGLE" else heat.AREA
        heat.check(obj.data, measure)
        ratio, area = heat.distortion(arrays, layout.points, layout.curvature)
        values = ratio if self.measure == "ANGLE" else area
        heat.show(context, obj.data, measure, heat.at_vertices(arrays, values))
        if self.measure == "ANGLE":
            return f"The largest angle distortion of a triangle is {np.exp(ratio.max(initial=0.0)):.2f}."
        least, most = np.exp(area.min(initial=0.0)), np.exp(area.max(initial=0.0))
        return f"Areas are from {least:.2g} to {most:.2g} times the average."


class MESH_OT_orbifold_hide_distortion(bpy.types.Operator):
    bl_idname = "mesh.orbifold_hide_distortion"
    bl_label = "Remove Heat Map"
    bl_description = "Take the heat map's attributes off the mesh, and show it as before"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        problem = mesh_problem(context)
        if problem is None and heat.shown(context.active_object.data) is None:
            problem = "The mesh shows no heat map"
        if problem is not None:
            cls.poll_message_set(problem)
        return problem is None

    def execute(self, context: bpy.types.Context) -> set[str]:
        obj = context.active_object
        with blender_mesh.object_mode(obj):
            heat.hide(context, obj.data)
        return {"FINISHED"}


class OBJECT_OT_orbifold_tile_preview(LayoutOperator, bpy.types.Operator):
    bl_idname = "object.orbifold_tile_preview"
    bl_label = "Tile Preview"
    bl_description = (
        "Make, or bring up to date, an object beside this one with the layout's tile among its copies, in the same "
        "material: 3 x 3 cells of the plane's lattice, the whole group on the sphere, three rings in the Poincaré disk"
    )

    def show(self, context: bpy.types.Context, obj: bpy.types.Object, arrays: blender_mesh.MeshArrays,
             layout: layouts.Layout) -> str:
        preview, count = tile_preview.make_preview(context, obj, arrays, layout)
        most = ", as many as are shown at most" if count == tile_copies.MOST else ""
        return f"{preview.name}: the tile {count} times{most}."


class OBJECT_OT_orbifold_pattern(LayoutOperator, bpy.types.Operator):
    bl_idname = "object.orbifold_pattern"
    bl_label = "Pattern Material"
    bl_description = (
        "Give the object a material whose pattern crosses the seams of its layout without a break, in its last slot. "
        "Material or rendered shading shows it"
    )

    pattern: EnumProperty(name="Pattern", items=viewing.PATTERNS)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        self.pattern = context.scene.orbifold_view.pattern
        return self.execute(context)

    def show(self, context: bpy.types.Context, obj: bpy.types.Object, arrays: blender_mesh.MeshArrays,
             layout: layouts.Layout) -> str:
        if self.pattern == "RINGS":
            material = materials.make_material(obj, *layouts.painted(layout, arrays.triangles))
        else:
            problem = procedural.why_not(self.pattern, layout, layout.to_cells)
            if problem is not None:
                raise blender_mesh.BlenderMeshError(problem)
            material = procedural.make_material(obj, self.pattern, layout.lattice)
        materials.assign(obj, material)
        return f"{material.name} is the material of {obj.name}."


CLASSES = (
    MESH_OT_orbifold_show_distortion,
    MESH_OT_orbifold_hide_distortion,
    OBJECT_OT_orbifold_tile_preview,
    OBJECT_OT_orbifold_pattern,
)
