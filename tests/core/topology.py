# SPDX-License-Identifier: GPL-3.0-or-later
"""What kind of surface a mesh is, found by the tests in their own way."""

from dataclasses import dataclass

import numpy as np
from picks import boundary_loops
from shapes import edges_of


@dataclass(frozen=True)
class Topology:
    euler: int
    loops: int
    orientable: bool
    oriented: bool  # neighbours run through their common edge in opposite ways


def topology_of(triangles):
    """AssertionError where the mesh is no connected surface."""
    triangles = np.asarray(triangles)
    assert (np.diff(np.sort(triangles, 1), axis=1) > 0).all(), "a triangle names a vertex twice"
    assert len(np.unique(np.sort(triangles, 1), axis=0)) == len(triangles), "two triangles on the same vertices"
    _check_fans(triangles)
    on_edge = {}
    for t, (a, b, c) in enumerate(triangles.tolist()):
        for p, q in ((a, b), (b, c), (c, a)):
            on_edge.setdefault((min(p, q), max(p, q)), []).append((t, p < q))
    assert max(map(len, on_edge.values())) <= 2, "more than two triangles on an edge"
    across = [[] for _ in triangles]
    for sides in on_edge.values():
        if len(sides) == 2:
            (s, up), (t, down) = sides
            across[s].append((t, up != down))
            across[t].append((s, up != down))
    turned, orientable = {0: False}, True
    queue = [0]
    while queue:
        s = queue.pop()
        for t, agrees in across[s]:
            wanted = turned[s] != (not agrees)
            if t not in turned:
                turned[t] = wanted
                queue.append(t)
            orientable &= turned[t] == wanted
    assert len(turned) == len(triangles), "the mesh is in several pieces"
    oriented = all(agrees for sides in across for _, agrees in sides)
    n_vertices = len(np.unique(triangles))
    euler = n_vertices - len(edges_of(triangles)) + len(triangles)
    return Topology(euler, len(boundary_loops(triangles)), orientable, oriented)


def _check_fans(triangles):
    """The triangles around each vertex are one fan: their outer sides are one path or one loop."""
    outer = {}
    for a, b, c in triangles.tolist():
        for v, p, q in ((a, b, c), (b, c, a), (c, a, b)):
            outer.setdefault(v, []).append((p, q))
    for v, sides in outer.items():
        beside = {}
        for p, q in sides:
            beside.setdefault(p, []).append(q)
            beside.setdefault(q, []).append(p)
        assert max(map(len, beside.values())) <= 2, f"vertex {v} has three triangles on an edge"
        start = next((p for p, at in beside.items() if len(at) == 1), next(iter(beside)))
        seen, queue = {start}, [start]
        while queue:
            new = set(beside[queue.pop()]) - seen
            seen |= new
            queue += new
        assert len(seen) == len(beside), f"the triangles around vertex {v} are several fans"
