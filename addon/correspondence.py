# SPDX-License-Identifier: GPL-3.0-or-later
"""What a target mesh gets from a source mesh by their surface map; arrays only, no bpy.

Vertices take what the source has where they go. Corners and faces need more care, for UV maps are torn along seams:
a corner takes what the source has a little inside the corner's face, so that it is on the right side of a seam that
runs along the face. A face that a seam runs through cannot be right: it continues the island that holds its middle.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from . import core

if TYPE_CHECKING:
    from .blender_mesh import MeshArrays

INSIDE = 1e-6  # how far within its face a corner is looked up, in barycentric coordinates
SAMPLES = 32  # points on each edge of a seam, at least
MOST_SAMPLES = 512  # on an edge
ALL_SAMPLES = 3_000_000  # of a UV map, about: it may be torn along all edges
CUT_SAMPLES = 9  # points on each edge of the cut
TORN = 1e-6  # difference of two UVs from which on an edge is a seam
ASTRAY = 0.75  # from where the affine map of a face's middle has a corner, in the face's size: it is beyond a seam


@dataclass(frozen=True)
class Spots:
    """Points of a mesh: (p,) triangles, -1 for none, and (p, 3) barycentric coordinates."""

    triangles: np.ndarray
    barycentric: np.ndarray

    @property
    def there(self) -> np.ndarray:
        return self.triangles >= 0

    def mixed(self, corners: np.ndarray) -> np.ndarray:
        """(p, ...) of values (m, 3, ...) at the triangles' corners. Any in the triangle -1."""
        return np.einsum("pc,pc...->p...", self.barycentric, corners[self.triangles])

    def nearest(self, corners: np.ndarray) -> np.ndarray:
        """(p, ...) the value of the nearest corner, in barycentric coordinates."""
        return corners[self.triangles, self.barycentric.argmax(1)]


@dataclass(frozen=True, eq=False)
class Correspondence:
    """Of two meshes that are embedded alike."""

    source: MeshArrays
    target: MeshArrays
    map: core.SurfaceMap  # of the target onto the source
    back: core.SurfaceMap  # of the source onto the target

    @cached_property
    def vertices(self) -> Spots:
        """Of each vertex of the target."""
        return Spots(*self.map.spots)

    @cached_property
    def corners(self) -> Spots:
        """Of each corner ("loop") of the target, a little within its face; -1 for those of other components."""
        n_loops, triangles = self.target.n_loops, np.full(self.target.n_loops, -1, np.int32)
        loops, first = np.unique(self.target.loops.ravel(), return_index=True)
        at = first // 3
        weights = np.full((len(loops), 3), INSIDE)
        weights[np.arange(len(loops)), first % 3] = 1 - 2 * INSIDE
        barycentric = np.zeros((n_loops, 3))
        triangles[loops], barycentric[loops] = self.map.evaluate(at, weights)
        return Spots(triangles, barycentric)

    @cached_property
    def middles(self) -> Spots:
        """Of each face of the target, by a triangle of it."""
        polygons, first = np.unique(self.target.polygons, return_index=True)
        n = int(polygons.max(initial=-1)) + 1
        triangles, barycentric = np.full(n, -1, np.int32), np.zeros((n, 3))
        triangles[polygons], barycentric[polygons] = self.map.evaluate(first, np.full((len(first), 3), 1 / 3))
        return Spots(triangles, barycentric)

    def of_vertices(self, values: np.ndarray) -> np.ndarray:
        """(n, ...) values of the source's vertices -> of the target's."""
        return self.vertices.mixed(values[self.source.triangles])

    def nearest_of_vertices(self, values: np.ndarray) -> np.ndarray:
        return self.vertices.nearest(values[self.source.triangles])

    def of_corners(self, values: np.ndarray) -> np.ndarray:
        """(loops, ...) values of the source's corners -> of the target's."""
        return self.corners.mixed(values[self.source.loops])

    def nearest_of_corners(self, values: np.ndarray) -> np.ndarray:
        return self.corners.nearest(values[self.source.loops])

    def of_faces(self, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(faces, ...) values of the source's faces -> those at the middles of the target's faces (k,), and these."""
        faces = np.flatnonzero(self.middles.there)
        return values[self.source.polygons[self.middles.triangles[faces]]], faces

    @cached_property
    def images(self) -> np.ndarray:
        """(n, 3) where the target's vertices are in the source's coordinates; NaN for those that are nowhere."""
        found = self.of_vertices(self.source.vertices)
        found[~self.vertices.there] = np.nan
        return found

    @cached_property
    def cut_ratio(self) -> float:
        """How long the source's cut is once it is mapped to the target, for the length of the target's own cut."""
        source, target = self.back.source, self.back.target
        seams = source.seams[(source.seams < source.n_input_vertices).all(1)]
        ends = _sides(self.source.triangles)
        n = int(self.source.triangles.max(initial=0)) + 1
        keys = ends.min(1) * n + ends.max(1)
        order = np.argsort(keys, kind="stable")
        corner = order[np.searchsorted(keys[order], seams.min(1).astype(np.int64) * n + seams.max(1))]
        steps = np.linspace(0, 1, CUT_SAMPLES)
        at, where = self.back.evaluate(*_along(np.repeat(corner, CUT_SAMPLES), np.tile(steps, len(corner))))
        points = Spots(at, where).mixed(self.target.vertices[self.target.triangles])
        points[at < 0] = np.nan
        lengths = np.linalg.norm(np.diff(points.reshape(len(corner), CUT_SAMPLES, 3), axis=1), axis=2)
        own = np.linalg.norm(np.diff(target.vertices[target.seams], axis=1), axis=2).sum()
        return float(np.nansum(lengths) / own) if own > 0 else 1.0

    # ------------------------------------------------------------------------------------------------- UV maps

    def of_uv(self, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """A UV map (loops, 2) of the source -> that of the target (loops, 2), and the faces that cross a seam."""
        found = self.of_corners(uv)
        corners = uv[self.source.loops]
        loops, first = np.unique(self.target.loops.ravel(), return_index=True)
        faces, vertices = self.target.polygons[first // 3], self.target.triangles.ravel()[first]
        known = self.corners.there[loops] & self.middles.there[faces] & self.vertices.there[vertices]
        loops, faces, vertices = loops[known], faces[known], vertices[known]
        continued, astray = self._continued(corners, loops, faces, vertices, found[loops])
        crossing = np.zeros(len(self.middles.triangles), bool)
        crossing[self._met(torn_edges(self.source.triangles, corners)[:, 0])] = True
        beyond = np.zeros(len(crossing), bool)
        beyond[faces[astray]] = True
        for _ in range(8):  # a seam may cut off a tip of a face that no sample is in
            near = np.zeros(len(self.target.vertices), bool)
            near[vertices[crossing[faces]]] = True
            more = np.zeros(len(crossing), bool)
            more[faces[near[vertices]]] = True
            more &= beyond & ~crossing
            if not more.any():
                break
            crossing |= more
        mended = crossing[faces] & astray
        found[loops[mended]] = continued[mended]
        return found, np.flatnonzero(crossing)

    def _continued(
        self, corners: np.ndarray, loops: np.ndarray, faces: np.ndarray, vertices: np.ndarray, found: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """What the affine map of the source's triangle under each face's middle has at the corners, and whether what
        was found is farther from that than a face is large."""
        middle = self.middles.triangles[faces]
        weights = _in_plane(self.source.vertices[self.source.triangles[middle]], self.images[vertices])
        continued = np.einsum("pc,pcd->pd", weights, corners[middle])
        centre = self.middles.mixed(corners)[faces]
        size = np.zeros(len(self.middles.triangles))
        np.maximum.at(size, faces, np.linalg.norm(continued - centre, axis=1))
        astray = np.linalg.norm(found - continued, axis=1) > ASTRAY * size[faces] + TORN
        usable = np.isfinite(continued).all(1)
        return np.where(usable[:, None], continued, found), astray & usable

    def _met(self, torn: np.ndarray) -> np.ndarray:
        """The target's faces in whose inside there are points of these edges (k,), by corner of the source's."""
        finer = np.sqrt(len(self.target.triangles) / max(len(self.source.triangles), 1))
        samples = int(np.clip(SAMPLES * finer, SAMPLES, MOST_SAMPLES))
        samples = max(min(samples, ALL_SAMPLES // max(len(torn), 1)), 4)
        steps = np.tile((np.arange(samples) + 0.5) / samples, len(torn))
        at, where = self.back.evaluate(*_along(np.repeat(torn, samples), steps))
        inside = (at >= 0) & (where.min(1) > 2 * INSIDE)
        return np.unique(self.target.polygons[at[inside]])

    # --------------------------------------------------------------------------------------------------- forms

    def of_displacements(self, displacements: np.ndarray) -> np.ndarray:
        """(n, 3) of the source's vertices -> of the target's: turned as the surface is turned there, and longer or
        shorter as the target is as a whole."""
        found = np.nan_to_num(self.of_vertices(displacements))
        turns, scale = self._turns
        return scale * np.einsum("nij,nj->ni", turns, found) * self.vertices.there[:, None]

    @cached_property
    def _turns(self) -> tuple[np.ndarray, float]:
        """(n, 3, 3) the rotation from source to target around each of the target's vertices; the factor of lengths."""
        frames, areas = zip(*(_frames(points[self.target.triangles]) for points in (self.images, self.target.vertices)))
        usable = np.isfinite(frames[0]).all((1, 2)) & np.isfinite(frames[1]).all((1, 2)) & (areas[0] * areas[1] > 0)
        turns = np.zeros((len(self.target.vertices), 3, 3))
        triangles = self.target.triangles[usable]
        stretch = frames[1][usable] @ np.linalg.pinv(frames[0][usable])
        stretch *= (areas[1][usable] / np.linalg.norm(stretch, axis=(1, 2)))[:, None, None]
        for corner in range(3):
            np.add.at(turns, triangles[:, corner], stretch)
        left, _, right = np.linalg.svd(turns)
        left[:, :, 2] *= np.linalg.det(left @ right)[:, None]
        return left @ right, float(np.sqrt(areas[1][usable].sum() / max(areas[0][usable].sum(), 1e-300)))


def _frames(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(m, 3, 3) two sides and the normal, as long as a side, of triangles (m, 3, 3), as columns; (m,) their areas."""
    one, other = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    normal = np.cross(one, other)
    twice = np.linalg.norm(normal, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.stack([one, other, normal / np.sqrt(twice)[:, None]], 2), twice / 2


def _in_plane(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    """(p, 3) the barycentric coordinates of points (p, 3) with respect to triangles (p, 3, 3), in their planes."""
    one, other, to = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0], points - corners[:, 0]
    a, b, c = (one * one).sum(1), (one * other).sum(1), (other * other).sum(1)
    p, q = (to * one).sum(1), (to * other).sum(1)
    with np.errstate(divide="ignore", invalid="ignore"):
        second, third = (c * p - b * q) / (a * c - b * b), (a * q - b * p) / (a * c - b * b)
    return np.stack([1 - second - third, second, third], 1)


def _sides(triangles: np.ndarray) -> np.ndarray:
    """(3 m, 2) the ends of the sides, that of corner 0 first."""
    return np.stack([triangles, np.roll(triangles, -1, axis=1)], 2).reshape(-1, 2).astype(np.int64)


def _along(corners: np.ndarray, steps: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points on sides, that begin with these corners of all 3 m: (p,) triangles and (p, 3) barycentric coordinates."""
    weights, rows = np.zeros((len(corners), 3)), np.arange(len(corners))
    weights[rows, corners % 3], weights[rows, (corners + 1) % 3] = 1 - steps, steps
    return corners // 3, weights


def torn_edges(triangles: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """(k, 2) where a UV map (m, 3, 2) is torn: of each such edge the corners, of all 3 m, that it begins with in the
    triangles on both sides."""
    ends = _sides(triangles)
    values = np.stack([corners, np.roll(corners, -1, axis=1)], 2).reshape(-1, 2, corners.shape[-1])
    turned = ends[:, 0] > ends[:, 1]
    values[turned] = values[turned, ::-1]
    keys = ends.min(1) * (int(triangles.max(initial=0)) + 1) + ends.max(1)
    order = np.argsort(keys, kind="stable")
    same = np.flatnonzero(keys[order[1:]] == keys[order[:-1]])
    one, other = order[same], order[same + 1]
    return np.stack([one, other], 1)[np.abs(values[one] - values[other]).max((1, 2), initial=0.0) > TORN]


# ------------------------------------------------------------------------------------------------- the orbifold


def orbifold_for(text_with: Callable[[int], str]) -> str | None:
    """The signature for landmarks of one kind; `text_with(n)` is that with all orders n. None: there are too few.

    Three landmarks on a sphere have one conformal map, whatever the orders: 333 comes as near to it as another, treats
    all alike, and is one linear solve. Four have one tile in the plane, 2222, whose shape is free. From five on it is
    hyperbolic, and the cones that squeeze least are those of order 2. So it is order 2 for all where that is not on the
    sphere, else 3: also on disks (*333, *2222, 3*3, 22*)."""
    for order in (2, 3):
        try:
            if core.parse_signature(text_with(order)).curvature <= 0:
                return text_with(order)
        except core.OrbifoldError:  # a single cone
            continue
    return None
