# SPDX-License-Identifier: GPL-3.0-or-later
"""The independent judge's verdict on a result, and the harmonic condition where he cannot see it."""

import functools
import runpy

import numpy as np
from conway import features
from meshes import CHECK_LAYOUT, shared_file


@functools.lru_cache(maxsize=1)
def judge_module():
    return runpy.run_path(str(CHECK_LAYOUT))


def verdict(result, folder):
    """What check_layout.py says of the result's file. He walks around vertices along the triangles' orientation, which
    changes sides within a surface with cross-caps: for those the weights are kept from him and judged here."""
    if features(result.signature).crosscaps == 0:
        shared_file("tools", "check_layout.py")
        result.save(folder / "layout.npz")
        return judge_module()["check"](folder / "layout.npz", 1e-7)
    said = judge_without_weights(result, folder)
    said["harmonic_residual"] = harmonic_residual(result)
    if not said["harmonic_residual"] < 1e-6:
        said["ok"] = False
        said["why"].append("a free vertex is not at the Karcher mean of its neighbours")
    return said


def judge_without_weights(result, folder):
    """All but the harmonic condition."""
    shared_file("tools", "check_layout.py")
    path = folder / "layout.npz"
    result.save(path)
    with np.load(path) as file:
        arrays = {name: file[name] for name in file if name != "weights"}
    np.savez(path, **arrays)
    return judge_module()["check"](path, 1e-7)


def model_points(result):
    return np.asarray(result.embedding, np.longdouble) + result.embedding_low


def sides_and_angles(result):
    """(m, 3) lengths of the sides corner k to k + 1, and the angles at corner k, in the geometry."""
    judge, curvature = judge_module(), {"euclidean": 0, "spherical": 1, "hyperbolic": -1}[result.geometry]
    corners = model_points(result)[result.cut_triangles]
    side = judge["length"](judge["log_map"](corners, np.roll(corners, -1, 1), curvature), curvature)
    return side, judge["corner_angles"](corners, curvature)


def singular_spread(result):
    """Twice the area-weighted standard deviation of the logarithms of all triangles' singular values; for a conformal
    map that is the spread of log area. Triangles are compared by their sides, as if the tile's were flat."""
    shared_file("tools", "check_layout.py")
    corners = result.vertices[result.triangles]
    there = np.linalg.norm(np.roll(corners, -1, 1) - corners, axis=2)
    here, _ = sides_and_angles(result)
    grams = []
    for side in (there, np.asarray(here, float)):
        a, b, c = (side.T / side.mean()) ** 2  # of corners 0 1, 1 2, 2 0
        grams.append(np.moveaxis(np.array([[a, (a + c - b) / 2], [(a + c - b) / 2, c]]), 2, 0))
    logs = np.log(np.linalg.eigvals(np.linalg.solve(*grams)).real) / 2
    area = np.sqrt(np.linalg.det(grams[0])) / 2
    mean = np.average(logs.mean(1), weights=area)
    return 2 * np.sqrt(np.average(((logs - mean) ** 2).mean(1), weights=area))


def harmonic_residual(result):
    """The greatest |sum w log| / sum w |log| of free vertices, by unfolding each ring, whichever way the triangles
    run; along the mirror only for vertices on one."""
    side, angle = (np.asarray(a, float) for a in sides_and_angles(result))
    weight = {(int(min(i, j)), int(max(i, j))): w for i, j, w in result.weights}
    spokes = {}  # vertex: {neighbour: [(triangle's angle at the vertex, the other neighbour), ...]}
    length = {}
    for t, triangle in enumerate(result.triangles.tolist()):
        for k in range(3):
            v, p, q = triangle[k], triangle[k - 2], triangle[k - 1]
            length[v, p] = length[p, v] = side[t, k]
            at = spokes.setdefault(v, {})
            at.setdefault(p, []).append((angle[t, k], q))
            at.setdefault(q, []).append((angle[t, k], p))
    fixed, worst = set(result.cones.tolist()), 0.0
    for v, at in spokes.items():
        if v in fixed:
            continue
        on_mirror = any(len(beside) == 1 for beside in at.values())
        p = next((p for p, beside in at.items() if len(beside) == 1), next(iter(at)))
        turned, total, scale, seen = 0.0, 0j, 0.0, set()
        while p not in seen:
            seen.add(p)
            pull = weight[min(v, p), max(v, p)] * length[v, p]
            total, scale = total + pull * np.exp(1j * turned), scale + pull
            onward = [(a, q) for a, q in at[p] if q not in seen]
            if not onward:
                break
            turned, p = turned + onward[0][0], onward[0][1]
        assert seen == set(at)
        worst = max(worst, abs(total.real if on_mirror else total) / scale)
    return worst
