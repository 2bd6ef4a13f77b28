# SPDX-License-Identifier: GPL-3.0-or-later
"""Cones without being told where: extremities of the mesh by farthest-point sampling along its edges, and mirror
corners spread along the boundary by its length."""

from __future__ import annotations

import numpy as np

from .. import core
from .errors import RunError


def automatic_cones(vertices: np.ndarray, triangles: np.ndarray, signature: core.Signature) -> list[int]:
    """A vertex for each cone and corner, in the signature's sequence. The longest boundary loops are its mirrors, in
    their sequence. vertices (n, 3), triangles (m, 3)."""
    if len(triangles) == 0:
        raise RunError("the mesh has no triangles to place cones on")
    if not signature.orders:
        return []
    loops = sorted(core.topology_of(triangles).loops, key=lambda loop: -_length(vertices[loop]))
    mirrors = loops[: signature.n_mirrors]
    if len(mirrors) < signature.n_mirrors and any(signature.borders[len(mirrors) :]):
        raise RunError(f"{signature.signature} has {signature.n_mirrors} mirrors, and the mesh {len(loops)} boundary "
                       "loops to place their corners on")
    border = np.concatenate(loops) if loops else np.zeros(0, np.int64)
    cones = farthest_vertices(vertices, triangles, signature.n_interior, border,
                              np.concatenate(mirrors) if mirrors else border[:0])
    for loop, orders in zip(mirrors, signature.borders):
        cones += spread_corners(vertices, loop, len(orders))
    return cones


def farthest_vertices(vertices: np.ndarray, triangles: np.ndarray, count: int, border: np.ndarray,
                      mirrors: np.ndarray) -> list[int]:
    """`count` vertices off the border, each the farthest one, along edges, from all before it and from the mirrors;
    without mirrors, the first is the farthest from the mean vertex. Ties go to the lower number, so the same mesh
    always gives the same vertices.

    vertices (n, 3), triangles (m, 3), border and mirrors: vertices. O(count * edges * hops); no vertex is visited in
    Python.
    """
    used = np.unique(triangles)
    free = np.setdiff1d(used, border)
    if len(free) < count:
        raise RunError(f"{count} cones need as many vertices off the boundary, and the mesh has {len(free)}")
    distance = np.full(len(vertices), np.inf)
    if count == 0:
        return []
    graph = _Graph(vertices, triangles)
    if len(mirrors):
        graph.lower(distance, mirrors)
        start = int(free[np.argmax(_reachable(distance[free]))])
        distance[:] = np.inf  # from each other, cones are apart as they would be without mirrors
    else:
        offset = np.linalg.norm(vertices - vertices[used].mean(axis=0), axis=1)
        start = int(free[np.argmax(offset[free])])
    off_mirrors = np.full(len(vertices), np.inf)
    graph.lower(off_mirrors, mirrors)
    chosen: list[int] = []
    for _ in range(count):
        clear = np.minimum(_reachable(distance[free]), 2 * _reachable(off_mirrors[free], np.inf))
        chosen.append(int(free[np.argmax(clear)]) if chosen else start)
        graph.lower(distance, np.array(chosen[-1:]))
    return chosen


def spread_corners(vertices: np.ndarray, loop: np.ndarray, count: int) -> list[int]:
    """`count` vertices of a boundary loop (b,) in turn, evenly by its length, from the one farthest from its mean."""
    if len(loop) < count:
        raise RunError(f"{count} mirror corners need as many vertices, and the boundary loop through vertex {loop[0]} "
                       f"has {len(loop)}: subdivide there")
    points = vertices[loop]
    start = int(np.argmax(np.linalg.norm(points - points.mean(0), axis=1))) if count else 0
    loop, points = np.roll(loop, -start), np.roll(points, -start, axis=0)
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    wanted = np.arange(count) * _length(points) / max(count, 1)
    chosen: list[int] = []
    for number, place in enumerate(wanted):  # each leaves enough vertices for those after it
        first, last = (chosen[-1] + 1 if chosen else 0), len(loop) - (count - number)
        chosen.append(first + int(np.argmin(np.abs(along[first : last + 1] - place))))
    return [int(vertex) for vertex in loop[chosen]]


def _length(points: np.ndarray) -> float:
    return float(np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1).sum())


def _reachable(distance: np.ndarray, else_value: float = -1.0) -> np.ndarray:
    """Vertices of other components are infinitely far: the solver refuses such meshes with a better message."""
    return np.where(np.isfinite(distance), distance, else_value)


class _Graph:
    """The mesh's half-edges sorted by their start, for relaxing all edges out of a set of vertices at once."""

    def __init__(self, vertices: np.ndarray, triangles: np.ndarray) -> None:
        ends = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
        ends = np.concatenate([ends, ends[:, ::-1]])  # both ways: twice the work on closed meshes, right on all
        ends = ends[np.argsort(ends[:, 0], kind="stable")]
        self.start = np.searchsorted(ends[:, 0], np.arange(len(vertices) + 1))
        self.target = ends[:, 1]
        self.length = np.linalg.norm(vertices[ends[:, 1]] - vertices[ends[:, 0]], axis=1)

    def lower(self, distance: np.ndarray, sources: np.ndarray) -> None:
        """distance[v] = min(distance[v], length of the shortest edge path from a source to v), in place."""
        distance[sources] = 0.0
        front = np.asarray(sources)
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
