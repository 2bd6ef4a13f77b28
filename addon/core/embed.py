# SPDX-License-Identifier: GPL-3.0-or-later
"""Embeds a mesh in an orbifold, or fixes its boundary to a polygon. `embed` waits for the result, `start_embedding`
gives a job to poll.

    result = embed(vertices, triangles, "442", [100, 1000, 2000])
    result.uv                # (m, 3, 2), per triangle corner
    result.save("mesh.npz")
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Iterable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from . import binding
from .errors import OrbifoldError
from .polygon import Polygon, polygon_arrays
from .result import Result, chart_number, result_of
from .signatures import geometry_of

INT32 = np.iinfo(np.int32)
FIXED_CHARTS = {"euclidean": "conformal"}  # a polygon in the plane has no lattice

Progress = Callable[[str, float], object]


class EmbeddingJob:
    """A computation on the library's own thread; `start_embedding` makes it. Drop it at any time: it is cancelled."""

    def __init__(self, job: binding.Job, n_vertices: int, chart: str | None) -> None:
        self._job, self._n_vertices, self._chart = job, n_vertices, chart

    def poll(self) -> tuple[str, float, bool]:
        """(stage, fraction in [0, 1], whether it is over); returns at once."""
        return self._job.poll()

    def cancel(self) -> None:
        """`finish` then raises ORB_CANCELLED at once, at any size of mesh."""
        self._job.cancel()

    def finish(self) -> Result:
        """Waits for the end, once only: the result, or OrbifoldError."""
        return result_of(self._job.finish(), self._n_vertices, self._chart)


def start_embedding(
    vertices: ArrayLike,
    triangles: ArrayLike,
    signature: str | None = None,
    cones: Sequence[int] | np.ndarray = (),
    orders: Sequence[int] | np.ndarray | None = None,
    weights: str | ArrayLike = "cotan",
    clamp: float = 0.01,
    chart: str | None = None,
    holes: str = "refuse",
    polygon: Polygon | None = None,
) -> EmbeddingJob:
    """Starts what `embed` does and returns at once. Arguments are those of `embed`; arrays may change afterwards."""
    points = _rows_of_three(vertices, "vertices")
    faces = _integers(triangles, (-1, 3), "triangles", "ORB_INDEX_OUT_OF_RANGE", "triangle")
    picked = _integers(cones, (-1,), "cones", "ORB_BAD_CONE", "vertex")
    if orders is not None:
        orders = _integers(orders, (-1,), "orders", "ORB_BAD_ORDER", None)
        if len(orders) != len(picked):
            raise OrbifoldError(
                "ORB_BAD_ORDER", f"{len(orders)} orders are given for {len(picked)} cones; give one for each cone"
            )
    if (signature is None) == (polygon is None):
        raise OrbifoldError("ORB_BAD_ARGUMENT", "give a signature such as '442', or else a polygon, and not both")
    if polygon is not None and not isinstance(polygon, Polygon):
        raise OrbifoldError("ORB_BAD_ARGUMENT", "the polygon is no core.Polygon; give one such as Polygon(n=5)")
    if not isinstance(holes, str) or holes not in binding.HOLES:
        raise _unknown("way to treat holes", holes, binding.HOLES)
    kind, edge_weights = _weights(weights)
    try:
        clamp = float(clamp)
    except (TypeError, ValueError) as reason:
        raise OrbifoldError("ORB_BAD_ARGUMENT", "the clamp is not a number; give a positive one") from reason
    native_polygon, corners = None, None
    if polygon is not None:
        curvature, n_corners, corners, radius = polygon_arrays(polygon, len(picked))
        native_polygon = binding.Polygon(curvature, n_corners, binding.doubles(corners), radius)
        chart = chart or FIXED_CHARTS.get(polygon.geometry)
    _check_chart(chart, signature, polygon, holes)
    job = binding.Job(
        *(points, faces, signature, picked, orders, binding.HOLES[holes], native_polygon, kind, clamp, edge_weights)
    )
    return EmbeddingJob(job, len(points), chart)


def embed(
    vertices: ArrayLike,
    triangles: ArrayLike,
    signature: str | None = None,
    cones: Sequence[int] | np.ndarray = (),
    orders: Sequence[int] | np.ndarray | None = None,
    weights: str | ArrayLike = "cotan",
    clamp: float = 0.01,
    progress: Progress | None = None,
    chart: str | None = None,
    holes: str = "refuse",
    polygon: Polygon | None = None,
) -> Result:
    """The certified embedding of a mesh in one piece in an orbifold whose surface it is.

    vertices   (n, 3) coordinates; vertices that no triangle uses are tolerated
    triangles  (m, 3) integers, consistently oriented where the surface is orientable
    signature  Conway's notation: "442", "22(12)", "*632", "4*2", "**", "22x", "oo"
    cones      a vertex for each cone, then one on the boundary for each mirror corner, in the signature's sequence
               unless `orders` says otherwise; corners may start anywhere and run either way round their mirror
    orders     the order of each of them, a permutation of the signature's
    weights    "cotan", "mean-value", "uniform", "conformal", "delaunay", "mean-value-exact" (plane only), or an
               (E, 3) array of i, j, w_ij > 0, a row for each edge
    clamp      least cotangent weight
    progress   called as progress(stage, fraction) every few milliseconds; returning False, or raising, cancels
    chart      of `Result.uv`, one of `CHARTS[geometry]`; the default is the geometry's first
    holes      what to do with boundary loops beyond the signature's mirrors: "refuse", "fill" them for the
               computation, or "mirror": add a * to the signature for each
    polygon    instead of a signature: the boundary of a disk is fixed to it; `cones` are then the vertices that go
               to its corners in turn (none: spread evenly)

    Raises OrbifoldError. A cancelled computation raises ORB_CANCELLED, or what `progress` raised, at once.
    """
    job = start_embedding(vertices, triangles, signature, cones, orders, weights, clamp, chart, holes, polygon)
    pause = 0.001
    try:
        over = False
        while not over:
            stage, fraction, over = job.poll()
            if progress is not None and progress(stage, fraction) is False:
                job.cancel()
                break
            if not over:
                time.sleep(pause)
                pause = min(2 * pause, 0.02)
    except BaseException:  # also an interrupt from the keyboard
        job.cancel()
        with contextlib.suppress(OrbifoldError):
            job.finish()
        raise
    return job.finish()


def _check_chart(chart: str | None, signature: str | None, polygon: Polygon | None, holes: str) -> None:
    """An unknown chart is known before a long computation, not after it. Mirrors that are added for holes change the
    geometry: there only the name can be looked at."""
    if chart is None:
        return
    if polygon is not None:
        chart_number(chart, polygon.geometry)
    elif holes != "mirror":
        chart_number(chart, geometry_of(signature))
    elif chart not in binding.CHARTS:
        raise _unknown("chart", chart, binding.CHARTS)


def _unknown(what: str, name: object, there: Iterable[str]) -> OrbifoldError:
    return OrbifoldError("ORB_BAD_ARGUMENT", f"there is no {what} '{name}'; use {', '.join(there)}")


def _rows_of_three(values: ArrayLike, what: str) -> np.ndarray:
    """A contiguous (., 3) float64 array of our own."""
    try:
        array = np.array(values, dtype=np.float64, order="C")
    except (TypeError, ValueError) as reason:
        raise OrbifoldError("ORB_BAD_ARGUMENT", f"the {what} are not an array of numbers: {reason}") from reason
    if array.ndim != 2 or array.shape[1] != 3:
        raise OrbifoldError("ORB_BAD_ARGUMENT", f"the {what} have the shape {array.shape}; give three numbers a row")
    return array


def _integers(values: ArrayLike, shape: tuple[int, ...], what: str, status: str, element: str | None) -> np.ndarray:
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


def _weights(weights: str | ArrayLike) -> tuple[int, np.ndarray | None]:
    """The C enum's entry, and the rows i, j, w_ij where they are given."""
    if not isinstance(weights, str):
        return binding.WEIGHTS_GIVEN, _rows_of_three(weights, "weights")
    if weights not in binding.WEIGHTS:
        there = ", ".join(f"'{name}'" for name in binding.WEIGHTS)
        raise OrbifoldError(
            "ORB_BAD_ARGUMENT", f"there are no weights '{weights}'; use {there} or an array of rows i, j, w"
        )
    return binding.WEIGHTS[weights], None
