# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a person would pick: mirror corners along boundary loops, cones far from one another and from the boundary."""

import numpy as np


def boundary_loops(triangles):
    """The boundary's loops as lists of vertices, the longest first; along the triangles where these are oriented."""
    sides = np.stack([triangles, np.roll(triangles, -1, 1)], 2).reshape(-1, 2)
    _, first, count = np.unique(np.sort(sides, 1), axis=0, return_index=True, return_counts=True)
    border = sides[first[count == 1]]
    beside = {}
    for a, b in border.tolist():
        beside.setdefault(a, []).append(b)
        beside.setdefault(b, []).append(a)
    loops, seen = [], set()
    for start, second in border.tolist():
        if start in seen:
            continue
        loop = [start, second]
        while loop[-1] != start:
            (onward,) = [v for v in beside[loop[-1]] if v != loop[-2]]
            loop.append(onward)
        loops.append(loop[:-1])
        seen.update(loop)
    return sorted(loops, key=len, reverse=True)


def along(vertices, loop, k, start=0.1):
    """k vertices of a loop at about equal arc lengths, the first a fraction `start` of the way round."""
    points = vertices[loop]
    length = np.linalg.norm(np.roll(points, -1, 0) - points, axis=1)
    at = np.cumsum(length) - length
    picked = []
    for i in range(k):
        wanted = (start + i / k) % 1 * length.sum()
        gap = np.abs((at - wanted + length.sum() / 2) % length.sum() - length.sum() / 2)
        gap[[loop.index(v) for v in picked]] = np.inf
        picked.append(loop[int(np.argmin(gap))])
    return picked


def inside(vertices, triangles, k):
    """k vertices off the boundary, far from it and from one another, in the sequence of a short walk."""
    used = np.unique(triangles)
    border = np.unique(np.concatenate([*boundary_loops(triangles), [-1]]).astype(int))[1:]
    free = np.setdiff1d(used, border)
    points = vertices[free]
    middle = points.mean(0)
    if len(border):
        distance = np.full(len(free), np.inf)
        for v in border:
            distance = np.minimum(distance, ((points - vertices[v]) ** 2).sum(1))
        distance *= 0.8
    else:
        distance = ((points - middle) ** 2).sum(1)
    picked = []
    while len(picked) < k:
        picked.append(int(np.argmax(distance)))
        if len(picked) == 1 and not len(border):
            distance = np.full(len(free), np.inf)
        distance = np.minimum(distance, ((points - points[picked[-1]]) ** 2).sum(1))
    walk = picked[:1]
    while len(walk) < k:
        left = [v for v in picked if v not in walk]
        walk.append(left[int(np.argmin(((points[left] - points[walk[-1]]) ** 2).sum(1)))])
    return free[walk].tolist()


def picks_for(vertices, triangles, features, start=0.1):
    """Vertices for every cone and corner of a signature, in its sequence: mirror i on the i-th longest loop."""
    loops = boundary_loops(triangles)
    picked = inside(vertices, triangles, len(features.cones))
    for loop, corners in zip(loops, features.mirrors):
        picked += along(vertices, loop, len(corners), start)
    return picked
