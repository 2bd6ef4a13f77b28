# SPDX-License-Identifier: GPL-3.0-or-later
"""What an embedding gives: arrays, texture coordinates, the file NAME.npz and the report."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np

from . import binding
from .errors import OrbifoldError

# The charts of each geometry; the first is its default.
CHARTS = {
    "euclidean": ("periodic", "conformal"),
    "spherical": ("stereographic", "equirectangular", "octahedral"),
    "hyperbolic": ("poincare", "klein"),
}


@dataclass(eq=False)
class Result:
    """A certified embedding. Arrays are its own.

    `uv` and `corner_copies` are for the m_in triangles that were given. All other arrays are for the mesh that the
    library worked on: n vertices, m triangles, c copies of vertices, k cones and corners, E edges. It is the mesh that
    was given (perhaps with some triangles turned over, where it is not orientable) unless `refined_from` is there:
    then edges were halved or holes filled for the computation; the given vertices come first.
    """

    vertices: np.ndarray  # (n, 3) float64
    triangles: np.ndarray  # (m, 3) int32, oriented alike within the layout
    refined_from: np.ndarray | None  # (m,) int32: the given triangle that each lies in, -1 in a filled hole
    input_corners: np.ndarray  # (m_in, 3) int32: where each corner given is in triangles.ravel()
    n_input_vertices: int
    cut_triangles: np.ndarray  # (m, 3) int32, the triangles in copies
    cut_to_vertex: np.ndarray  # (c,) int32; copy v < n is vertex v itself
    embedding: np.ndarray  # (c, 3) float64: (x, y, 1), unit sphere, or upper sheet of the hyperboloid
    embedding_low: np.ndarray  # (c, 3) float64: the point is the sum of the two
    geometry: str  # "euclidean", "spherical", "hyperbolic"
    signature: str  # empty where the boundary was fixed to a polygon
    cones: np.ndarray  # (k,) int32 vertices
    orders: np.ndarray  # (k,) int32
    mirrors: np.ndarray  # (k,) bool: whether it is a mirror corner
    generators: np.ndarray  # (., 3, 3) float64: isometries that generate the group, reflections included
    weights: np.ndarray | None  # (E, 3) float64: i, j, w_ij as used; None where they live on other edges
    seams: np.ndarray  # (s, 2) int32: edges across which the layout is not continuous
    filled_holes: int
    refined_edges: int
    chart: str  # of `uv`
    report: dict  # NAME.json
    native: binding.Embedding = field(repr=False)

    @cached_property
    def uv(self) -> np.ndarray:
        """(m_in, 3, 2) texture coordinates per given triangle corner in the chart `self.chart`."""
        return self.uv_chart(self.chart)

    @cached_property
    def corner_copies(self) -> np.ndarray:
        """(m_in, 3) the copy of a vertex that each given triangle corner is: the cut runs along given edges only."""
        return self.cut_triangles.ravel()[self.input_corners]

    def uv_chart(self, chart: str) -> np.ndarray:
        """(m_in, 3, 2) texture coordinates in one of the charts of this geometry (`CHARTS`)."""
        return self.tile_uv(chart).reshape(-1, 2)[self.input_corners]

    def tile_uv(self, chart: str) -> np.ndarray:
        """(m, 3, 2) the same for `triangles`."""
        return self.native.uv(chart_number(chart, self.geometry), len(self.triangles))[0]

    def flipped_float32(self, chart: str) -> int:
        """Of `triangles`, those that are not positively oriented once a chart's coordinates are rounded to float32."""
        return self.native.uv(chart_number(chart, self.geometry), len(self.triangles))[1]

    def whole_sphere(self) -> np.ndarray:
        """(n_input_vertices, 3) one point of the unit sphere for each vertex given: a spherical embedding divided by
        its group."""
        return self.native.whole_sphere(len(self.vertices))[0][: self.n_input_vertices]

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
        }
        if self.weights is not None and self.report["mesh"]["orientable"]:  # a reader walks round vertices one way
            arrays["weights"] = self.weights
        if self.embedding_low.any():
            arrays["embedding_low"] = self.embedding_low
        if self.refined_from is not None:
            arrays["refined_from"] = self.refined_from
        part = Path(f"{os.fspath(path)}.part")
        try:
            with open(part, "wb") as file:
                np.savez(file, **arrays)
            os.replace(part, path)
        finally:
            part.unlink(missing_ok=True)


def result_of(native: binding.Embedding, n_input_vertices: int, chart: str | None) -> Result:
    """Copies everything out of the library's embedding. `chart` None: the geometry's first."""
    view, report, copied = native.view(), native.report(), binding.copied
    geometry, signature = view.geometry.decode(), (view.signature or b"").decode()
    cones, orders = copied(view.cones, view.n_cones), copied(view.orders, view.n_cones)
    mirrors = copied(view.mirrors, view.n_cones)
    chart = chart or CHARTS[geometry][0]
    chart_number(chart, geometry)
    return Result(
        vertices=copied(view.vertices, view.n_vertices, 3),
        triangles=copied(view.triangles, view.n_triangles, 3),
        refined_from=copied(view.refined_from, view.n_triangles) if view.refined_from else None,
        input_corners=copied(view.input_corners, view.n_input_triangles, 3),
        n_input_vertices=n_input_vertices,
        cut_triangles=copied(view.cut_triangles, view.n_triangles, 3),
        cut_to_vertex=copied(view.cut_to_vertex, view.n_copies),
        embedding=copied(view.embedding, view.n_copies, 3),
        embedding_low=copied(view.embedding_low, view.n_copies, 3),
        geometry=geometry,
        signature=signature,
        cones=cones,
        orders=orders,
        mirrors=mirrors,
        generators=copied(view.generators, view.n_generators, 3, 3),
        weights=copied(view.weights, view.n_edges, 3) if view.weights else None,
        seams=copied(view.seams, view.n_seams, 2),
        filled_holes=report.filled_holes,
        refined_edges=report.refined_edges,
        chart=chart,
        report=_report(report, signature, geometry, cones, orders, mirrors),
        native=native,
    )


def chart_number(chart: str, geometry: str) -> int:
    """The C enum's entry. OrbifoldError where the geometry has no such chart."""
    if chart == "default":
        chart = CHARTS[geometry][0]
    if chart not in CHARTS[geometry]:
        raise OrbifoldError(
            "ORB_BAD_ARGUMENT",
            f"there is no chart '{chart}' for {geometry} orbifolds; use {' or '.join(CHARTS[geometry])}",
        )
    return binding.CHARTS[chart]


def _report(
    native: binding.Report, signature: str, geometry: str, cones: np.ndarray, orders: np.ndarray, mirrors: np.ndarray
) -> dict:
    """The dictionary of NAME.json. The library gives out certified embeddings only, hence "bijective"."""

    def fields(*names: str, prefix: str = "") -> dict:
        return {name: getattr(native, prefix + name) for name in names}

    modulus = list(native.modulus)
    return {
        "mesh": fields("vertices", "triangles", "components", "euler", "boundary_loops", "genus", "orientable"),
        "orbifold": {
            "signature": signature,
            "geometry": geometry,
            "euler": native.orbifold_euler,
            "cones": [
                {"vertex": int(vertex), "order": int(order), "mirror": bool(mirror)}
                for vertex, order, mirror in zip(cones, orders, mirrors)
            ],
            "moduli": native.n_moduli,
            "modulus": modulus if geometry == "euclidean" and any(modulus) else None,
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
