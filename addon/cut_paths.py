# SPDX-License-Identifier: GPL-3.0-or-later
"""The cut of a layout as paths; no bpy. A path runs between two places where the cut branches or ends, or a cone lies:
across the whole of it one isometry carries one side of the tile to the other, so that a path of the mesh is two sides
of the tile that are glued together."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np


def number_paths(edges: np.ndarray, cones: Iterable[int]) -> np.ndarray:
    """(k,) the path, 0, 1, ..., that each edge (k, 2) of the cut belongs to; a cycle without a cone is one."""
    at: dict[int, list[int]] = {}
    for edge, (a, b) in enumerate(edges.tolist()):
        at.setdefault(a, []).append(edge)
        at.setdefault(b, []).append(edge)
    ends = {int(cone) for cone in cones} | {vertex for vertex, met in at.items() if len(met) != 2}
    numbers = np.full(len(edges), -1)
    count = 0
    starts = [(vertex, edge) for vertex in sorted(ends & at.keys()) for edge in at[vertex]]
    for vertex, edge in starts + [(int(ends_of[0]), edge) for edge, ends_of in enumerate(edges)]:
        if numbers[edge] >= 0:
            continue
        while numbers[edge] < 0:
            numbers[edge] = count
            a, b = edges[edge].tolist()
            vertex = b if vertex == a else a
            if vertex in ends:
                break
            one, other = at[vertex]
            edge = other if one == edge else one
        count += 1
    return numbers
