# SPDX-License-Identifier: GPL-3.0-or-later
"""A fixed boundary: the polygon that the border of a disk goes to, in place of an orbifold."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .errors import OrbifoldError

CURVATURE = {"spherical": 1, "euclidean": 0, "hyperbolic": -1}


@dataclass(frozen=True)
class Polygon:
    """A convex polygon of a geometry: regular with `n` corners, or with the corners that are given.

    geometry  "euclidean", "spherical" or "hyperbolic"
    corners   (k, 3) points of the geometry's model, counter-clockwise; in the plane (k, 2) will do; None: regular
    n         corners of the regular one; 0: as many as vertices are picked for them, or 4
    radius    from its centre to a corner, in the geometry; 0: as large as suits it
    """

    geometry: str = "euclidean"
    corners: ArrayLike | None = None
    n: int = 0
    radius: float = 0.0


def polygon_arrays(polygon: Polygon, n_picked: int) -> tuple[int, int, np.ndarray | None, float]:
    """Curvature, number of corners, the corners (k, 3) or None, and radius, as the library takes them."""
    if polygon.geometry not in CURVATURE:
        raise _refused(f"there is no geometry '{polygon.geometry}'; use {', '.join(CURVATURE)}")
    try:
        radius, n = float(polygon.radius), int(polygon.n)
    except (TypeError, ValueError) as reason:
        raise _refused("the polygon's radius or number of corners is no number; give 0 for the usual one") from reason
    if polygon.corners is None:
        return CURVATURE[polygon.geometry], n or n_picked or 4, None, radius
    corners = _corners(polygon)
    if n not in (0, len(corners)):
        raise _refused(f"the polygon has {len(corners)} corners and n is {n}; leave n out")
    return CURVATURE[polygon.geometry], len(corners), corners, radius


def _corners(polygon: Polygon) -> np.ndarray:
    try:
        corners = np.array(polygon.corners, dtype=np.float64, order="C")
    except (TypeError, ValueError) as reason:
        raise _refused(f"the polygon's corners are not an array of numbers: {reason}") from reason
    if polygon.geometry == "euclidean" and corners.ndim == 2 and corners.shape[1] == 2:
        corners = np.column_stack([corners, np.ones(len(corners))])
    if corners.ndim != 2 or corners.shape[1] != 3:
        raise _refused(f"the polygon's corners have the shape {corners.shape}; give three numbers a corner")
    return np.ascontiguousarray(corners)


def _refused(message: str) -> OrbifoldError:
    return OrbifoldError("ORB_BAD_ARGUMENT", message)
