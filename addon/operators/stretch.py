# SPDX-License-Identifier: GPL-3.0-or-later
"""Show Predicted Stretch: what the conformal map with the present cones does to lengths, as attributes of the mesh."""

from __future__ import annotations

import bpy

from .. import arrangement, blender_mesh, cones, core, heat, properties
from .jobs import mesh_problem, report_failure

def stretch_problem(context: bpy.types.Context) -> str | None:
    problem = mesh_problem(context)
    if problem is None and not properties.default_signature(context.active_object.data):
        problem = "The mesh has no cones: use Suggest Cones and place some first"
    return problem


class MESH_OT_orbifold_show_stretch(bpy.types.Operator):
    bl_idname = "mesh.orbifold_show_stretch"
    bl_label = "Show Predicted Stretch"
    bl_description = (
        "Colour the mesh by how much the conformal map with its cones stretches lengths: blue where the layout is "
        f"small, red where it is large, white between. Written to the attributes {heat.STRETCH.attribute} and "
        f"{heat.STRETCH.colour}"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        problem = stretch_problem(context)
        if problem is not None:
            cls.poll_message_set(problem)
        return problem is None

    def execute(self, context: bpy.types.Context) -> set[str]:
        obj = context.active_object
        mesh = obj.data
        with blender_mesh.object_mode(obj):
            arrays = blender_mesh.read_mesh(mesh)
            try:
                prediction = _predict(mesh, arrays)
                heat.check(mesh, heat.STRETCH)
            except (core.OrbifoldError, blender_mesh.BlenderMeshError) as error:
                report_failure(self, context, arrays, error)
                return {"CANCELLED"}
            heat.show(context, mesh, heat.STRETCH, prediction.scale)
        self.report({"INFO"}, f"Predicted area spread {prediction.spread:.2f}. {shading_hint(context)}")
        return {"FINISHED"}


def _predict(mesh: bpy.types.Mesh, arrays: blender_mesh.MeshArrays) -> core.Prediction:
    surface, picked = core.topology_of(arrays.triangles), [cone.vertex for cone in cones.read_cones(mesh)]
    signature = properties.default_signature(mesh)
    return core.predict(
        *(arrays.vertices, arrays.triangles, signature, arrangement.in_sequence(picked, surface, signature)),
        holes=mesh.orbifold.holes,
    )


def shading_hint(context: bpy.types.Context) -> str:
    """Where to look."""
    space = context.space_data
    if space is not None and space.type == "VIEW_3D" and space.shading.type == "SOLID":
        return "Blue is small in the layout, red is large."
    return "Solid shading with the colour Attribute shows it: blue is small in the layout, red is large."


CLASSES = (MESH_OT_orbifold_show_stretch,)
