# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps faces whole in a layout that was computed on their triangles.

Blender has one texture coordinate for each corner of a face, so no seam may run along a diagonal inside one. Where
the cut does, the face's triangles are put together again: the layout is only defined up to the orbifold's group, and
the isometry that carries one copy of the diagonal to the other moves a triangle to where the face continues. The
seam then runs around the face instead of through it. (Isometries as in native/src/geometry.h: z is the complex
chart, z -> (z - p) / (1 + K conj(p) z) takes p to the origin.)

Two charts of the sphere have a discontinuity of their own, a date line or folds. No face crosses it either: a face
stays on the side of its first corner and may stick out of the unit square.
"""

from __future__ import annotations

import cmath
from dataclasses import dataclass, replace

import numpy as np

from . import charts
from .blender_mesh import MeshArrays
from .core import Result

FITTED = ("conformal", "stereographic")  # charts that fill the unit square
SAME = 1e-7  # two placings of an edge are one below this part of its length; neighbouring copies differ by far more
APART = 1e-6  # of the unit square: texture coordinates of an edge's two sides that differ by more are a fold
APART = 1e-6  # of the unit square: two sides of a fold


@dataclass(frozen=True)
class FaceLayout:
    """A layout in which no seam crosses a face."""

    chart: str
    uv: np.ndarray  # (m, 3, 2) per triangle corner
    embedding: np.ndarray  # (m, 3, 3) the corners' points on the plane, sphere or hyperboloid
    seams: np.ndarray  # (k, 2) vertex pairs
    mended: int  # faces that the cut ran through


def layout_of(result: Result, arrays: MeshArrays, chart: str) -> FaceLayout:
    layout = _without_cut_faces(result, arrays, chart)
    return _without_folded_faces(layout, arrays) if chart in charts.DISCONTINUOUS else layout


def _without_cut_faces(result: Result, arrays: MeshArrays, chart: str) -> FaceLayout:
    uv = result.uv_chart(chart)
    placed = result.embedding[result.cut_triangles]
    groups = _cut_faces(result.seams, arrays)
    if not groups:
        return FaceLayout(chart, uv, placed, result.seams, 0)
    curvature = charts.CURVATURE[result.geometry]
    z = charts.to_complex(placed + result.embedding_low[result.cut_triangles], curvature)
    moved: list[int] = []
    for members in groups:
        moved += _put_together(members, arrays.triangles, z, curvature)
    touched = np.concatenate([np.asarray(group) for group in groups])
    seams = _seams_of(result.seams, arrays.triangles, touched, z)
    placed = placed.copy()
    placed[moved] = charts.to_points(z[moved], curvature)
    uv = uv.copy()
    unmoved = np.setdiff1d(np.arange(len(uv)), moved)
    known = result.embedding[result.cut_triangles[unmoved]]
    uv[moved] = charts.chart_of(chart, result.geometry, known, uv[unmoved]).to_uv(placed[moved])
    for corners in (uv, placed):
        corners[touched] = _first_of_each(arrays.loops[touched], corners[touched])
    return FaceLayout(chart, _fitted(uv) if chart in FITTED else uv, placed, seams, len(groups))


def _without_folded_faces(layout: FaceLayout, arrays: MeshArrays) -> FaceLayout:
    """In a chart that is not continuous: no face crosses its fold or date line; the edges along it are seams too."""
    corners = np.empty((arrays.n_loops, 2))
    corners[arrays.loops] = charts.joined(layout.chart, layout.uv, layout.embedding, arrays.polygons)
    uv = corners[arrays.loops]
    n = len(arrays.vertices)
    half = _half_edges(arrays.triangles).reshape(-1, 2)
    sides = np.argsort(_keys(half, n), kind="stable").reshape(-1, 2)  # closed: each edge has two sides
    seen = charts.without_poles(layout.chart, uv)
    start, end = seen.reshape(-1, 2)[sides], np.roll(seen, -1, axis=1).reshape(-1, 2)[sides]
    apart = np.abs(np.concatenate([start[:, 0] - end[:, 1], end[:, 0] - start[:, 1]], -1)).max(-1) > APART
    folds = half[sides[apart, 0]]
    folds = folds[~np.isin(_keys(folds, n), _keys(layout.seams, n))]
    return replace(layout, uv=uv, seams=np.concatenate([layout.seams, folds.astype(np.int32)]))


def _fitted(uv: np.ndarray) -> np.ndarray:
    """Into the unit square, filled in one direction, as native/src/layout.c does: a moved triangle may stick out."""
    low, high = uv.reshape(-1, 2).min(0), uv.reshape(-1, 2).max(0)
    return np.clip(0.5 + (uv - (low + high) / 2) / (high - low).max(), 0, 1)


# ------------------------------------------------------------------------------------------------- geometry


def isometry_pairing(p: complex, q: complex, p1: complex, q1: complex, curvature: int):
    """The function that takes p to p1 and q to q1 (equally far apart)."""

    def toward(a: complex, b: complex) -> complex:
        return (b - a) / (1 + curvature * a.conjugate() * b)

    turn = cmath.rect(1.0, cmath.phase(toward(p1, q1)) - cmath.phase(toward(p, q)))

    def apply(b: complex) -> complex:
        return toward(-p1, turn * toward(p, b))

    return apply


# ---------------------------------------------------------------------------------------------------- faces


def _keys(edges: np.ndarray, n_vertices: int) -> np.ndarray:
    return edges.min(-1).astype(np.int64) * n_vertices + edges.max(-1)


def _half_edges(triangles: np.ndarray) -> np.ndarray:
    """(m, 3, 2): side s of a triangle runs from its corner s to the next."""
    return np.stack([triangles, np.roll(triangles, -1, axis=1)], -1)


def _cut_faces(seams: np.ndarray, arrays: MeshArrays) -> list[list[int]]:
    """The triangles of each face that a seam runs through."""
    if arrays.all_triangles or not len(seams):
        return []
    n = len(arrays.vertices)
    sides = _keys(_half_edges(arrays.triangles), n)
    on_seam = np.isin(sides, _keys(seams, n))
    rows, which = np.nonzero(on_seam)[0], sides[on_seam]
    order = np.argsort(which, kind="stable")
    which, rows = which[order], rows[order]
    paired = which[:-1] == which[1:]
    first, second = arrays.polygons[rows[:-1][paired]], arrays.polygons[rows[1:][paired]]
    cut = np.unique(first[first == second])
    triangles = np.flatnonzero(np.isin(arrays.polygons, cut))
    groups: dict[int, list[int]] = {}
    for triangle, polygon in zip(triangles.tolist(), arrays.polygons[triangles].tolist()):
        groups.setdefault(polygon, []).append(triangle)
    return list(groups.values())


def _put_together(members: list[int], triangles: np.ndarray, z: np.ndarray, curvature: int) -> list[int]:
    """Place the triangles of one face side by side, starting from its first one; writes z, returns those moved."""
    waiting, reached, moved = set(members[1:]), [members[0]], []
    while reached:
        here = reached.pop()
        for there in sorted(waiting):
            shared = [v for v in triangles[here].tolist() if v in triangles[there].tolist()]
            if len(shared) < 2:
                continue
            at_here = [triangles[here].tolist().index(v) for v in shared[:2]]
            at_there = [triangles[there].tolist().index(v) for v in shared[:2]]
            p, q = (complex(z[there, c]) for c in at_there)
            p1, q1 = (complex(z[here, c]) for c in at_here)
            if abs(p - p1) + abs(q - q1) > SAME * abs(q1 - p1):
                apply = isometry_pairing(p, q, p1, q1, curvature)
                z[there] = [apply(complex(b)) for b in z[there]]
                z[there, at_there] = p1, q1
                moved.append(there)
            waiting.remove(there)
            reached.append(there)
    return moved


def _first_of_each(loops: np.ndarray, values: np.ndarray) -> np.ndarray:
    """`values` (t, 3, w) at the face corners `loops` (t, 3): the same value, to the last digit, wherever a corner
    occurs in several triangles."""
    _, first, place = np.unique(loops.ravel(), return_index=True, return_inverse=True)
    return values.reshape(loops.size, -1)[first][place.ravel()].reshape(values.shape)


def _seams_of(seams: np.ndarray, triangles: np.ndarray, touched: np.ndarray, z: np.ndarray) -> np.ndarray:
    """The seams after the touched triangles were moved: edges whose two sides do not lie on one another."""
    n = int(triangles.max()) + 1
    half = _half_edges(triangles)
    candidates = np.union1d(_keys(seams, n), _keys(half[touched], n).ravel())
    keys = _keys(half, n)
    rows, sides = np.nonzero(np.isin(keys, candidates))
    order = np.argsort(keys[rows, sides], kind="stable")
    rows, sides = rows[order], sides[order]
    one, other = (rows[0::2], sides[0::2]), (rows[1::2], sides[1::2])  # closed: each edge has two sides
    start, end = z[one[0], one[1]], z[one[0], (one[1] + 1) % 3]
    far_start, far_end = z[other[0], (other[1] + 1) % 3], z[other[0], other[1]]
    apart = np.abs(start - far_start) + np.abs(end - far_end) > SAME * np.abs(end - start)
    return half[one[0], one[1]][apart].astype(np.int32)
