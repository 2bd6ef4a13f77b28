# SPDX-License-Identifier: GPL-3.0-or-later
"""Cuts a mesh's faces as seam_cut.py says. Old vertices keep their numbers and new ones follow; what vertices, edges,
faces and corners have goes on to what they become."""

from __future__ import annotations

import bmesh
import bpy
import numpy as np

from . import blender_mesh
from .seam_cut import SeamCut


def check(obj: bpy.types.Object) -> None:
    """Raises BlenderMeshError where the faces of an object must not be cut."""
    if obj.data.users - obj.data.use_fake_user > 1:
        raise blender_mesh.BlenderMeshError(
            f"Cutting faces would change other objects that share the mesh of {obj.name}: make it single-user "
            "(Object > Relations), or do not tick Cut Faces at Seams"
        )
    if any(modifier.type == "MULTIRES" for modifier in obj.modifiers):
        raise blender_mesh.BlenderMeshError(
            f"{obj.name} has a Multiresolution modifier, whose sculpted levels would be lost by cutting faces: apply "
            "it, or do not tick Cut Faces at Seams"
        )


def apply(mesh: bpy.types.Mesh, triangles: np.ndarray, cut: SeamCut, uv_maps: dict[str, np.ndarray]) -> None:
    """`triangles` (m, 3): the mesh's, that the cut counts; of each UV map the values of all pieces' corners (c, 2). Not
    in edit mode."""
    bm = bmesh.new()
    try:
        bm.from_mesh(mesh)
        vertices = bm.verts[:]
        _add_vertices(bm, vertices, triangles, cut)
        _write_pieces(bm, vertices, triangles, cut, uv_maps)
        for ends in cut.seams.tolist():
            edge = bm.edges.get([vertices[end] for end in ends])
            if edge is not None:
                edge.seam = True
        bm.to_mesh(mesh)
    finally:
        bm.free()
    mesh.update()


def _add_vertices(bm: bmesh.types.BMesh, vertices: list, triangles: np.ndarray, cut: SeamCut) -> None:
    """Appends them. Where one is on an edge, that is split, in all faces that have it."""
    ours = [layer for name, layer in bm.verts.layers.int.items() if name.startswith("orbifold_")]
    split: dict[tuple[int, int], tuple] = {}  # edges: the last new vertex on them, and where that is
    for k, (first, second) in enumerate(cut.ends.tolist()):
        corners, weights = [vertices[v] for v in triangles[cut.triangles[k]].tolist()], cut.barycentric[k].tolist()
        place = _sum([corner.co for corner in corners], weights)
        last, at = split.get((first, second), (vertices[first], 0.0))
        edge = bm.edges.get((last, vertices[second])) if first >= 0 else None
        if edge is not None:
            new = bmesh.utils.edge_split(edge, last, (cut.factors[k] - at) / (1 - at))[1]
            split[first, second] = new, cut.factors[k]
        else:
            new = _between(bm, corners, weights)
        new.co = place
        for layer in ours:
            new[layer] = 0
        vertices.append(new)


def _between(bm: bmesh.types.BMesh, corners: list, weights: list[float]) -> bmesh.types.BMVert:
    """A vertex that has what these have, mixed, the heaviest first, for its weight is not 0."""
    (most, first), (more, second), (least, third) = sorted(zip(weights, corners), key=lambda one: -one[0])
    new = bm.verts.new(first.co, first)
    new.copy_from_vert_interp((first, second), more / (most + more))
    new.copy_from_vert_interp((new, third), least)
    return new


def _write_pieces(
    bm: bmesh.types.BMesh, vertices: list, triangles: np.ndarray, cut: SeamCut, uv_maps: dict[str, np.ndarray]
) -> None:
    old_faces, number = bm.faces[:], {vertex: k for k, vertex in enumerate(vertices)}
    layers = [(bm.loops.layers.uv[name], values.tolist()) for name, values in uv_maps.items()]
    corners, several, start = _Corners(bm, number, triangles, cut), _several(cut), 0
    uncut = set(cut.crossing.tolist())
    for piece in cut.pieces:
        face = old_faces[piece.polygon]
        if piece.polygon in several:
            face = _new_face(bm, face, [vertices[vertex] for vertex in piece.vertices])
            corners.write(face, old_faces[piece.polygon])
        row = {vertex: start + k for k, vertex in enumerate(piece.vertices)}
        start += len(row)
        for loop in face.loops if piece.polygon not in uncut else ():
            for layer, values in layers:
                loop[layer].uv = values[row[number[loop.vert]]]
    for polygon in several:
        bm.faces.remove(old_faces[polygon])


def _several(cut: SeamCut) -> set[int]:
    """The faces of more than one piece, which follow one another."""
    return {one.polygon for one, other in zip(cut.pieces, cut.pieces[1:]) if one.polygon == other.polygon}


def _new_face(bm: bmesh.types.BMesh, old: bmesh.types.BMFace, vertices: list) -> bmesh.types.BMFace:
    face = bm.faces.new(vertices, old)
    face.smooth, face.material_index, face.hide = old.smooth, old.material_index, old.hide
    face.select_set(old.select)
    return face


class _Corners:
    """What a piece's corners have from its face's: what these have, and within the face what is between, if it can be."""

    def __init__(self, bm: bmesh.types.BMesh, number: dict, triangles: np.ndarray, cut: SeamCut) -> None:
        there = bm.loops.layers
        kinds = (getattr(there, kind, None) for kind in ("float", "float_vector", "float_color", "color"))
        self._values = [layer for kind in kinds if kind is not None for layer in kind.values()]
        self._uv = there.uv.values()
        self._number, first = number, len(number) - len(cut.triangles)  # of vertices
        self._around = {  # of new vertices: the triangle's, and weights
            first + k: (corners, weights)
            for k, (corners, weights) in enumerate(zip(triangles[cut.triangles].tolist(), cut.barycentric.tolist()))
        }

    def write(self, face: bmesh.types.BMFace, old: bmesh.types.BMFace) -> None:
        own = {self._number[loop.vert]: loop for loop in old.loops}
        for loop in face.loops[:]:
            vertex = self._number[loop.vert]
            if vertex not in own:
                around, weights = self._around[vertex]
                vertex = around[weights.index(max(weights))]
            loop.copy_from(own[vertex])
        for loop in face.loops:  # asked for anew: Blender takes those that were copied to for removed
            vertex = self._number[loop.vert]
            if vertex not in own:
                around, weights = self._around[vertex]
                self._mix(loop, [own[corner] for corner in around], weights)

    def _mix(self, loop: bmesh.types.BMLoop, corners: list, weights: list[float]) -> None:
        for layer in self._values:
            loop[layer] = _sum([corner[layer] for corner in corners], weights)
        for layer in self._uv:
            loop[layer].uv = _sum([corner[layer].uv for corner in corners], weights)


def _sum(values: list, weights: list[float]):
    first, second, third = (value * weight for value, weight in zip(values, weights))
    return first + second + third
