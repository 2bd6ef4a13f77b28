# SPDX-License-Identifier: GPL-3.0-or-later
"""Show Predicted Stretch: what the conformal map with the present cones does to lengths, as attributes of the mesh."""

from __future__ import annotations

import bpy

from .. import arrangement, blender_mesh, cones, core, heat, properties
from .jobs import JobOperator, mesh_problem


def stretch_problem(context: bpy.types.Context) -> str | None:
    problem = mesh_problem(context)
    if problem is None and not properties.default_signature(context.active_object.data):
        problem = "The mesh has no cones: use Suggest Cones and place some first"
    return problem


class MESH_OT_orbifold_show_stretch(JobOperator, bpy.types.Operator):
    bl_idname = "mesh.orbifold_show_stretch"
    bl_label = "Show Predicted Stretch"
    bl_description = (
        "Colour the mesh by how much the conformal map with its cones stretches lengths: blue where the layout is "
        f"small, red where it is large, white between. Written to the attributes {heat.STRETCH.attribute} and "
        f"{heat.STRETCH.colour}"
    )
    bl_options = {"REGISTER", "UNDO"}
    problem = staticmethod(stretch_problem)

    def prepare(self, context: bpy.types.Context) -> None:
        with blender_mesh.object_mode(context.active_object):
            heat.check(context.active_object.data, heat.STRETCH)

    def start(self, context: bpy.types.Context) -> core.Job:
        mesh = context.active_object.data
        signature, picked = properties.default_signature(mesh), [cone.vertex for cone in cones.read_cones(mesh)]
        return core.start_predicting(
            *(self._arrays.vertices, self._arrays.triangles, signature),
            arrangement.in_sequence(picked, self._surface, signature), holes=mesh.orbifold.holes,
        )

    def proceed(self, context: bpy.types.Context, job: core.Job) -> str:
        prediction = job.finish()
        with blender_mesh.object_mode(context.active_object):
            heat.show(context, context.active_object.data, heat.STRETCH, prediction.scale)
        return f"Predicted area spread {prediction.spread:.2f}. {shading_hint(context)}"


def shading_hint(context: bpy.types.Context) -> str:
    """Where to look."""
    space = context.space_data
    if space is not None and space.type == "VIEW_3D" and space.shading.type == "SOLID":
        return "Blue is small in the layout, red is large."
    return "Solid shading with the colour Attribute shows it: blue is small in the layout, red is large."


CLASSES = (MESH_OT_orbifold_show_stretch,)
