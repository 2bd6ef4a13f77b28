# SPDX-License-Identifier: GPL-3.0-or-later
"""Orbifold Sphere: a spherical orbifold as a shape key, on the whole sphere or on a copy split along the seam."""

from __future__ import annotations

import bpy
import numpy as np
from bpy.props import EnumProperty

from .. import blender_mesh, core, faces, properties, sphere_map
from .embedding import EmbeddingOperator
from .jobs import mesh_problem


def sphere_problem(context: bpy.types.Context) -> str | None:
    problem = mesh_problem(context)
    if problem is None and not properties.default_signature(context.active_object.data):
        problem = "Pick at least two cones first: use Suggest Cones, or select vertices in edit mode and use Add Cones"
    if problem is None:
        try:
            geometry = core.geometry_of(properties.default_signature(context.active_object.data))
        except core.OrbifoldError as error:
            return str(error)
        if geometry != "spherical":
            problem = f"The signature is {geometry}: choose a spherical one, as 432 or 22"
    return problem


class OBJECT_OT_orbifold_sphere(EmbeddingOperator, bpy.types.Operator):
    bl_idname = "object.orbifold_sphere"
    bl_label = "Orbifold Sphere"
    bl_description = (
        "Map the mesh of a spherical orbifold onto a sphere, as the shape key Orbifold Sphere: on the whole sphere, or "
        "on a copy of the object that is split along the seam"
    )
    bl_options = {"REGISTER", "UNDO"}

    target: EnumProperty(
        name="Onto",
        description="What the mesh is mapped onto",
        items=(
            ("WHOLE", "Whole Sphere", "The mesh covers the sphere once and stays in one piece"),
            ("SPLIT", "Tile, on a Split Copy", "A copy of the object, split along the seam, covers one tile"),
        ),
    )

    problem = staticmethod(sphere_problem)

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        for name in ("signature", "target", "holes"):
            layout.prop(self, name)
        self.draw_weights()

    def compute(self, result: core.Result) -> object:
        if result.geometry != "spherical":
            raise blender_mesh.BlenderMeshError(
                f"The signature {result.signature} is {result.geometry}, not spherical: choose another, as 432 or 22"
            )
        if self.target == "WHOLE":
            return sphere_map.sphere_of(result, self._arrays)
        return faces.layout_of(result, self._arrays, result.chart)

    def write(self, context: bpy.types.Context, result: core.Result, computed: object) -> str:
        obj = context.active_object
        if self.target == "WHOLE":
            blender_mesh.write_shape_key(obj, computed)
            return f"Orbifold {result.signature}: the shape key {blender_mesh.SHAPE_KEY} is on the sphere."
        copy = split_copy(context, obj, self._arrays, computed)
        return f"Orbifold {result.signature}: {copy.name} is split along the seam and has the shape key."


def split_copy(
    context: bpy.types.Context, obj: bpy.types.Object, arrays: blender_mesh.MeshArrays, layout: faces.FaceLayout
) -> bpy.types.Object:
    """A copy of the object, split along the layout's seams, with the tile as its shape key."""
    copy = obj.copy()
    copy.name = f"{obj.name} {blender_mesh.SHAPE_KEY}"
    copy.data = obj.data.copy()
    copy.animation_data_clear()
    for collection in obj.users_collection:
        collection.objects.link(copy)
    if copy.data.shape_keys is not None:
        copy.shape_key_clear()
    areas = sphere_map.vertex_areas(arrays.vertices, arrays.triangles)
    centre, radius = areas @ arrays.vertices / areas.sum(), np.sqrt(areas.sum() / (4 * np.pi))
    loops = np.empty((arrays.n_loops, 3))
    loops[arrays.loops.ravel()] = layout.embedding.reshape(-1, 3)
    blender_mesh.split_edges(copy.data, layout.seams)
    vertices = blender_mesh.read_loop_vertices(copy.data)
    points = np.array(blender_mesh.read_vertices(copy.data))
    points[vertices] = centre + radius * loops
    blender_mesh.write_shape_key(copy, points)
    for other in context.selected_objects:
        other.select_set(False)
    copy.select_set(True)
    context.view_layer.objects.active = copy
    return copy


CLASSES = (OBJECT_OT_orbifold_sphere,)
