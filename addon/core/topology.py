# SPDX-License-Identifier: GPL-3.0-or-later
"""Which surface a mesh is: Euler characteristic, boundary loops, orientability, genus. For menus and automatic cones;
the library finds out for itself, and is the judge of what is no manifold."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Topology:
    euler: int
    components: int
    loops: tuple[np.ndarray, ...]  # vertices of each boundary loop in turn, the longest loop (in edges) first
    orientable: bool

    @property
    def genus(self) -> int:
        """Handles, or cross-caps where the surface is not orientable; of a mesh in one piece."""
        missing = 2 * self.components - self.euler - len(self.loops)
        return missing // 2 if self.orientable else missing


def topology_of(faces: np.ndarray, sizes: np.ndarray | None = None) -> Topology:
    """Of triangles (m, 3), or of polygons: their corners (s,) one after the other and how many each has (m,)."""
    corners = np.asarray(faces).ravel().astype(np.int64)
    if sizes is None:
        sizes = np.full(len(faces), 3)
    if not len(corners):
        return Topology(0, 0, (), True)
    there = np.bincount(corners) > 0  # isolated vertices do not count
    used, corners = np.flatnonzero(there), (np.cumsum(there) - 1)[corners]
    n = len(used)
    starts = np.concatenate([[0], np.cumsum(sizes)[:-1]])
    after = np.arange(len(corners)) + 1
    after[starts + sizes - 1] = starts
    ends = corners[after]
    keys = np.minimum(corners, ends) * n + np.maximum(corners, ends)
    order = np.argsort(keys, kind="stable")
    first = np.flatnonzero(np.concatenate([[True], keys[order][1:] != keys[order][:-1]]))
    count = np.diff(np.concatenate([first, [len(keys)]]))
    single, double = order[first[count == 1]], first[count == 2]
    one, other = order[double], order[double + 1]
    components = int(len(np.unique(connected(n, corners, ends))))
    loops = _loops(np.stack([corners[single], ends[single]], 1))
    face = np.repeat(np.arange(len(sizes)), sizes)
    orientable = _is_orientable(len(sizes), face[one], face[other], corners[one] == corners[other])
    named = tuple(used[loop] for loop in sorted(loops, key=len, reverse=True))
    return Topology(n - len(first) + len(sizes), components, named, orientable)


def vertex_components(n: int, triangles: np.ndarray) -> np.ndarray:
    """(n,) the least vertex of the component that each one belongs to; an isolated vertex is one of its own."""
    start = triangles.ravel().astype(np.int64)
    return connected(n, start, np.roll(triangles, -1, axis=1).ravel().astype(np.int64))


def _is_orientable(m: int, one: np.ndarray, other: np.ndarray, turned: np.ndarray) -> bool:
    """Faces `one` and `other` (e,) share an edge that both run through the same way where `turned` (e,). Orientable:
    no face is connected with its own back."""
    if not turned.any():
        return True
    flip = np.where(turned, m, 0)
    start, end = np.concatenate([one, one + m]), np.concatenate([other + flip, (other + m + flip) % (2 * m)])
    root = connected(2 * m, start, end % (2 * m))
    return bool((root[:m] != root[m:]).all())


def connected(n: int, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """(n,) the least node that each one is connected with. A few passes over the edges at any size: labels are hooked
    to lower ones and the paths to them shortened."""
    label = np.arange(n)
    while True:
        one, other = label[start], label[end]
        apart = one != other
        if not apart.any():
            return label
        start, end, one, other = start[apart], end[apart], one[apart], other[apart]
        label[np.maximum(one, other)] = np.minimum(one, other)  # any of several will do
        while not np.array_equal(label[label], label):
            label = label[label]


def _loops(edges: np.ndarray) -> list[np.ndarray]:
    """Edges (b, 2) of the boundary -> the vertices of its loops in turn. Where more than two edges meet the mesh is no
    manifold, and whatever comes out will not be used."""
    following: dict[int, list[int]] = {}
    for a, b in edges.tolist():
        following.setdefault(a, []).append(b)
        following.setdefault(b, []).append(a)
    loops = []
    while following:
        at = next(iter(following))
        loop = []
        while following.get(at):
            loop.append(at)
            ahead = following[at].pop(0)
            following[ahead].remove(at)
            if not following[at]:
                del following[at]
            at = ahead
        following.pop(at, None)
        loops.append(np.array(loop))
    return loops
