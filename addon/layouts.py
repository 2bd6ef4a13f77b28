# SPDX-License-Identifier: GPL-3.0-or-later
"""What a mesh remembers of its last unwraps, so that the layout can be shown, measured and painted later, also after
saving, without computing it again: signature, chart and the group's generators. The points themselves are the UV map's.

Undo in edit mode takes a UV map back but not what is kept here. Therefore the last few layouts are kept, each with the
texture coordinates of some corners, and the one that counts is the newest whose corners are where the UV map has them.
"""

from __future__ import annotations

import base64
import io
from dataclasses import dataclass
from typing import Optional

import bmesh
import bpy
import numpy as np
from bpy.props import BoolProperty, StringProperty

from . import blender_mesh
from .core import Result
from .core.charts import CURVATURE, Chart, chart_of
from .faces import FaceLayout

UV_MAP = blender_mesh.UV_MAP
KEPT = 8
SAMPLES = 32  # triangles by which a layout is known again, and its chart fitted
SAME = 1e-6  # of the unit square


class OrbifoldLayout(bpy.types.PropertyGroup):
    signature: StringProperty(name="Signature")
    geometry: StringProperty()
    chart: StringProperty()
    weights: StringProperty()
    cones: StringProperty()  # vertices, in the signature's sequence
    seams: BoolProperty(default=True)  # the cut was marked as seams
    arrays: StringProperty()  # the others, as text (_packed)


CLASSES = (OrbifoldLayout,)


@dataclass(frozen=True)
class Layout:
    """The layout of a mesh's UV map `Orbifold`."""

    signature: str  # empty where the boundary was fixed to a polygon
    geometry: str
    chart_name: str
    chart: Chart
    uv: np.ndarray  # (m, 3, 2) per triangle corner
    points: np.ndarray  # (m, 3, 3) the corners on the plane, sphere or hyperboloid
    generators: np.ndarray  # (., 3, 3)
    cones: np.ndarray  # (k,) vertices, in the signature's sequence
    orders: np.ndarray  # (k,)
    euler: float  # of the orbifold
    lattice: Optional[np.ndarray]  # (3, 2) from (u, v, 1) to coordinates in which the unit square is a period

    @property
    def curvature(self) -> int:
        return CURVATURE[self.geometry]

    @property
    def to_cells(self) -> Optional[np.ndarray]:
        """(3, 2) from the plane's (x, y, 1) to the lattice's coordinates."""
        if self.lattice is None:
            return None
        uv = self.uv.reshape(-1, 2)
        cells, *_ = np.linalg.lstsq(
            self.points.reshape(-1, 3), np.column_stack([uv, np.ones(len(uv))]) @ self.lattice, rcond=None
        )
        return cells


@dataclass(frozen=True)
class Painted:
    """What pattern.py needs of a core.Result, of a layout that is read from a mesh: every corner is a copy."""

    geometry: str
    signature: str
    generators: np.ndarray
    embedding: np.ndarray  # (3 m, 3)
    cut_triangles: np.ndarray  # (m, 3)
    cones: np.ndarray  # (k,) a corner at each cone
    report: dict


def painted(layout: Layout, triangles: np.ndarray) -> tuple[Painted, FaceLayout]:
    """Of the layout of a mesh with these triangles (m, 3), for `pattern.image`."""
    corners = triangles.ravel()
    usable = np.isfinite(layout.points).all((1, 2))
    rows = np.flatnonzero(usable)
    cones = np.array([np.flatnonzero(corners == cone)[0] for cone in layout.cones.tolist()], int)
    tile = Painted(
        *(layout.geometry, layout.signature, layout.generators, layout.points.reshape(-1, 3)),
        3 * rows[:, None] + np.arange(3), cones[np.isfinite(layout.points.reshape(-1, 3)[cones]).all(1)],
        {"orbifold": {"euler": layout.euler}},
    )
    return tile, FaceLayout(layout.chart_name, layout.uv[usable], layout.points[usable], np.zeros((0, 2), int), 0, 0)


def keep(
    mesh: bpy.types.Mesh, arrays: blender_mesh.MeshArrays, result: Result, layout: FaceLayout, weights: str, seams: bool
) -> None:
    """Remember the layout that was just written to the UV map. In object mode."""
    kept = mesh.orbifold.layouts
    while len(kept) >= KEPT:
        kept.remove(0)
    item = kept.add()
    item.signature, item.geometry, item.chart, item.weights = result.signature, result.geometry, layout.chart, weights
    item.cones = " ".join(map(str, result.cones.tolist()))
    item.seams = seams
    mesh.orbifold.unwraps = (mesh.orbifold.unwraps + 1) % 2**30
    some = np.unique(np.linspace(0, len(arrays.triangles) - 1, SAMPLES).astype(int))
    uv = layout.uv[some]
    lattice = np.zeros((0, 2))
    if result.geometry == "euclidean" and result.signature:
        lattice = _affine(result.uv_chart(layout.chart)[some], result.uv_chart("periodic")[some])
    item.arrays = _packed(
        loops=arrays.loops[some], uv=uv, points=layout.embedding[some], generators=result.generators,
        cones=result.cones, orders=result.orders, lattice=lattice,
        euler=np.array(result.report["orbifold"]["euler"]),
    )


def has_layout(mesh: bpy.types.Mesh) -> bool:
    """Whether `read` may find one; cheap, in any mode."""
    return len(mesh.orbifold.layouts) > 0


def latest(mesh: bpy.types.Mesh) -> Optional[OrbifoldLayout]:
    """The one that was written last, whether or not it was undone since."""
    kept = mesh.orbifold.layouts
    return kept[len(kept) - 1] if len(kept) else None


def read(mesh: bpy.types.Mesh, arrays: blender_mesh.MeshArrays) -> Layout:
    """The layout that the UV map has. In object mode. Raises BlenderMeshError where there is none."""
    if blender_mesh.UV_MAP not in mesh.uv_layers or not has_layout(mesh):
        raise blender_mesh.BlenderMeshError("The mesh has no layout yet: use Orbifold Unwrap first")
    there = blender_mesh.read_uv(mesh)
    for item in reversed(mesh.orbifold.layouts):
        kept = _unpacked(item.arrays)
        loops, known = kept["loops"], kept["uv"]
        if loops.max() < len(there) and np.abs(there[loops] - known).max() < SAME * max(1, np.abs(known).max()):
            break
    else:
        raise blender_mesh.BlenderMeshError(
            f"The mesh or its UV map {UV_MAP} has changed since it was unwrapped: use Orbifold Unwrap again"
        )
    chart = chart_of(item.chart, item.geometry, kept["points"], kept["uv"])
    uv = there[arrays.loops].astype(np.float64)
    points = chart.to_point(uv.reshape(-1, 2)).reshape(-1, 3, 3)
    return Layout(
        *(item.signature, item.geometry, item.chart, chart, uv, points, kept["generators"], kept["cones"]),
        *(kept["orders"], float(kept["euler"]), kept["lattice"] if len(kept["lattice"]) else None),
    )


def _affine(source: np.ndarray, target: np.ndarray) -> np.ndarray:
    """(3, 2) the affine map that takes the points (k, 3, 2) to those."""
    flat = source.reshape(-1, 2)
    found, *_ = np.linalg.lstsq(np.column_stack([flat, np.ones(len(flat))]), target.reshape(-1, 2), rcond=None)
    return found


def _packed(**arrays: np.ndarray) -> str:
    file = io.BytesIO()
    np.savez(file, **arrays)
    return base64.b64encode(file.getvalue()).decode("ascii")


def _unpacked(text: str) -> dict[str, np.ndarray]:
    with np.load(io.BytesIO(base64.b64decode(text)), allow_pickle=False) as file:
        return dict(file)


# ---------------------------------------------------------------------------------------------------- the cut

PATH_ATTRIBUTE = blender_mesh.PATH_ATTRIBUTE


def keep_cut(
    mesh: bpy.types.Mesh, seams: np.ndarray, numbers: np.ndarray, edges: Optional[np.ndarray] = None
) -> None:
    """Write the paths (k,) of the cut's edges, pairs of vertices (k, 2), whose seams are marked or not. In object
    mode. `edges`: of `blender_mesh.read_edges`, where they are at hand."""
    found = blender_mesh.edge_indices(mesh, seams, edges)
    on_mesh = found >= 0
    ours = blender_mesh.read_our_seams(mesh)
    paths = np.zeros(len(mesh.edges), np.int32)
    paths[found[on_mesh]] = 2 * (numbers[on_mesh] + 1) + ~ours[found[on_mesh]]
    blender_mesh.write_int_attribute(mesh, PATH_ATTRIBUTE, paths, "EDGE")


def keep_cut_in_edit_mode(mesh: bpy.types.Mesh, seams: np.ndarray, numbers: np.ndarray, mark_seams: bool) -> None:
    """Paths, and if so asked seams, of a new cut, where an unwrap has made the attribute."""
    bm = bmesh.from_edit_mesh(mesh)
    layer = bm.edges.layers.int.get(PATH_ATTRIBUTE)
    if layer is None:
        return
    for edge in bm.edges:
        if edge[layer]:
            edge.seam = edge.seam and edge[layer] % 2 == 1
            edge[layer] = 0
    bm.verts.ensure_lookup_table()
    for (a, b), number in zip(seams.tolist(), numbers.tolist()):
        edge = bm.edges.get((bm.verts[a], bm.verts[b]))
        if edge is not None:
            edge[layer] = 2 * (number + 1) + (edge.seam or not mark_seams)
            edge.seam = edge.seam or mark_seams
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)


def read_cut(mesh: bpy.types.Mesh) -> tuple[list, np.ndarray, np.ndarray]:
    """Indices (s,), vertices (s, 2) and paths (s,), from 0, of the cut's edges. Not in edit mode."""
    paths = blender_mesh.read_int_attribute(mesh, PATH_ATTRIBUTE, "EDGE")
    if paths is None:
        return [], np.zeros((0, 2), int), np.zeros(0, int)
    found = np.flatnonzero(paths)
    return found.tolist(), blender_mesh.read_edges(mesh)[found].astype(int), path_of(paths[found].astype(int))


def path_of(value):
    """The path, from 0, of an edge on the cut with this value of the attribute; also of an array of them."""
    return value // 2 - 1


def cone_places(item: OrbifoldLayout) -> dict[int, int]:
    """Vertex of each cone -> its place in the signature's sequence."""
    return {int(word): place for place, word in enumerate(item.cones.split())}
