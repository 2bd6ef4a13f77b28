# SPDX-License-Identifier: GPL-3.0-or-later
"""The cones and mirror corners of a mesh, kept on its vertices; on the boundary a cone is a mirror corner.

The truth is two whole-number vertex attributes, `orbifold_cone` and `orbifold_order`: as vertex data they follow
undo in edit mode (which custom properties do not), leaving edit mode, saving, joining and the deletion of other
vertices, so that a cone never moves to another vertex by a shift of indices. Subdividing interpolates vertex data
and would make cones of the values in between; therefore `orbifold_cone` holds, beside the cone's rank, a check
number that an interpolated value does not have. Of vertices with the same rank (copies), the first one counts.

`mesh.orbifold.cones` mirrors them for lists and drawing; `sync` brings it up to date, called by handlers.py.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import bmesh
import bpy
import numpy as np

from . import blender_mesh

CONE_ATTRIBUTE = "orbifold_cone"
ORDER_ATTRIBUTE = "orbifold_order"

RANKS = 2048  # rank in the low 11 bits, check number in the next 13: whole numbers below 2^24 survive any float
CHECKS = 8191
MAX_CONES = RANKS - 1
MAX_ORDER = 2**20


@dataclass(frozen=True)
class Cone:
    vertex: int
    order: int


def _code(rank: int, order: int) -> int:
    """What `orbifold_cone` holds at the cone of this rank, from 1."""
    return rank + RANKS * (1 + (rank * 2503 + order * 4111) % CHECKS)


def _decode(found: Iterable[tuple[int, int, int]]) -> dict[int, Cone]:
    """(vertex, code, order) of vertices with a code, by ascending vertex -> rank: cone, by ascending rank. Ranks have
    gaps where a cone's vertex was deleted."""
    by_rank: dict[int, Cone] = {}
    for vertex, code, order in found:
        rank = code % RANKS
        if 0 < rank <= MAX_CONES and order >= 2 and code == _code(rank, order) and rank not in by_rank:
            by_rank[rank] = Cone(vertex, order)
    return {rank: by_rank[rank] for rank in sorted(by_rank)}


def read_cones(mesh: bpy.types.Mesh) -> list[Cone]:
    """In the sequence in which they were picked; vertices are counted as they stand now. In any mode."""
    return list(_read_ranked(mesh).values())


def _read_ranked(mesh: bpy.types.Mesh) -> dict[int, Cone]:
    if mesh.is_editmode:
        bm = bmesh.from_edit_mesh(mesh)
        codes = bm.verts.layers.int.get(CONE_ATTRIBUTE)
        orders = bm.verts.layers.int.get(ORDER_ATTRIBUTE)
        if codes is None or orders is None:
            return {}
        return _decode((i, v[codes], v[orders]) for i, v in enumerate(bm.verts) if v[codes])
    codes = blender_mesh.read_int_attribute(mesh, CONE_ATTRIBUTE)
    orders = blender_mesh.read_int_attribute(mesh, ORDER_ATTRIBUTE)
    if codes is None or orders is None:
        return {}
    vertices = np.flatnonzero(codes)
    return _decode(zip(vertices.tolist(), codes[vertices].tolist(), orders[vertices].tolist()))


def write_cones(mesh: bpy.types.Mesh, cones: Sequence[Cone]) -> None:
    """Replace the mesh's cones by these, in any mode. `mesh.orbifold` is brought up to date too."""
    if len(cones) > MAX_CONES:
        raise blender_mesh.BlenderMeshError(f"A mesh holds at most {MAX_CONES} cones: remove some")
    ranked = dict(enumerate(cones, start=1))
    codes = {cone.vertex: (_code(rank, cone.order), cone.order) for rank, cone in ranked.items()}
    if mesh.is_editmode:
        _write_layers(mesh, codes)
    else:
        _write_attributes(mesh, codes)
    _write_mirror(mesh, ranked)


def ensure_layers(bm: bmesh.types.BMesh) -> tuple:
    """The two layers in edit mode. Creating them invalidates vertices that were read before: call this first."""
    layers = bm.verts.layers.int
    for name in (CONE_ATTRIBUTE, ORDER_ATTRIBUTE):
        if layers.get(name) is None:
            layers.new(name)
    return layers[CONE_ATTRIBUTE], layers[ORDER_ATTRIBUTE]


def _write_layers(mesh: bpy.types.Mesh, codes: dict[int, tuple[int, int]]) -> None:
    bm = bmesh.from_edit_mesh(mesh)
    cone_layer, order_layer = ensure_layers(bm)
    for vertex in bm.verts:
        if vertex[cone_layer]:
            vertex[cone_layer] = vertex[order_layer] = 0
    bm.verts.ensure_lookup_table()
    for vertex, (code, order) in codes.items():
        bm.verts[vertex][cone_layer] = code
        bm.verts[vertex][order_layer] = order
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)


def _write_attributes(mesh: bpy.types.Mesh, codes: dict[int, tuple[int, int]]) -> None:
    values = np.zeros((2, len(mesh.vertices)), np.int32)
    for vertex, pair in codes.items():
        values[:, vertex] = pair
    blender_mesh.write_int_attribute(mesh, CONE_ATTRIBUTE, values[0])
    blender_mesh.write_int_attribute(mesh, ORDER_ATTRIBUTE, values[1])
    mesh.update()


# ------------------------------------------------------------------------------------- the mirror for display


class _Guard:
    depth = 0


@contextmanager
def writing() -> Iterator[None]:
    """While properties are written whose update callbacks would otherwise write back."""
    _Guard.depth += 1
    try:
        yield
    finally:
        _Guard.depth -= 1


def is_writing() -> bool:
    return _Guard.depth > 0


def _write_mirror(mesh: bpy.types.Mesh, ranked: dict[int, Cone]) -> None:
    settings = mesh.orbifold
    wanted = [(cone.vertex, cone.order, rank) for rank, cone in ranked.items()]
    if not mesh.is_editmode and [(item.vertex, item.order, item.rank) for item in settings.cones] == wanted:
        return
    flags = on_boundary(mesh, [vertex for vertex, _, _ in wanted])
    with writing():
        settings.cones.clear()
        for (vertex, order, rank), flag in zip(wanted, flags):
            item = settings.cones.add()
            item.vertex, item.order, item.rank, item.mirror = vertex, order, rank, flag
        settings.active_cone = max(0, min(settings.active_cone, len(wanted) - 1))


def on_boundary(mesh: bpy.types.Mesh, vertices: Sequence[int]) -> list[bool]:
    """Whether each of these vertices lies on the mesh's boundary, where it is a mirror corner; in any mode."""
    if not vertices:
        return []
    if mesh.is_editmode:
        bm = bmesh.from_edit_mesh(mesh)
        bm.verts.ensure_lookup_table()
        return [vertex < len(bm.verts) and bm.verts[vertex].is_boundary for vertex in vertices]
    flags = blender_mesh.boundary_vertices(mesh)
    return [vertex < len(flags) and bool(flags[vertex]) for vertex in vertices]


def has_cones(mesh: bpy.types.Mesh) -> bool:
    """Whether the mesh has cones, or had some; cheap."""
    if len(mesh.orbifold.cones):
        return True
    if mesh.is_editmode:
        return bmesh.from_edit_mesh(mesh).verts.layers.int.get(CONE_ATTRIBUTE) is not None
    return CONE_ATTRIBUTE in mesh.attributes


def mirror_is_valid(mesh: bpy.types.Mesh) -> bool:
    """Whether each cone of the mirror is where it says (a few look-ups). It does not notice an additional one."""
    items = mesh.orbifold.cones
    if not mesh.is_editmode:
        ranked = _read_ranked(mesh)
        return [(i.vertex, i.order, i.rank) for i in items] == [(c.vertex, c.order, r) for r, c in ranked.items()]
    bm = bmesh.from_edit_mesh(mesh)
    codes = bm.verts.layers.int.get(CONE_ATTRIBUTE)
    if codes is None:
        return not len(items)
    bm.verts.ensure_lookup_table()
    return all(
        item.vertex < len(bm.verts)
        and bm.verts[item.vertex][codes] == _code(item.rank, item.order)
        and bm.verts[item.vertex].is_boundary == item.mirror
        for item in items
    )


def sync(mesh: bpy.types.Mesh) -> None:
    """Bring `mesh.orbifold.cones` in line with the vertices."""
    _write_mirror(mesh, _read_ranked(mesh))
