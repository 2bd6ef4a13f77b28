# SPDX-License-Identifier: GPL-3.0-or-later
"""Which surface a mesh of Blender's is: read anew for what is computed, remembered for what is drawn."""

from __future__ import annotations

import bmesh
import bpy

from . import blender_mesh, core

_remembered: dict[str, tuple[tuple[int, int, int], core.Topology]] = {}


def read(mesh: bpy.types.Mesh) -> core.Topology:
    """In any mode; loops of the boundary in vertices as they are counted now."""
    if mesh.is_editmode:
        owner = next((obj for obj in bpy.data.objects if obj.mode == "EDIT" and obj.data == mesh), None)
        if owner is not None:
            owner.update_from_editmode()
    surface = core.topology_of(*blender_mesh.read_faces(mesh))
    _remembered[mesh.name_full] = (counts(mesh), surface)
    return surface


def glance(mesh: bpy.types.Mesh) -> core.Topology:
    """For panels and menus: as `read`, but only where the numbers of vertices, edges and faces have changed."""
    known, surface = _remembered.get(mesh.name_full, (None, None))
    return surface if surface is not None and known == counts(mesh) else read(mesh)


def forget() -> None:
    _remembered.clear()


def counts(mesh: bpy.types.Mesh) -> tuple[int, int, int]:
    """Of vertices, edges, faces, in any mode."""
    if mesh.is_editmode:
        bm = bmesh.from_edit_mesh(mesh)
        return len(bm.verts), len(bm.edges), len(bm.faces)
    return len(mesh.vertices), len(mesh.edges), len(mesh.polygons)
