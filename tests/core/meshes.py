# SPDX-License-Identifier: GPL-3.0-or-later
"""Small meshes that the tests make themselves, cones on them, and the independent judge."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import SHARED

CHECK_LAYOUT = SHARED / "tools" / "check_layout.py"


def tetrahedron():
    vertices = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], float)
    return vertices, np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])


def octahedron():
    vertices = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], float)
    up = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4]]
    down = [[2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
    return vertices, np.array(up + down)


def cube():
    """Eight vertices, twelve triangles."""
    vertices = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
    quads = np.array([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]])
    return vertices, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def icosphere(level):
    """10 * 4^level + 2 vertices on the unit sphere."""
    g = (1 + np.sqrt(5)) / 2
    vertices = np.array(
        [[-1, g, 0], [1, g, 0], [-1, -g, 0], [1, -g, 0], [0, -1, g], [0, 1, g]]
        + [[0, -1, -g], [0, 1, -g], [g, 0, -1], [g, 0, 1], [-g, 0, -1], [-g, 0, 1]]
    )
    triangles = np.array(
        [[0, 11, 5], [0, 5, 1], [0, 1, 7], [0, 7, 10], [0, 10, 11], [1, 5, 9], [5, 11, 4], [11, 10, 2], [10, 7, 6]]
        + [[7, 1, 8], [3, 9, 4], [3, 4, 2], [3, 2, 6], [3, 6, 8], [3, 8, 9], [4, 9, 5], [2, 4, 11], [6, 2, 10]]
        + [[8, 6, 7], [9, 8, 1]]
    )
    for _ in range(level):
        vertices, triangles = subdivided(vertices, triangles)
        vertices /= np.linalg.norm(vertices, axis=1, keepdims=True)
    return vertices / np.linalg.norm(vertices, axis=1, keepdims=True), triangles


def subdivided(vertices, triangles):
    """Each triangle as four, new vertices at the middles of the edges."""
    halfedges = np.sort(np.stack([triangles, np.roll(triangles, -1, 1)], 2).reshape(-1, 2), 1)
    edges, of = np.unique(halfedges, axis=0, return_inverse=True)
    middle = len(vertices) + of.reshape(-1, 3)
    a, b, c = triangles.T
    ab, bc, ca = middle.T
    parts = [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
    return np.concatenate([vertices, vertices[edges].mean(1)]), np.concatenate([np.stack(p, 1) for p in parts])


def torus(n=8, m=6):
    i, j = np.meshgrid(np.arange(n), np.arange(m), indexing="ij")
    u, v = 2 * np.pi * i.ravel() / n, 2 * np.pi * j.ravel() / m
    vertices = np.stack([(2 + np.cos(v)) * np.cos(u), (2 + np.cos(v)) * np.sin(u), np.sin(v)], 1)

    def at(di, dj):
        return ((i + di) % n * m + (j + dj) % m).ravel()

    a, b, c, d = at(0, 0), at(1, 0), at(1, 1), at(0, 1)
    return vertices, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


def far_apart(vertices, triangles, k):
    """k vertices by farthest-point sampling, in the sequence of a short walk from the one farthest from the centroid.

    The cut runs through the cones in turn, so a sequence that goes to and fro asks for a very distorted map."""
    used = np.unique(triangles)
    points = vertices[used]
    picked = [int(np.argmax(((points - points.mean(0)) ** 2).sum(1)))]
    distance = np.full(len(points), np.inf)
    while len(picked) < k:
        distance = np.minimum(distance, ((points - points[picked[-1]]) ** 2).sum(1))
        picked.append(int(np.argmax(distance)))
    walk = picked[:1]
    while len(walk) < k:
        left = [v for v in picked if v not in walk]
        walk.append(left[int(np.argmin(((points[left] - points[walk[-1]]) ** 2).sum(1)))])
    return used[walk].astype(np.int32)


def shared_file(*parts):
    """A file beside the checkout, or the test is skipped by name."""
    path = Path(SHARED, *parts)
    if not path.is_file():
        pytest.skip(f"{'/'.join(parts)} is not there")
    return path


def judge(layout):
    """What check_layout.py says of a .npz, as a dictionary with "ok" and "why"."""
    run = subprocess.run(
        [sys.executable, str(CHECK_LAYOUT), str(layout), "--json"], capture_output=True, text=True, check=False
    )
    return json.loads(run.stdout) if run.stdout.strip() else {"ok": False, "why": [run.stderr]}


def agrees(result, folder):
    """check_layout.py is content, where it is there; what the report says is checked in any case."""
    certificate = result.report["certificate"]
    assert certificate["flipped"] == 0 and certificate["seam_residual"] < 1e-7
    result.save(folder / "mesh.npz")
    if CHECK_LAYOUT.is_file():
        said = judge(folder / "mesh.npz")
        assert said["ok"], said["why"]


def uv_area(uv):
    a, b = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
    return (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2
