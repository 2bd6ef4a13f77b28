# SPDX-License-Identifier: GPL-3.0-or-later
"""Embeds a mesh in an orbifold, or fixes its boundary to a polygon. `embed` waits for the result, `start_embedding`
gives a job to poll.

    result = embed(vertices, triangles, "442", [100, 1000, 2000])
    result.uv                # (m, 3, 2), per triangle corner
    result.save("mesh.npz")
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from . import binding
from .arrays import holes_of, mesh_of, picks_of, rows_of_three, unknown
from .errors import OrbifoldError
from .jobs import Job, Progress, wait_for
from .polygon import Polygon, polygon_arrays
from .prepare import PreparedMesh
from .result import Result, chart_number, result_of
from .signatures import geometry_of

FIXED_CHARTS = {"euclidean": "conformal"}  # a polygon in the plane has no lattice


class EmbeddingJob(Job[Result]):
    """`start_embedding` makes it; `finish` gives the certified embedding."""

    def __init__(self, job: binding.EmbeddingJob, n_vertices: int, chart: str | None) -> None:
        super().__init__(job, lambda embedding: result_of(embedding, n_vertices, chart))


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
    prepared: PreparedMesh | None = None,
    cut: str = "automatic",
) -> EmbeddingJob:
    """Starts what `embed` does and returns at once. Arguments are those of `embed`; arrays may change afterwards."""
    points, faces = mesh_of(vertices, triangles) if prepared is None else (None, None)
    picked, orders = picks_of(cones, orders)
    if (signature is None) == (polygon is None):
        raise OrbifoldError("ORB_BAD_ARGUMENT", "give a signature such as '442', or else a polygon, and not both")
    if polygon is not None and not isinstance(polygon, Polygon):
        raise OrbifoldError("ORB_BAD_ARGUMENT", "the polygon is no core.Polygon; give one such as Polygon(n=5)")
    treated = holes_of(holes)
    if cut not in binding.CUTS:
        raise unknown("way to cut", cut, binding.CUTS)
    route = binding.CUTS[cut]
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
    request = binding.request_of(
        *(signature, picked, orders, treated, native_polygon, edge_weights), weights=kind, clamp=clamp, cut=route
    )
    if prepared is None:
        return EmbeddingJob(binding.EmbeddingJob(binding.mesh_arrays(points, faces), request), len(points), chart)
    request.prepared = prepared.native.pointer
    return EmbeddingJob(binding.EmbeddingJob(None, request), prepared.n_vertices, chart)


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
    prepared: PreparedMesh | None = None,
    cut: str = "automatic",
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
    prepared   what `prepare` made of these vertices and triangles, which then are not read again
    cut        "path": surfaces without handles and cross-caps are cut through their cones in turn and from mirror to
               mirror, however long that is, as surface maps need it; "automatic": a graph where that may be better

    Raises OrbifoldError. A cancelled computation raises ORB_CANCELLED, or what `progress` raised, at once.
    """
    settings = (weights, clamp, chart, holes, polygon, prepared, cut)
    job = start_embedding(vertices, triangles, signature, cones, orders, *settings)
    return wait_for(job, progress)


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
        raise unknown("chart", chart, binding.CHARTS)


def _weights(weights: str | ArrayLike) -> tuple[int, np.ndarray | None]:
    """The C enum's entry, and the rows i, j, w_ij where they are given."""
    if not isinstance(weights, str):
        return binding.WEIGHTS_GIVEN, rows_of_three(weights, "weights")
    if weights not in binding.WEIGHTS:
        there = ", ".join(f"'{name}'" for name in binding.WEIGHTS)
        raise OrbifoldError(
            "ORB_BAD_ARGUMENT", f"there are no weights '{weights}'; use {there} or an array of rows i, j, w"
        )
    return binding.WEIGHTS[weights], None
