# SPDX-License-Identifier: GPL-3.0-or-later
"""Arguments as the native library takes them: contiguous arrays of our own, and names from a list."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

from . import binding
from .errors import OrbifoldError

INT32 = np.iinfo(np.int32)


def rows_of_three(values: ArrayLike, what: str) -> np.ndarray:
    """A contiguous (., 3) float64 array of our own."""
    try:
        array = np.array(values, dtype=np.float64, order="C")
    except (TypeError, ValueError) as reason:
        raise OrbifoldError("ORB_BAD_ARGUMENT", f"the {what} are not an array of numbers: {reason}") from reason
    if array.ndim != 2 or array.shape[1] != 3:
        raise OrbifoldError("ORB_BAD_ARGUMENT", f"the {what} have the shape {array.shape}; give three numbers a row")
    return array


def mesh_of(vertices: ArrayLike, triangles: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """(n, 3) coordinates and (m, 3) vertices of triangles."""
    return rows_of_three(vertices, "vertices"), integers(
        triangles, (-1, 3), "triangles", "ORB_INDEX_OUT_OF_RANGE", "triangle"
    )


def picks_of(cones: ArrayLike, orders: ArrayLike | None) -> tuple[np.ndarray, np.ndarray | None]:
    """(k,) vertices and, where they are given, the order of each."""
    picked = integers(cones, (-1,), "cones", "ORB_BAD_CONE", "vertex")
    if orders is None:
        return picked, None
    orders = integers(orders, (-1,), "orders", "ORB_BAD_ORDER", None)
    if len(orders) != len(picked):
        raise OrbifoldError(
            "ORB_BAD_ORDER", f"{len(orders)} orders are given for {len(picked)} cones; give one for each cone"
        )
    return picked, orders


def integers(values: ArrayLike, shape: tuple[int, ...], what: str, status: str, element: str | None) -> np.ndarray:
    """A contiguous int32 array of our own, of shape (-1,) or (-1, 3). Integers that C cannot hold: `status`."""
    try:
        array = np.asarray(values)
    except ValueError as reason:  # rows of different lengths
        raise OrbifoldError("ORB_BAD_ARGUMENT", f"the {what} are not an array of integers: {reason}") from reason
    if array.size == 0:
        return np.zeros((0, *shape[1:]), np.int32)
    if array.dtype.kind not in "iu":
        raise OrbifoldError("ORB_BAD_ARGUMENT", f"the {what} are of the type {array.dtype}; give integers")
    if array.ndim != len(shape) or array.shape[1:] != shape[1:]:
        wanted = "three integers a row" if len(shape) == 2 else "a plain sequence"
        raise OrbifoldError("ORB_BAD_ARGUMENT", f"the {what} have the shape {array.shape}; give {wanted}")
    beyond = (array < INT32.min) | (array > INT32.max)
    if beyond.any():
        rows = np.flatnonzero(beyond.reshape(len(array), -1).any(1))
        shown = rows if element == "triangle" else array[rows]
        raise OrbifoldError(
            status,
            f"entry {rows[0]} of the {what} is beyond 32-bit integers; give indices that are there",
            [int(entry) for entry in shown[: binding.MAX_ELEMENTS]],
            element,
            len(rows),
        )
    return np.array(array, dtype=np.int32, order="C")


def holes_of(name: str) -> int:
    """The C enum's entry."""
    if not isinstance(name, str) or name not in binding.HOLES:
        raise unknown("way to treat holes", name, binding.HOLES)
    return binding.HOLES[name]


def unknown(what: str, name: object, there: Iterable[str]) -> OrbifoldError:
    return OrbifoldError("ORB_BAD_ARGUMENT", f"there is no {what} '{name}'; use {', '.join(there)}")
