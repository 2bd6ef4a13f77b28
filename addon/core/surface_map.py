# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps from one mesh to another: continuous, bijective, without seams, landmarks to landmarks.

    sequence = landmark_sequence(*mesh_a, landmarks_a)
    a = embed(*mesh_a, "2222222", landmarks_a[sequence], cut="path")
    b = embed(*mesh_b, "2222222", landmarks_b[sequence], cut="path")
    triangles, barycentric = surface_map(a, b)        # where each vertex of the first mesh is on the second
    a_to_b = SurfaceMap(a, b)
    a_to_b.transfer(colours_b)                        # what b has there, for each vertex of a
    SurfaceMap(b, c).evaluate(*a_to_b.spots)          # where a's vertices are on c, by way of b: the same as on c

Meshes that are embedded alike have maps between any two of them, which agree with one another.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from . import binding
from .arrays import integers, mesh_of, picks_of, rows_of_three
from .errors import OrbifoldError
from .result import Result


def landmark_sequence(
    vertices: ArrayLike,
    triangles: ArrayLike,
    landmarks: Sequence[int] | np.ndarray,
    orders: Sequence[int] | np.ndarray | None = None,
) -> np.ndarray:
    """(k,) int32: the numbers of the landmarks in the sequence of a short walk through them on this mesh, for the cones
    of every mesh that has them. Those of different `orders` do not change places."""
    points, faces = mesh_of(vertices, triangles)
    picked, orders = picks_of(landmarks, orders)
    return binding.landmark_sequence(points, faces, picked, orders)


def surface_map(source_result: Result, target_result: Result) -> tuple[np.ndarray, np.ndarray]:
    """Where each given vertex of the source is on the target: (n,) int32 triangles, as they were given, and (n, 3)
    barycentric coordinates. -1 and zeros for vertices that no triangle uses or that go to a hole that was filled.

    OrbifoldError "ORB_NO_CORRESPONDENCE", with what to do, where the two are not embedded alike: one signature, the
    landmarks in one sequence with one sequence of orders, and with more than three of them on a sphere cut="path".
    """
    return SurfaceMap(source_result, target_result).spots


@dataclass(frozen=True)
class MapDistortion:
    """The map's differential in the middle of each given triangle of the source; means are weighted by its area."""

    quasi_conformal: np.ndarray  # (m,) ratio of the singular values, 1: conformal; 0: left out
    log_area: np.ndarray  # (m,) logarithm of area on the target / area on the source
    quasi_conformal_mean: float
    quasi_conformal_max: float
    log_area_mean: float
    log_area_std: float
    flipped: int  # triangles whose orientation turns over: none
    left_out: int  # triangles without area, here or there, or that go to a hole that was filled


@dataclass(frozen=True, eq=False)
class Trace:
    """The courses of k edges over a mesh, cut into s stretches that are straight within one triangle. Those of an edge
    are in turn, and each begins where the one before ends: on a side or at a corner, where weights are exactly 0."""

    edges: np.ndarray  # (s,) which edge, 0 to k - 1
    triangles: np.ndarray  # (s,) of the target as they were given, or -1 in a hole that was filled
    at: np.ndarray  # (s, 2) both ends along the edge, 0 to 1
    barycentric: np.ndarray  # (s, 2, 3) both ends in the triangle


@dataclass(frozen=True, eq=False)
class SurfaceMap:
    """The map of one embedded mesh onto another one."""

    source: Result
    target: Result

    @cached_property
    def _mapped(self) -> tuple[np.ndarray, np.ndarray, binding.MapReport]:
        return self.source.native.map_points(self.target.native, None, None, self.source.n_input_vertices)

    @property
    def spots(self) -> tuple[np.ndarray, np.ndarray]:
        """What `surface_map` gives: (n,) triangles and (n, 3) barycentric coordinates."""
        return self._mapped[:2]

    @property
    def steps(self) -> int:
        """Sides of the target's triangles that were crossed on the way to all vertices."""
        return self._mapped[2].steps

    @property
    def landmark_residual(self) -> float:
        """How far corresponding corners of the two tiles lie from each other; landmarks go to landmarks exactly."""
        return self._mapped[2].landmark_residual

    def evaluate(self, triangles: ArrayLike, barycentric: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        """Where points of the source are: (p,) its triangles as they were given, or -1 for none, and (p, 3)."""
        where = integers(triangles, (-1,), "triangles of the points", "ORB_INDEX_OUT_OF_RANGE", "triangle")
        weights = rows_of_three(barycentric, "barycentric coordinates") if len(where) else np.zeros((0, 3))
        if len(weights) != len(where):
            raise OrbifoldError(
                "ORB_BAD_ARGUMENT", f"{len(where)} triangles have {len(weights)} rows of barycentric coordinates"
            )
        if not len(where):
            return where, weights
        return self.source.native.map_points(self.target.native, where, weights, len(where))[:2]

    def points(self) -> np.ndarray:
        """(n, 3) where each given vertex of the source is in the target's space; NaN where it is nowhere."""
        return self.transfer(self.target.vertices[: self.target.n_input_vertices])

    def transfer(self, values: ArrayLike, corners: bool = False) -> np.ndarray:
        """(n, ...) what the target has where the source's vertices are, interpolated; `values` (n_target, ...) is an
        attribute of the target's given vertices, or where `corners` of its given triangles' corners, (m_target, 3, ...).
        NaN where a vertex is nowhere."""
        return interpolated(self.target, values, *self.spots, corners)

    def trace(self, corners: ArrayLike) -> Trace:
        """The courses of edges of the source over the target: of each edge the corner, of all 3 m of its triangles as
        they were given, that it begins with in a triangle."""
        picked = integers(corners, (-1,), "corners of the edges", "ORB_INDEX_OUT_OF_RANGE", "corner")
        found = self.source.native.trace(self.target.native, picked)
        return Trace(found["edge"], found["triangle"], found["at"], found["barycentric"])

    @cached_property
    def distortion(self) -> MapDistortion:
        ratio, log_area, all_of_it = self.source.native.map_distortion(
            self.target.native, len(self.source.input_corners)
        )
        return MapDistortion(
            ratio, log_area, *(getattr(all_of_it, name) for name, *_ in binding.MapDistortion._fields_)
        )


def interpolated(
    result: Result, values: ArrayLike, triangles: np.ndarray, barycentric: np.ndarray, corners: bool = False
) -> np.ndarray:
    """(p, ...) an attribute of a mesh at points of it: (n, ...) of its given vertices, or where `corners` (m, 3, ...) of
    its given triangles' corners. NaN in the triangle -1."""
    attribute = np.asarray(values, np.float64)
    n_rows, what = (len(result.input_corners), "triangles") if corners else (result.n_input_vertices, "vertices")
    if attribute.shape[:1] != (n_rows,) or (corners and attribute.shape[1:2] != (3,)):
        raise OrbifoldError(
            "ORB_BAD_ARGUMENT", f"the values have the shape {attribute.shape}; give one row for each of {n_rows} {what}"
        )
    if corners:
        around = attribute[triangles]  # (p, 3, ...); of -1 any
    else:
        around = attribute[result.triangles.ravel()[result.input_corners[triangles]]]
    mixed = np.einsum("pc,pc...->p...", barycentric, around)
    mixed[triangles < 0] = np.nan
    return mixed
