# SPDX-License-Identifier: GPL-3.0-or-later
"""Paper models: flat surfaces whose only curvature sits in the cones and corners of an orbifold, in its angles.

The conformal map onto that orbifold is an isometry, so that nothing is stretched: any prediction must give a spread of
zero, to rounding, and the best cones are those corners. A convex polygon is doubled and its two sheets are glued along
all its sides (a pillow), along some (a disk), or not doubled at all (a disk between mirrors)."""

from dataclasses import dataclass

import numpy as np
from meshes import subdivided, tetrahedron
from picks import boundary_loops


@dataclass(frozen=True)
class Model:
    signature: str
    vertices: np.ndarray  # (n, 3)
    triangles: np.ndarray  # (m, 3)
    cones: list  # in the signature's sequence


def right_triangle(degrees):
    """(0, 0), (1, 0) with the right angle, and the third corner; `degrees` is the angle at the first."""
    return [(0, 0), (1, 0), (1, np.tan(np.radians(degrees)))]


EQUILATERAL = [(0, 0), (1, 0), (0.5, np.sqrt(0.75))]
RECTANGLE = [(0, 0), (1.3, 0), (1.3, 0.9), (0, 0.9)]

# signature: (polygon, sides along which its two sheets are glued, or None: one sheet; the polygon's corners that are
# cones and corners, in the signature's sequence); side i runs from corner i to corner i + 1
FOLDS = {
    "442": (right_triangle(45), (0, 1, 2), (0, 2, 1)),
    "333": (EQUILATERAL, (0, 1, 2), (0, 1, 2)),
    "632": (right_triangle(30), (0, 1, 2), (0, 2, 1)),
    "2222": (RECTANGLE, (0, 1, 2, 3), (0, 1, 2, 3)),
    "*442": (right_triangle(45), None, (0, 2, 1)),
    "*333": (EQUILATERAL, None, (0, 1, 2)),
    "*632": (right_triangle(30), None, (0, 2, 1)),
    "*2222": (RECTANGLE, None, (0, 1, 2, 3)),
    "4*2": (right_triangle(45), (0, 2), (0, 2)),
    "3*3": (right_triangle(60), (0, 2), (0, 2)),
    "2*22": (right_triangle(45), (0, 1), (1, 0, 2)),
    "22*": (RECTANGLE, (0, 1, 2), (1, 2)),
}


def sheet(polygon, fineness, seed):
    """A fan of triangles from the centroid, halved `fineness` times, its vertices moved within the polygon and its
    sides. The corners are the first vertices. Returns (n, 2) points, triangles."""
    corners = np.asarray(polygon, float)
    k = len(corners)
    points = np.vstack([corners, corners.mean(0)])
    triangles = np.array([(i, (i + 1) % k, k) for i in range(k)])
    for _ in range(fineness):
        points, triangles = subdivided(points, triangles)
    move = 0.2 * least_height(points, triangles)[:, None] * np.random.default_rng(seed).uniform(-1, 1, points.shape)
    (loop,) = boundary_loops(triangles)
    for i in range(k):
        along = corners[(i + 1) % k] - corners[i]
        along /= np.linalg.norm(along)
        normal = np.array([along[1], -along[0]])
        on_side = [v for v in loop if abs((points[v] - corners[i]) @ normal) < 1e-9]
        move[on_side] = np.outer(move[on_side] @ along, along)
    move[:k] = 0
    return points + move, triangles


def least_height(points, triangles):
    """(n,) the least height of the triangles around each vertex, points (n, 2)."""
    a, b, c = points[triangles].transpose(1, 0, 2)
    area = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    longest = np.linalg.norm([b - a, c - b, a - c], axis=2).max(0)
    least = np.full(len(points), np.inf)
    np.minimum.at(least, triangles.ravel(), np.repeat(area / longest, 3))
    return least


def doubled(vertices, triangles, kept_apart=()):
    """Two sheets glued along the boundary, but for the boundary vertices `kept_apart`. The first sheet keeps its
    numbers. Returns vertices, triangles, and each vertex's number on the second sheet."""
    glued = np.zeros(len(vertices), bool)
    glued[[v for loop in boundary_loops(triangles) for v in loop]] = True
    glued[list(kept_apart)] = False
    other = np.arange(len(vertices))
    other[~glued] = len(vertices) + np.arange(np.count_nonzero(~glued))
    return np.concatenate([vertices, vertices[~glued]]), np.concatenate([triangles, other[triangles[:, ::-1]]]), other


def model(signature, fineness=3, seed=1, turn=7):
    """A Model of one of FOLDS, turned in space; its vertices are numbered at random."""
    polygon, glued_sides, cones = FOLDS[signature]
    points, triangles = sheet(polygon, fineness, seed)
    vertices = np.column_stack([points, np.zeros(len(points))])
    if glued_sides is not None:
        k = len(polygon)
        (loop,) = boundary_loops(triangles)
        at = [loop.index(i) for i in range(k)]
        inner = []  # of the sides that stay open: all but corners that a glued side ends in
        for i in set(range(k)) - set(glued_sides):
            step = (at[(i + 1) % k] - at[i]) % len(loop)
            inner += [loop[(at[i] + j) % len(loop)] for j in range(1, step)]
            inner += [i] * (i in cones and (i - 1) % k not in glued_sides)
        vertices, triangles, _ = doubled(vertices, triangles, inner)
    return numbered_at_random(Model(signature, turned(vertices, turn), triangles, list(cones)), seed)


def tetrahedron_model(fineness=4, seed=1, stretch=(1.0, 1.2, 1.5)):
    """2222: four congruent acute triangles, half a turn in all at each corner."""
    vertices, triangles = tetrahedron()
    vertices = vertices * stretch
    barycentric = np.eye(4)
    for _ in range(fineness):
        barycentric, triangles = subdivided(barycentric, triangles)
    random = np.random.default_rng(seed)
    move = 0.15 * 0.5**fineness * random.uniform(-1, 1, barycentric.shape) * (barycentric > 0)
    move[np.count_nonzero(barycentric, axis=1) == 1] = 0
    for share in move:
        inside = np.flatnonzero(share)
        share[inside] -= share[inside].mean() if len(inside) else 0
    return numbered_at_random(Model("2222", turned((barycentric + move) @ vertices, 3), triangles, [0, 1, 2, 3]), seed)


def turned(vertices, seed):
    """Rotated and moved at random."""
    random = np.random.default_rng(seed)
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    return vertices @ (turn * np.sign(np.linalg.det(turn))) + random.normal(size=3)


def renumbered(vertices, triangles, seed):
    """The same mesh with its vertices and triangles in another sequence, and each vertex's new number."""
    random = np.random.default_rng(seed)
    new = random.permutation(len(vertices))
    moved = np.empty_like(vertices)
    moved[new] = vertices
    return moved, new[triangles][random.permutation(len(triangles))], new


def numbered_at_random(made, seed):
    vertices, triangles, new = renumbered(made.vertices, made.triangles, seed)
    return Model(made.signature, vertices, triangles, new[made.cones].tolist())
