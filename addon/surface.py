# SPDX-License-Identifier: GPL-3.0-or-later
"""Which surface a mesh of Blender's is: read anew for what is computed, remembered for what is drawn."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Optional

import bmesh
import bpy
import numpy as np

from . import blender_mesh, core

_remembered: dict[str, tuple[tuple[int, int, int], core.Topology]] = {}
_remembered_parts: dict[str, tuple[tuple, core.Topology]] = {}  # of `around`


def read(mesh: bpy.types.Mesh) -> core.Topology:
    """In any mode; loops of the boundary in vertices as they are counted now."""
    if mesh.is_editmode:
        owner = next((obj for obj in bpy.data.objects if obj.mode == "EDIT" and obj.data == mesh), None)
        if owner is not None:
            owner.update_from_editmode()
    surface = core.topology_of(*blender_mesh.read_faces(mesh))
    _remembered_parts.pop(mesh.name_full, None)
    _remembered[mesh.name_full] = (counts(mesh), surface)
    return surface


def glance(mesh: bpy.types.Mesh) -> core.Topology:
    """For panels and menus: as `read`, but only where the numbers of vertices, edges and faces have changed."""
    known, surface = _remembered.get(mesh.name_full, (None, None))
    return surface if surface is not None and known == counts(mesh) else read(mesh)


def around(mesh: bpy.types.Mesh, vertices: Sequence[int]) -> core.Topology:
    """As `glance`; of a mesh in several components that on which all these vertices lie, if there is one."""
    whole = glance(mesh)
    if whole.components < 2 or not len(vertices):
        return whole
    key = (counts(mesh), tuple(vertices))
    known = _remembered_parts.get(mesh.name_full)
    if known is None or known[0] != key:
        known = (key, _part(mesh, vertices) or whole)
        _remembered_parts[mesh.name_full] = known
    return known[1]


def _part(mesh: bpy.types.Mesh, vertices: Sequence[int]) -> Optional[core.Topology]:
    corners, sizes = blender_mesh.read_faces(mesh)
    starts = np.concatenate([[0], np.cumsum(sizes)[:-1]]).astype(np.int64)
    first = np.repeat(corners[starts], sizes)  # of each corner's face: a star of edges connects as well
    n = max(int(corners.max()), *vertices) + 1
    label = core.vertex_components(n, np.stack([first, corners, corners], 1))
    if len(set(label[list(vertices)].tolist())) > 1:
        return None
    kept = label[corners[starts]] == label[vertices[0]]
    return core.topology_of(corners[np.repeat(kept, sizes)], sizes[kept]) if kept.any() else None


def forget() -> None:
    _remembered.clear()
    _remembered_parts.clear()


def counts(mesh: bpy.types.Mesh) -> tuple[int, int, int]:
    """Of vertices, edges, faces, in any mode."""
    if mesh.is_editmode:
        bm = bmesh.from_edit_mesh(mesh)
        return len(bm.verts), len(bm.edges), len(bm.faces)
    return len(mesh.vertices), len(mesh.edges), len(mesh.polygons)
