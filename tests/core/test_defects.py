# SPDX-License-Identifier: GPL-3.0-or-later
"""Faults of a mesh, all at once (core/defects.py)."""

from __future__ import annotations

import core
import numpy as np
import pytest

POINTS = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], float)
SOLID = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]


def found(points, triangles) -> dict[str, list]:
    triangles = np.asarray(triangles)
    sizes, faces = np.full(len(triangles), 3), np.arange(len(triangles))
    defects = core.find_defects(np.asarray(points, float), triangles.ravel(), sizes, triangles, faces)
    assert all(len(defect.text) > 5 and defect.text[-1] != "." for defect in defects)
    return {defect.kind: [defect.count, defect.elements.tolist()] for defect in defects}


def test_a_good_mesh():
    assert found(POINTS, SOLID) == {}


ROWS = {
    "repeated face": (POINTS, [*SOLID, (1, 2, 0)], {"repeated_face": [1, [4]]}),
    "names a vertex twice": (POINTS, [*SOLID, (0, 1, 1)], {"repeated_corner": [1, [4]]}),
    "flipped": (POINTS, [*SOLID[:3], (0, 2, 3)], {"flipped": [1, [3]]}),
    "open": (POINTS, SOLID[:3], {"boundary": [1, [[0, 2], [0, 3], [2, 3]]]}),
    "isolated": ([*POINTS, (9, 9, 9)], SOLID, {"isolated": [1, [4]]}),
    "two pieces": ([*POINTS, *(POINTS + 3)], [*SOLID, *(tuple(v + 4 for v in face) for face in SOLID)],
                   {"pieces": [2, [4, 5, 6, 7]]}),
    "two at a vertex": ([*POINTS, *(POINTS[1:] - 3)], [*SOLID, (0, 5, 4), (0, 4, 6), (4, 5, 6), (5, 0, 6)],
                        {"vertex": [1, [0]]}),
    "no number": ([*POINTS[:3], (0, 0, np.nan)], SOLID, {"not_finite": [1, [3]]}),
    "zero area": ([*POINTS[:3], POINTS[1]], SOLID, {"zero_area": [2, [1, 2]]}),
    "three at an edge": ([*POINTS, (2, 2, 2)], [*SOLID, (0, 1, 4)],
                         {"edge": [1, [[0, 1]]], "boundary": [1, [[0, 4], [1, 4]]]}),
}


@pytest.mark.parametrize("case", ROWS)
def test_each_kind(case: str):
    points, triangles, wanted = ROWS[case]
    assert found(points, triangles) == wanted


def test_of_two_halves_that_disagree_the_smaller_one_is_flipped():
    n = 12
    ring = [(np.cos(a), np.sin(a), 0) for a in 2 * np.pi * np.arange(n) / n]
    up = [(n, k, (k + 1) % n) for k in range(n)]
    down = [(n + 1, (k + 1) % n, k) for k in range(n)]
    turned = [face[::-1] if k < 5 else face for k, face in enumerate(up + down)]
    assert found([*ring, (0, 0, 1), (0, 0, -1)], turned) == {"flipped": [5, list(range(5))]}
    turned = [face[::-1] for face in turned]  # all look the other way: not one of them is wrong
    assert found([*ring, (0, 0, 1), (0, 0, -1)], turned)["flipped"][0] == 5


def test_a_one_sided_mesh_has_no_flipped_faces():
    n = 10
    faces = []
    for k in range(n):
        a, b, c, d = 2 * k, 2 * k + 1, 2 * k + 2, 2 * k + 3
        if k == n - 1:
            c, d = 1, 0
        faces += [(a, c, b), (b, c, d)]
    points = np.random.default_rng(2).random((2 * n, 3))
    assert set(found(points, faces)) == {"boundary"}
