# SPDX-License-Identifier: GPL-3.0-or-later
"""The tile of an embedding and its images under the orbifold's group, for the picture; reflected ones included."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .. import core
from ..core.charts import CURVATURE
from ..group import Group

LARGEST_FINITE = 400  # finite groups up to this order are drawn completely


@dataclass(frozen=True)
class Tiling:
    curvature: int
    points: np.ndarray  # (copies, 3) the tile's vertices in the model
    triangles: np.ndarray  # (m, 3) without those of filled holes
    corners: np.ndarray  # (m, 3) where the triangles' corners are among all the tile's
    cones: np.ndarray  # (k,) copies of cones and mirror corners among the points
    outline: np.ndarray  # (s, 2) edges of a single triangle
    mirrors: np.ndarray  # (s,) bool: which of them lie on a mirror, or on a fixed boundary
    group: np.ndarray  # (g, 3, 3) matrices; the first is the identity, the tile itself


def make_tiling(result: core.Result, limit: int) -> Tiling:
    """At most `limit` images of the tile, nearest first; of a finite group all, up to LARGEST_FINITE."""
    curvature = CURVATURE[result.geometry]
    shown = np.arange(len(result.triangles))
    if result.refined_from is not None:
        shown = np.flatnonzero(result.refined_from >= 0)
    triangles = result.cut_triangles[shown]
    cones = np.flatnonzero(np.isin(result.cut_to_vertex, result.cones))
    if curvature > 0 and result.signature:
        limit = max(limit, min(round(2 / core.parse_signature(result.signature).euler), LARGEST_FINITE))
    elements = Group(result.generators, curvature, result.embedding[triangles].reshape(-1, 3)).nearest(limit)
    outline = _single_edges(triangles)
    border = _single_edges(result.triangles)
    n = len(result.vertices)
    mirrors = np.isin(_keys(result.cut_to_vertex[outline], n), _keys(border, n))
    corners = shown[:, None] * 3 + np.arange(3)
    return Tiling(curvature, result.embedding, triangles, corners, cones, outline, mirrors, elements)


def _single_edges(triangles: np.ndarray) -> np.ndarray:
    """(s, 2) edges of one triangle only, in its direction."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    _, first, count = np.unique(
        _keys(edges, int(triangles.max(initial=0)) + 1), return_index=True, return_counts=True
    )
    return edges[first[count == 1]]


def _keys(edges: np.ndarray, n: int) -> np.ndarray:
    return edges.min(1).astype(np.int64) * n + edges.max(1)


def drawn(curvature: int, points: np.ndarray) -> np.ndarray:
    """(n, 3) places in space: the plane and the Poincaré disk at z = 0, the sphere as it is."""
    if curvature == 1:
        return points
    flat = points / (points[:, 2:] + (1.0 if curvature < 0 else 0.0))
    return np.column_stack([flat[:, :2], np.zeros(len(points))])
