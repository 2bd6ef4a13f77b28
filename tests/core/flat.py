# SPDX-License-Identifier: GPL-3.0-or-later
"""Flat surfaces whose harmonic map onto their own orbifold is known: the identity, up to a similarity.

Rows of equilateral triangles, glued to a torus, a Klein bottle, an annulus, a Moebius band, or not at all. Vertices
may be moved at random as long as every cotangent weight of the flat metric is positive. Flat closed surfaces do not fit
into space, but folded up they do: all triangles onto one, which is an isometry of each."""

from dataclasses import dataclass

import numpy as np

HEIGHT = np.sqrt(3) / 2  # of a row, the triangles' sides being 1


@dataclass(frozen=True)
class Flat:
    vertices: np.ndarray  # (n, 3) where the triangles are as in the plane, if `roughness` is 0 or nothing is glued
    triangles: np.ndarray  # (m, 3)
    corners: np.ndarray  # (m, 3, 2) the triangles as they are in the plane
    weights: np.ndarray  # (E, 3) rows i, j, w
    cones: list  # the corners of the rectangle


def weights_of(triangles, corners):
    """Rows i, j, w: the cotangents of triangles given by their corners (m, 3, d), half the sum on either side."""
    u, v = np.roll(corners, -1, 1) - corners, np.roll(corners, -2, 1) - corners
    dot = (u * v).sum(2)
    cotangent = dot / np.sqrt((u * u).sum(2) * (v * v).sum(2) - dot**2)
    ends = np.sort(np.stack([np.roll(triangles, -1, 1), np.roll(triangles, -2, 1)], 2).reshape(-1, 2), 1)
    edges, of = np.unique(ends, axis=0, return_inverse=True)
    return np.column_stack([edges, np.bincount(of.ravel(), cotangent.ravel() / 2)])


def strip(lower, upper):
    """Triangles between two rows of points (number, x), always by the shorter diagonal."""
    i = j = 0
    while i + 1 < len(lower) or j + 1 < len(upper):
        to_lower = abs(lower[i + 1][1] - upper[j][1]) if i + 1 < len(lower) else np.inf
        to_upper = abs(upper[j + 1][1] - lower[i][1]) if j + 1 < len(upper) else np.inf
        onward = upper[j + 1][0] if to_upper < to_lower else lower[i + 1][0]
        yield lower[i][0], onward, upper[j][0]
        i, j = i + (to_upper >= to_lower), j + (to_upper < to_lower)


def flat_surface(signature, nx=9, ny=8, shift=0, roughness=0.08, seed=3):
    """signature: "o", "xx", "**", "*x" or "*2222". ny is even. The torus's second translation goes `shift` to the
    side. Without roughness nx and shift are multiples of 3, as many as the corners of the one triangle."""
    random = np.random.default_rng(seed)
    rows, points, place = [], [], []  # the unglued rectangle: numbers, (x, y), (i, j)
    for j in range(ny + 1):
        xs = np.arange(nx + 1) + 0.5 * (j % 2)
        if signature == "*2222" and j % 2:
            xs = np.concatenate([[0], xs[:-1], [nx]])
        rows.append(list(zip(range(len(points), len(points) + len(xs)), xs)))
        points += [(x, j * HEIGHT) for x in xs]
        place += [(i, j) for i in range(len(xs))]
    unglued = np.array([t for lower, upper in zip(rows, rows[1:]) for t in strip(lower, upper)])
    points = np.array(points)
    number = {at: n for n, at in enumerate(place)}
    stands_for = np.array([number[_glued(signature, i, j, nx, ny, shift)] for i, j in place])
    move = roughness * random.uniform(-1, 1, points.shape)
    if signature in ("**", "*x", "*2222"):
        move[(points[:, 1] == 0) | (points[:, 1] == ny * HEIGHT), 1] = 0
    if signature == "*2222":
        move[(points[:, 0] == 0) | (points[:, 0] == nx), 0] = 0
    mirrored = np.array([signature in ("xx", "*x") and i == nx for i, _ in place])
    move = np.where(mirrored[:, None], [1, -1], 1) * move[stands_for]
    if signature == "*2222":
        move[[rows[0][0][0], rows[0][-1][0], rows[-1][0][0], rows[-1][-1][0]]] = 0
    corners = (points + move)[unglued]
    kept, number_of = np.unique(stands_for, return_inverse=True)
    triangles = number_of.ravel()[unglued]
    rectangle = [rows[0][0][0], rows[0][-1][0], rows[-1][-1][0], rows[-1][0][0]] if signature == "*2222" else []
    weights = weights_of(triangles, corners)
    assert (weights[:, 2] > 0.01).all()
    if signature == "*2222":
        vertices = np.column_stack([points + move, np.zeros(len(points))])
    else:
        vertices = _on_a_torus(points[kept], nx, ny) if roughness else _folded(points[kept])
    return Flat(vertices, triangles, corners, weights, number_of[rectangle].tolist())


def _glued(signature, i, j, nx, ny, shift):
    if signature == "*2222":
        return i, j
    if signature in ("xx", "o") and j == ny:
        i, j = (i + shift, 0) if signature == "o" else (i, 0)
    if i >= nx:
        i, j = i - nx, (-j % ny if signature == "xx" else ny - j if signature == "*x" else j)
    return i, j


def _folded(points):
    """The three corners of a triangle, in turn, for the vertices of the triangular lattice."""
    up = np.round(points[:, 1] / HEIGHT)
    return np.eye(3)[np.round(points[:, 0] - 1.5 * up).astype(int) % 3] / np.sqrt(2)


def _on_a_torus(points, nx, ny):
    u, v = 2 * np.pi * points[:, 0] / nx, 1.9 * np.pi * points[:, 1] / (ny * HEIGHT)
    r = 2 + np.cos(v)
    return np.stack([r * np.cos(0.95 * u), r * np.sin(0.95 * u), np.sin(v)], 1)


def subdivided_triangle(corners, n):
    """(points, triangles, barycentric (., 3)) of a triangle cut into n^2; the corners are vertices 0, 1, 2."""
    weights = [(n, 0, 0), (0, n, 0), (0, 0, n)]
    weights += [(i, j, n - i - j) for i in range(n + 1) for j in range(n + 1 - i) if n not in (i, j, n - i - j)]
    number = {w: k for k, w in enumerate(weights)}
    triangles = []
    for i in range(n):
        for j in range(n - i):
            k = n - 1 - i - j
            triangles.append([number[i + 1, j, k], number[i, j + 1, k], number[i, j, k + 1]])
            if k:
                triangles.append([number[i, j + 1, k], number[i + 1, j, k], number[i + 1, j + 1, k - 1]])
    triangles = np.array(triangles)
    barycentric = np.array(weights) / n
    turned = np.linalg.det(barycentric[triangles]) < 0
    triangles[turned] = triangles[turned][:, ::-1]
    return barycentric @ np.asarray(corners, float), triangles
