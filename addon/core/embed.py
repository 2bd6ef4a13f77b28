# SPDX-License-Identifier: GPL-3.0-or-later
"""Embeds a closed mesh in an orbifold: `embed` waits for the result, `start_embedding` gives a job to poll.

    result = embed(vertices, triangles, "442", [100, 1000, 2000])
    result.uv                # (m, 3, 2), per triangle corner
    result.save("mesh.npz")
"""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from . import binding
from .errors import OrbifoldError
from .signatures import geometry_of

INT32 = np.iinfo(np.int32)

# The charts of each geometry; the first is its default.
CHARTS = {
    "euclidean": ("periodic", "conformal"),
    "spherical": ("stereographic", "equirectangular", "octahedral"),
    "hyperbolic": ("poincare", "klein"),
}

Progress = Callable[[str, float], object]


@dataclass(eq=False)
class Result:
    """A certified embedding (n vertices, m triangles, c copies of vertices, k cones, E edges). Arrays are its own."""

    vertices: np.ndarray  # (n, 3) float64, as given
    triangles: np.ndarray  # (m, 3) int32, as given
    cut_triangles: np.ndarray  # (m, 3) int32, the triangles in copies
    cut_to_vertex: np.ndarray  # (c,) int32; copy v < n is vertex v itself
    embedding: np.ndarray  # (c, 3) float64: (x, y, 1), unit sphere, or upper sheet of the hyperboloid
    embedding_low: np.ndarray  # (c, 3) float64: the point is the sum of the two
    geometry: str  # "euclidean", "spherical", "hyperbolic"
    signature: str
    cones: np.ndarray  # (k,) int32 vertices
    orders: np.ndarray  # (k,) int32
    weights: np.ndarray  # (E, 3) float64: i, j, w_ij as used
    seams: np.ndarray  # (s, 2) int32: edges across which the layout is not continuous
    chart: str  # of `uv`
    report: dict  # NAME.json
    native: binding.Embedding = field(repr=False)

    @cached_property
    def uv(self) -> np.ndarray:
        """(m, 3, 2) texture coordinates per triangle corner in the chart `self.chart`."""
        return self.uv_chart(self.chart)

    def uv_chart(self, chart: str) -> np.ndarray:
        """(m, 3, 2) texture coordinates in one of the charts of this geometry (`CHARTS`)."""
        return self.native.uv(_chart_number(chart, self.geometry), len(self.triangles))[0]

    def flipped_float32(self, chart: str) -> int:
        """Triangles that are not positively oriented once a chart's coordinates are rounded to float32."""
        return self.native.uv(_chart_number(chart, self.geometry), len(self.triangles))[1]

    def whole_sphere(self) -> np.ndarray:
        """(n, 3) one point of the unit sphere for each vertex: a spherical embedding divided by its group."""
        return self.native.whole_sphere(len(self.vertices))[0]

    def save(self, path: str | os.PathLike) -> None:
        """Writes NAME.npz; nothing is left at `path` when that fails."""
        arrays = {
            "vertices": self.vertices,
            "triangles": self.triangles,
            "cut_triangles": self.cut_triangles,
            "cut_to_vertex": self.cut_to_vertex,
            "embedding": self.embedding,
            "geometry": np.array(self.geometry),
            "signature": np.array(self.signature),
            "cones": self.cones,
            "orders": self.orders,
            "weights": self.weights,
        }
        if self.embedding_low.any():
            arrays["embedding_low"] = self.embedding_low
        part = Path(f"{os.fspath(path)}.part")
        try:
            with open(part, "wb") as file:
                np.savez(file, **arrays)
            os.replace(part, path)
        finally:
            part.unlink(missing_ok=True)


class EmbeddingJob:
    """A computation on the library's own thread; `start_embedding` makes it. Drop it at any time: it is cancelled."""

    def __init__(self, job: binding.Job, vertices: np.ndarray, triangles: np.ndarray, chart: str | None) -> None:
        self._job, self._vertices, self._triangles, self._chart = job, vertices, triangles, chart

    def poll(self) -> tuple[str, float, bool]:
        """(stage, fraction in [0, 1], whether it is over); returns at once."""
        return self._job.poll()

    def cancel(self) -> None:
        """`finish` then raises ORB_CANCELLED at once, at any size of mesh."""
        self._job.cancel()

    def finish(self) -> Result:
        """Waits for the end, once only: the result, or OrbifoldError."""
        native = self._job.finish()
        view, copied = native.view(), binding.copied
        geometry = view.geometry.decode()
        orders = copied(view.orders, view.n_cones)
        cones = copied(view.cones, view.n_cones)
        return Result(
            vertices=self._vertices,
            triangles=self._triangles,
            cut_triangles=copied(view.cut_triangles, view.n_triangles, 3),
            cut_to_vertex=copied(view.cut_to_vertex, view.n_copies),
            embedding=copied(view.embedding, view.n_copies, 3),
            embedding_low=copied(view.embedding_low, view.n_copies, 3),
            geometry=geometry,
            signature=view.signature.decode(),
            cones=cones,
            orders=orders,
            weights=copied(view.weights, view.n_edges, 3),
            seams=copied(view.seams, view.n_seams, 2),
            chart=self._chart or CHARTS[geometry][0],
            report=_report(native.report(), view.signature.decode(), geometry, cones, orders),
            native=native,
        )


def start_embedding(
    vertices: ArrayLike,
    triangles: ArrayLike,
    signature: str,
    cones: Sequence[int] | np.ndarray,
    orders: Sequence[int] | np.ndarray | None = None,
    weights: str | ArrayLike = "cotan",
    clamp: float = 0.01,
    chart: str | None = None,
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
    kind, edge_weights = _weights(weights)
    try:
        clamp = float(clamp)
    except (TypeError, ValueError) as reason:
        raise OrbifoldError("ORB_BAD_ARGUMENT", "the clamp is not a number; give a positive one") from reason
    if chart is not None:  # known before a long computation, not after it
        _chart_number(chart, geometry_of(signature))
    job = binding.Job(points, faces, signature, picked, orders, kind, clamp, edge_weights)
    return EmbeddingJob(job, points, faces, chart)


def embed(
    vertices: ArrayLike,
    triangles: ArrayLike,
    signature: str,
    cones: Sequence[int] | np.ndarray,
    orders: Sequence[int] | np.ndarray | None = None,
    weights: str | ArrayLike = "cotan",
    clamp: float = 0.01,
    progress: Progress | None = None,
    chart: str | None = None,
) -> Result:
    """The certified embedding of a closed, sphere-like, consistently oriented mesh in an orbifold.

    vertices   (n, 3) coordinates; vertices that no triangle uses are tolerated
    triangles  (m, 3) integers
    signature  Conway's notation: "442", "2222", "22(12)"
    cones      one vertex for each cone, in the signature's sequence unless `orders` says otherwise
    orders     the order of each cone, a permutation of the signature's
    weights    "cotan", "mean-value", "uniform", or an (E, 3) array of i, j, w_ij > 0, a row for each edge
    clamp      least cotangent weight
    progress   called as progress(stage, fraction) every few milliseconds; returning False, or raising, cancels
    chart      of `Result.uv`, one of `CHARTS[geometry]`; the default is the geometry's first

    Raises OrbifoldError. A cancelled computation raises ORB_CANCELLED, or what `progress` raised, at once.
    """
    job = start_embedding(vertices, triangles, signature, cones, orders, weights, clamp, chart)
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
            "ORB_BAD_ARGUMENT",
            f"there are no weights '{weights}' in this version; use {there} or an array of rows i, j, w",
        )
    return binding.WEIGHTS[weights], None


def _chart_number(chart: str, geometry: str) -> int:
    if chart == "default":
        chart = CHARTS[geometry][0]
    if chart not in CHARTS[geometry]:
        raise OrbifoldError(
            "ORB_BAD_ARGUMENT",
            f"there is no chart '{chart}' for {geometry} orbifolds; use {' or '.join(CHARTS[geometry])}",
        )
    return binding.CHARTS[chart]


def _report(native: binding.Report, signature: str, geometry: str, cones: np.ndarray, orders: np.ndarray) -> dict:
    """The dictionary of NAME.json. The library gives out certified embeddings only, hence "bijective"."""

    def fields(*names: str, prefix: str = "") -> dict:
        return {name: getattr(native, prefix + name) for name in names}

    return {
        "mesh": fields("vertices", "triangles", "components", "euler", "boundary_loops", "genus"),
        "orbifold": {
            "signature": signature,
            "geometry": geometry,
            "euler": native.orbifold_euler,
            "cones": [
                {"vertex": int(vertex), "order": int(order), "mirror": False}
                for vertex, order in zip(cones, orders)
            ],
        },
        "solver": fields("iterations", "energy", "relative_gradient", "clamped_weights", "factor_nonzeros"),
        "certificate": {
            **fields("flipped", "flipped_float32", "seam_residual", "angle_residual", "area_residual"),
            "bijective": True,
        },
        "distortion": fields(
            *("quasi_conformal_mean", "quasi_conformal_median", "quasi_conformal_max"),
            *("log_area_std", "symmetric_dirichlet"),
        ),
        "seconds": fields(
            *("topology", "cut", "tile", "initial", "assemble", "analyze", "factor", "solve", "certify", "total"),
            prefix="seconds_",
        ),
    }
