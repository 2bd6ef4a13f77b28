# SPDX-License-Identifier: GPL-3.0-or-later
"""Fill Seam Margin: the texels around the islands get what is across the seams."""

from __future__ import annotations

from typing import Optional

import bpy
import numpy as np
from bpy.props import IntProperty

from .. import blender_mesh, core, image_edits, image_pixels, seam_margins
from .jobs import WithProblem, mesh_problem


def margin_problem(context: bpy.types.Context) -> Optional[str]:
    """Why nothing can be filled; None where it can."""
    problem = mesh_problem(context, ("OBJECT", "TEXTURE_PAINT"))
    if problem is not None:
        return problem
    image = seam_margins.image_of(context)
    if image is None:
        return "Give the active material an image texture, or open an image in the image editor"
    if not len(context.active_object.data.uv_layers):
        return "The mesh has no UV map: unwrap it first"
    return image_pixels.problem(image)


class IMAGE_OT_orbifold_fill_seam_margin(WithProblem, bpy.types.Operator):
    bl_idname = "image.orbifold_fill_seam_margin"
    bl_label = "Fill Seam Margin"
    bl_description = (
        "Fill the texels around the islands of the image with what the surface has across the seams, so that no seam "
        "shows where the image is filtered or made smaller; on any UV map. Other selected meshes that show the image "
        "count too"
    )
    bl_options = {"REGISTER", "UNDO"}

    mip_levels: IntProperty(
        name="Mip Levels",
        description="How often the image may be halved until seams show: level N takes a margin of 2^N texels",
        default=4, min=0, max=10,
    )

    problem = staticmethod(margin_problem)

    def execute(self, context: bpy.types.Context) -> set[str]:
        active, image = context.active_object, seam_margins.image_of(context)
        others = [obj for obj in context.selected_objects if obj.type == "MESH" and obj != active]
        try:
            islands = seam_margins.islands(image, [active, *others])
            before = image_pixels.read(image)
            pixels = before.copy()
            core.fill_seam_margin(pixels, islands.triangles, islands.uv, 2**self.mip_levels, islands.repeats)
        except (blender_mesh.BlenderMeshError, core.OrbifoldError) as error:
            self.report({"ERROR"}, f"{error}.")
            return {"CANCELLED"}
        count = int(np.count_nonzero((pixels != before).any(2)))
        if not count:
            self.report({"INFO"}, f"The margins of {image.name} are filled already.")
            return {"CANCELLED"}
        image_edits.edit(context, image, before, pixels)
        beside = f", of {islands.meshes} meshes" if islands.meshes > 1 else ""
        self.report({"INFO"}, f"{image.name}: {count} texels are filled around the islands{beside}.")
        return {"FINISHED"}


CLASSES = (IMAGE_OT_orbifold_fill_seam_margin,)
