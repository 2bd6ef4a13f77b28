# SPDX-License-Identifier: GPL-3.0-or-later
"""Cones without being told where: extremities of the mesh by farthest-point sampling along its edges."""

from __future__ import annotations

import numpy as np

from .errors import RunError


def farthest_vertices(vertices: np.ndarray, triangles: np.ndarray, count: int) -> list[int]:
    """`count` vertices, each the farthest one, along edges, from all before it; the first is the farthest from the
    mean vertex. Ties go to the lower number, so the same mesh always gives the same vertices.

    vertices (n, 3), triangles (m, 3). O(count * edges * hops); no vertex is visited in Python.
    """
    if len(triangles) == 0:
        raise RunError("the mesh has no triangles to place cones on")
    used = np.unique(triangles)
    if len(used) < count:
        raise RunError(f"{count} cones need as many vertices, and the mesh has {len(used)}")
    offset = np.linalg.norm(vertices - vertices[used].mean(axis=0), axis=1)
    start = int(used[np.argmax(offset[used])])
    graph = _Graph(vertices, triangles)
    distance = np.full(len(vertices), np.inf)
    chosen: list[int] = []
    for _ in range(count):
        nearest = start if not chosen else int(used[np.argmax(_reachable(distance[used]))])
        chosen.append(nearest)
        graph.lower(distance, nearest)
    return chosen


def _reachable(distance: np.ndarray) -> np.ndarray:
    """Vertices of other components are infinitely far: the solver refuses such meshes with a better message."""
    return np.where(np.isfinite(distance), distance, -1.0)


class _Graph:
    """The mesh's half-edges sorted by their start, for relaxing all edges out of a set of vertices at once."""

    def __init__(self, vertices: np.ndarray, triangles: np.ndarray) -> None:
        ends = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
        ends = np.concatenate([ends, ends[:, ::-1]])  # both ways: twice the work on closed meshes, right on all
        ends = ends[np.argsort(ends[:, 0], kind="stable")]
        self.start = np.searchsorted(ends[:, 0], np.arange(len(vertices) + 1))
        self.target = ends[:, 1]
        self.length = np.linalg.norm(vertices[ends[:, 1]] - vertices[ends[:, 0]], axis=1)

    def lower(self, distance: np.ndarray, source: int) -> None:
        """distance[v] = min(distance[v], length of the shortest edge path from source to v), in place."""
        distance[source] = 0.0
        front = np.array([source])
        while len(front):
            first, degree = self.start[front], self.start[front + 1] - self.start[front]
            edges = np.repeat(first - np.cumsum(degree) + degree, degree) + np.arange(degree.sum())
            target = self.target[edges]
            candidate = np.repeat(distance[front], degree) + self.length[edges]
            better = candidate < distance[target]
            target, candidate = target[better], candidate[better]
            order = np.lexsort((candidate, target))  # the least candidate of each target comes first
            front, least = np.unique(target[order], return_index=True)
            distance[front] = candidate[order][least]
