# SPDX-License-Identifier: GPL-3.0-or-later
"""The charts of native/src/layout.c as functions of any point, and back.

The library lays out the triangles that it was given. For triangles that faces.py moves and for the pixels of an image
the same chart is needed elsewhere: its few constants are fitted to the corners that the library has laid out, which is
exact, since five of the seven charts are affine in a complex coordinate.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

CURVATURE = {"spherical": 1, "euclidean": 0, "hyperbolic": -1}
POLE = 1e-9  # latitudes this near to a pole's, in uv, are the pole
SAMPLE = 5000  # triangles that the constants are fitted to
DISCONTINUOUS = ("equirectangular", "octahedral")


@dataclass(frozen=True)
class Chart:
    to_uv: Callable[[np.ndarray], np.ndarray]  # (k, 3, 3) corners of triangles -> (k, 3, 2)
    to_point: Callable[[np.ndarray], np.ndarray]  # (k, 2) -> (k, 3); NaN where the chart has no point


def chart_of(name: str, geometry: str, points: np.ndarray, uv: np.ndarray) -> Chart:
    """The chart by which the corners `points` (m, 3, 3) got the coordinates `uv` (m, 3, 2)."""
    step = max(1, len(points) // SAMPLE)
    points, uv = points[::step].reshape(-1, 3), uv[::step].reshape(-1, 2)
    if name == "octahedral":
        return Chart(_to_octahedral, _from_octahedral)
    if name == "equirectangular":
        axes = _axes(points, uv)
        return Chart(lambda corners: _to_equirectangular(corners, axes), lambda uv: _from_equirectangular(uv, axes))
    return _affine_chart(name == "klein", CURVATURE[geometry], points, uv)


def joined(name: str, uv: np.ndarray, points: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """`uv` (m, 3, 2) of the corners `points` (m, 3, 3) with each face (m,) on one side of a discontinuity of the chart,
    that of its first corner; it may then leave the unit square. Faces about one of the octahedron's corners, where a
    fold ends, stay as they are if this would flip them."""
    _, first, face = np.unique(faces, return_index=True, return_inverse=True)
    face = face.ravel()
    home, given, uv = first[face], uv, uv.copy()
    if name == "equirectangular":
        uv[..., 0] -= np.round(uv[..., 0] - uv[home, :1, 0])
    elif name == "octahedral":
        start = np.broadcast_to(points[home, :1], points.shape)
        low = (start[..., 2] < 0) | (points[..., 2] < 0)
        uv[low] = _unfolded(start[low], points[low], uv[low])
        flipped = np.bincount(face, (areas(uv) <= 0) & (areas(given) > 0)) > 0
        uv[flipped[face]] = given[flipped[face]]
    return uv


def areas(uv: np.ndarray) -> np.ndarray:
    """(m,) twice the areas of triangles in the plane, negative where they are flipped."""
    a, b = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def without_poles(name: str, uv: np.ndarray) -> np.ndarray:
    """`uv` (..., 2) for comparing: a pole has every longitude, so it is given one."""
    if name != "equirectangular":
        return uv
    pole = np.abs(uv[..., 1] - 0.5) > 0.5 - POLE
    return np.stack([np.where(pole, 0.5, uv[..., 0]), uv[..., 1]], -1)


# ------------------------------------------------------------------------------------------ the complex chart


def to_complex(points: np.ndarray, curvature: int) -> np.ndarray:
    """(..., 3) points -> (...) z, stereographic, half the plane's coordinate, Poincaré (native/src/geometry.h)."""
    flat = points[..., 0] + 1j * points[..., 1]
    return flat / 2 if curvature == 0 else flat / (1 + points[..., 2])


def to_points(z: np.ndarray, curvature: int) -> np.ndarray:
    """(...) z -> (..., 3) points; NaN outside the hyperbolic disk."""
    square = np.abs(z) ** 2
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = np.where(1 + curvature * square > 0, 1 / (1 + curvature * square), np.nan)
    return np.stack([2 * z.real * scale, 2 * z.imag * scale, (1 - curvature * square) * scale], -1)


def _affine_chart(klein: bool, curvature: int, points: np.ndarray, uv: np.ndarray) -> Chart:
    def plane(points: np.ndarray) -> np.ndarray:
        z = to_complex(points, curvature)
        w = 2 * z / (1 + np.abs(z) ** 2) if klein else z
        return np.stack([w.real, w.imag, np.ones_like(w.real)], -1)

    affine, *_ = np.linalg.lstsq(plane(points), uv, rcond=None)
    inverse = np.linalg.inv(affine[:2])

    def to_point(uv: np.ndarray) -> np.ndarray:
        w = (uv - affine[2]) @ inverse @ np.array([1, 1j])
        with np.errstate(invalid="ignore"):
            return to_points(w / (1 + np.sqrt(1 - np.abs(w) ** 2)) if klein else w, curvature)

    return Chart(lambda corners: plane(corners) @ affine, to_point)


# ------------------------------------------------------------------------------------------------ the sphere


def _to_octahedral(points: np.ndarray) -> np.ndarray:
    a, b, n = np.moveaxis(points / np.abs(points).sum(-1, keepdims=True), -1, 0)
    u = np.where(n >= 0, a, np.copysign(1 - np.abs(b), a))
    v = np.where(n >= 0, b, np.copysign(1 - np.abs(a), b))
    return np.stack([(u + 1) / 2, (v + 1) / 2], -1)


def _from_octahedral(uv: np.ndarray) -> np.ndarray:
    a, b = 2 * uv.T - 1
    n = 1 - np.abs(a) - np.abs(b)
    x = np.where(n >= 0, a, np.copysign(1 - np.abs(b), a))
    y = np.where(n >= 0, b, np.copysign(1 - np.abs(a), b))
    points = np.stack([x, y, n], -1)
    return points / np.linalg.norm(points, axis=-1, keepdims=True)


def _unfolded(start: np.ndarray, end: np.ndarray, uv: np.ndarray) -> np.ndarray:
    """`uv` (k, 2) of the points `end` (k, 3), continued across the folds between `start` (k, 3) and them. The folds are
    the lower halves of the circles x = 0 and y = 0, the sides of the square; a half turn about the middle of a side
    takes one bank of its fold to the other."""
    crosses = np.signbit(start[:, :2]) != np.signbit(end[:, :2])
    with np.errstate(divide="ignore", invalid="ignore"):
        part = np.where(crosses, np.nan_to_num(start[:, :2] / (start[:, :2] - end[:, :2]), nan=0.5), 0.0)
    there = start[:, None] + part[..., None] * (end - start)[:, None]  # (k, 2, 3) where x = 0 and where y = 0
    folded = crosses & (there[..., 2] < 0)
    twice_middle = np.ones((len(uv), 2, 2))
    twice_middle[:, 0, 1] = 2 * (there[:, 0, 1] > 0)
    twice_middle[:, 1, 0] = 2 * (there[:, 1, 0] > 0)
    every = np.arange(len(uv))
    for axis in np.argsort(-part, axis=1).T:  # the last crossing first
        uv = np.where(folded[every, axis][:, None], twice_middle[every, axis] - uv, uv)
    return uv


def _axes(points: np.ndarray, uv: np.ndarray) -> np.ndarray:
    """(3, 3) rows east, north, front of the equirectangular chart. The sine of the latitude is linear in the point,
    which gives the axis; longitude 0 is the tile's middle."""
    north, *_ = np.linalg.lstsq(points, np.sin(np.pi * (uv[:, 1] - 0.5)), rcond=None)
    north /= np.linalg.norm(north)
    front = np.array([0.0, 0.0, 1.0])
    return np.stack([np.cross(north, front), north, front])


def _to_equirectangular(corners: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """The corners of a triangle are brought to the side of the date line that its first one lies on; a corner at a
    pole has no longitude and goes midway between the others."""
    x, y, front = np.moveaxis(corners @ axes.T, -1, 0)
    u = np.arctan2(x, front) / (2 * np.pi) + 0.5
    pole = np.hypot(x, front) < 1e-12
    for row in range(len(u)):
        others = np.flatnonzero(~pole[row])
        u[row] -= np.round(u[row] - u[row, others[0]])
        u[row, pole[row]] = u[row, others].mean()
    return np.stack([u, np.arctan2(y, np.hypot(x, front)) / np.pi + 0.5], -1)


def _from_equirectangular(uv: np.ndarray, axes: np.ndarray) -> np.ndarray:
    longitude, latitude = 2 * np.pi * (uv[:, 0] - 0.5), np.pi * (uv[:, 1] - 0.5)
    ring = np.cos(latitude)
    return np.stack([ring * np.sin(longitude), np.sin(latitude), ring * np.cos(longitude)], -1) @ axes
