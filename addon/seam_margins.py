# SPDX-License-Identifier: GPL-3.0-or-later
"""The image that is to be filled around islands, and the triangles of all meshes that share it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Optional

import bpy
import numpy as np

from . import blender_mesh, textures

OUTSIDE = 1e-4  # of the unit square: UVs this far beyond it are


@dataclass(frozen=True)
class Islands:
    """Of meshes whose vertices are numbered one mesh after the other."""

    triangles: np.ndarray  # (m, 3)
    uv: np.ndarray  # (m, 3, 2)
    repeats: bool  # the image does
    meshes: int


def image_of(context: bpy.types.Context) -> Optional[bpy.types.Image]:
    """That in the image editor, or the one that the active material shows."""
    if context.area is not None and context.area.type == "IMAGE_EDITOR" and context.space_data.image is not None:
        return context.space_data.image
    node = textures.node_of(context.active_object)
    return node.image if node is not None else None


def islands(image: bpy.types.Image, objects: Sequence[bpy.types.Object]) -> Islands:
    """Of the first object, and of those others whose materials show the image. In object mode. BlenderMeshError where
    one has no UV map."""
    triangles, uv, n_vertices, repeats = [], [], 0, False
    for mesh, obj in {obj.data: obj for obj in reversed(objects)}.items():
        node = textures.node_with(obj, image)
        if node is None and obj != objects[0]:
            continue
        name = _uv_map(obj, node)
        if name is None:
            raise blender_mesh.BlenderMeshError(f"{obj.name} has no UV map")
        arrays = blender_mesh.read_mesh(mesh)
        triangles.append(arrays.triangles.astype(np.int64) + n_vertices)
        uv.append(blender_mesh.read_uv(mesh, name).astype(np.float64)[arrays.loops])
        n_vertices += len(mesh.vertices)
        beyond = (np.abs(uv[-1] - 0.5) > 0.5 + OUTSIDE).any()
        repeats |= bool(beyond) if node is None else node.extension == "REPEAT"
    return Islands(np.concatenate(triangles), np.concatenate(uv), repeats, len(uv))


def _uv_map(obj: bpy.types.Object, node: Optional[bpy.types.Node]) -> Optional[str]:
    """That by which a node shows its image, else the active one."""
    active = obj.data.uv_layers.active
    return textures.uv_map_of(node, obj.data) if node is not None else active and active.name
