# SPDX-License-Identifier: GPL-3.0-or-later
"""Bake to Ordinary UV Map: the image that the object shows -> an image by another UV map of the same mesh, for programs
that take no image that repeats."""

from __future__ import annotations

from typing import Optional

import bpy
import numpy as np
from bpy.props import IntProperty, StringProperty

from .. import baking, blender_mesh, core, projecting, textures
from ..steps import Steps
from .jobs import JobOperator, mesh_problem, report_failure

EXPECTED = (core.OrbifoldError, blender_mesh.BlenderMeshError)


def texture_problem(context: bpy.types.Context) -> Optional[str]:
    """Why there is no image to bake; None where there may be one."""
    problem = mesh_problem(context, ("OBJECT", "TEXTURE_PAINT"))
    if problem is None and textures.node_of(context.active_object) is None:
        problem = "Give the active material an image texture first"
    return problem


class OBJECT_OT_orbifold_bake(JobOperator, bpy.types.Operator):
    bl_idname = "object.orbifold_bake"
    bl_label = "Bake to Ordinary UV Map"
    bl_description = (
        "Make an image that shows by another UV map of the mesh what the active material's image shows by its own, "
        "with seams that are filled, and a copy of the material that uses it"
    )
    bl_options = {"REGISTER", "UNDO"}

    problem = staticmethod(texture_problem)

    uv_map: StringProperty(
        name="UV Map", description="The UV map to bake to. Empty: Baked, by Smart UV Project if it is not there yet"
    )
    size: IntProperty(name="Size", description="Texels along a side of the new image", default=2048, min=16, max=8192)
    mip_levels: IntProperty(
        name="Mip Levels", description="How often the image may be halved until seams show", default=4, min=0, max=10,
    )

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop_search(self, "uv_map", context.active_object.data, "uv_layers")
        layout.prop(self, "size")
        layout.prop(self, "mip_levels")

    def _start(self, context: bpy.types.Context) -> bool:
        obj = context.active_object
        with blender_mesh.object_mode(obj):
            self._arrays = blender_mesh.read_mesh(obj.data)
            try:
                self._texture = textures.find(obj)
                self._name = self.uv_map or projecting.NAME
                self._corners = self._target(obj)
            except EXPECTED as error:
                report_failure(self, context, self._arrays, error)
                return False
        source = blender_mesh.read_uv(obj.data, self._texture.uv_map).astype(np.float64)[self._arrays.loops]
        self._uv = self._corners.astype(np.float64)[self._arrays.loops]
        self._job = Steps(baking.on_islands(
            self._uv, self.size, self.size, lambda triangles, where: (triangles, where), source, self._texture.pixels()
        ))
        return True

    def _target(self, obj: bpy.types.Object) -> np.ndarray:
        """(loops, 2) of the UV map that is baked to."""
        if self._name == self._texture.uv_map:
            raise blender_mesh.BlenderMeshError(
                f"The image is shown by the UV map {self._name} already: choose another one"
            )
        if self._name in obj.data.uv_layers:
            return blender_mesh.read_uv(obj.data, self._name)
        if self.uv_map:
            raise blender_mesh.BlenderMeshError(f"{obj.name} has no UV map {self.uv_map}")
        blender_mesh.check_uv_space(obj.data, self._name)
        return projecting.projected(obj, 2 ** min(self.mip_levels, 4) / self.size)

    def _proceed(self, context: bpy.types.Context) -> Optional[set[str]]:
        obj, job, self._job = context.active_object, self._job, None
        try:
            image, covered = job.finish()
            pixels = image.astype(np.float32)
            core.fill_seam_margin(pixels, self._arrays.triangles, self._uv, 2**self.mip_levels)
        except EXPECTED as error:
            report_failure(self, context, self._arrays, error)
            return {"CANCELLED"}
        with blender_mesh.object_mode(obj):
            if self._name not in obj.data.uv_layers:
                every = np.ones(len(self._corners), bool)
                blender_mesh.write_uv_of_loops(obj.data, self._corners, every, self._name)
            textures.write(obj, self._texture, pixels, self._name)
        filled = int(np.count_nonzero((pixels != image.astype(np.float32)).any(2)))
        self.report(
            {"INFO"}, f"Baked to the UV map {self._name}: {covered.mean():.0%} of the image, and {filled} texels are "
            "filled around the islands."
        )
        return {"FINISHED"}


CLASSES = (OBJECT_OT_orbifold_bake,)
