# SPDX-License-Identifier: GPL-3.0-or-later
"""The tile of an embedding and its images under the orbifold's group, for the picture.

One code for the three geometries: a point is three numbers, <a, b> = ax bx + ay by + K az bz, an isometry is a 3 x 3
matrix (docs/mathematics.md, section 1), and rotations about the copies of the cones generate the group.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

CURVATURE = {"euclidean": 0, "spherical": 1, "hyperbolic": -1}


@dataclass(frozen=True)
class Tiling:
    curvature: int
    points: np.ndarray  # (copies, 3) the tile's vertices in the model
    triangles: np.ndarray  # (m, 3)
    cones: np.ndarray  # (k,) copies of cones among the points
    orders: np.ndarray  # (k,) their orders
    group: list[np.ndarray]  # 3 x 3 matrices; the first is the identity, the tile itself


def make_tiling(geometry: str, points: np.ndarray, triangles: np.ndarray, copy_to_vertex: np.ndarray,
                cones: np.ndarray, orders: np.ndarray, limit: int) -> Tiling:
    """At most `limit` images of the tile, nearest first (all of a finite group whose order is at most `limit`)."""
    curvature = CURVATURE[geometry]
    order_of = dict(zip((int(cone) for cone in cones), (int(order) for order in orders)))
    corners = np.flatnonzero(np.isin(copy_to_vertex, cones))
    corner_orders = np.array([order_of[int(copy_to_vertex[corner])] for corner in corners])
    turns = [rotation(curvature, points[corner], sign * 2 * np.pi / order)
             for corner, order in zip(corners, corner_orders) for sign in (1, -1)]
    middle = _onto_model(curvature, points[triangles].mean(axis=(0, 1)))
    group = _generate(curvature, turns, middle, points[triangles[0]].mean(axis=0), limit)
    return Tiling(curvature, points, triangles, corners, corner_orders, group)


def rotation(curvature: int, point: np.ndarray, angle: float) -> np.ndarray:
    """The rotation about `point` by `angle`."""
    c, s = np.cos(angle), np.sin(angle)
    x, y, z = point
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])
    if curvature == 0:
        shift = np.array([[1, 0, x], [0, 1, y], [0, 0, 1.0]])
        return shift @ turn @ np.array([[1, 0, -x], [0, 1, -y], [0, 0, 1.0]])
    if curvature == 1:
        cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        return c * np.eye(3) + s * cross + (1 - c) * np.outer(point, point)
    boost = np.array([[1 + x * x / (1 + z), x * y / (1 + z), x], [x * y / (1 + z), 1 + y * y / (1 + z), y], [x, y, z]])
    back = boost * np.array([[1, 1, -1], [1, 1, -1], [-1, -1, 1]])
    return boost @ turn @ back


def _onto_model(curvature: int, point: np.ndarray) -> np.ndarray:
    if curvature == 0:
        return point / point[2]
    return point / np.sqrt(abs(point[0] ** 2 + point[1] ** 2 + curvature * point[2] ** 2))


def _generate(curvature: int, turns: list[np.ndarray], middle: np.ndarray, marker: np.ndarray,
              limit: int) -> list[np.ndarray]:
    """Products of `turns`, the ones that move `middle` least first. `marker`: a second point, so that elements that
    agree at the middle are told apart."""
    probes = np.stack([middle, marker])
    known = [np.eye(3)]
    images = [probes]
    scale = max(float(np.abs(turn @ middle - middle).max()) for turn in turns)
    at = 0
    while at < len(known) and len(known) < 4 * limit:
        for turn in turns:  # g t = (g t g^-1) g: tile g turned about its own image of the corner
            element = known[at] @ turn
            image = probes @ element.T
            gaps = np.abs(np.array(images) - image).max(axis=(1, 2))
            if gaps.min() > 1e-6 * max(scale, float(np.abs(image).max())):
                known.append(element)
                images.append(image)
        at += 1
    moved = [float(np.linalg.norm(image[0] - probes[0])) for image in images]
    return [known[i] for i in np.argsort(moved, kind="stable")[:limit]]


def drawn(curvature: int, points: np.ndarray) -> np.ndarray:
    """(n, 3) places in space: the plane and the Poincaré disk at z = 0, the sphere as it is."""
    if curvature == 1:
        return points
    flat = points / (points[:, 2:] + (1.0 if curvature < 0 else 0.0))
    return np.column_stack([flat[:, :2], np.zeros(len(points))])
