# SPDX-License-Identifier: GPL-3.0-or-later
"""A layout for the faces of a Blender mesh: triangles, quads and n-gons, none of them torn (core/whole.py)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .blender_mesh import MeshArrays
from .core import Result, charts, edge_keys, whole_layout

FLAT = 1e-12  # of the unit square: a triangle of less area has been flattened onto a mirror


@dataclass(frozen=True)
class FaceLayout:
    """A layout in which no seam crosses a face, for the m triangles of the object's mesh."""

    chart: str
    uv: np.ndarray  # (m, 3, 2) per triangle corner
    embedding: np.ndarray  # (m, 3, 3) the corners' points on the plane, sphere or hyperboloid
    seams: np.ndarray  # (k, 2) vertex pairs, edges of triangles
    mended: int  # faces that the cut ran through
    flat: int  # triangles without area: all of their corners lie on one mirror, where the library has halved an edge


def layout_of(result: Result, arrays: MeshArrays, chart: str) -> FaceLayout:
    whole = whole_layout(result, chart, arrays.polygons, joins=True)
    corners, n = result.input_corners, len(result.vertices)
    uv, placed = whole.uv.reshape(-1, 2)[corners], whole.points.reshape(-1, 3)[corners]
    for loops in (uv, placed):
        _agree(arrays, loops)
    signed = charts.areas(uv) if result.report["mesh"]["orientable"] else np.abs(charts.areas(uv))
    flat = int((signed < FLAT).sum()) if result.refined_edges else 0
    edges = np.intersect1d(edge_keys(arrays.triangles, n), whole.seams)
    pairs = np.stack([edges // n, edges % n], 1).astype(np.int32)
    return FaceLayout(chart, uv, placed, pairs, whole.mended, flat)


def plain_layout(result: Result) -> FaceLayout:
    """The layout of a mesh of triangles in the result's own chart, faces crossed by its discontinuities or not."""
    return FaceLayout(result.chart, result.uv, result.embedding[result.corner_copies], result.seams, 0, 0)


def remarks(result: Result, layout: FaceLayout) -> list[str]:
    """What a person should know of this layout beside its measures, in sentences without a full stop."""
    said = []
    if result.filled_holes:
        holes = "a hole was" if result.filled_holes == 1 else f"{result.filled_holes} holes were"
        said.append(f"{holes} filled for the computation; the mesh is as it was")
    if layout.flat:
        triangles = "a triangle has" if layout.flat == 1 else f"{layout.flat} triangles have"
        said.append(f"{triangles} no area in the UV map, for all corners lie on one mirror: subdivide there")
    return said


def _agree(arrays: MeshArrays, values: np.ndarray) -> None:
    """The same value (m, 3, w), exactly, wherever a corner of a face occurs in several triangles: in place."""
    if arrays.all_triangles:
        return
    _, first, place = np.unique(arrays.loops.ravel(), return_index=True, return_inverse=True)
    flat = values.reshape(arrays.loops.size, -1)
    flat[:] = flat[first][place.ravel()]
