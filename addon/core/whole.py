# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps faces whole in a layout that was computed on the library's triangles.

A face is one of the triangles that were given, or several that make a polygon. It has one texture coordinate for each
corner, so no seam may run inside it. The library never cuts through a triangle, but along a diagonal of a polygon it
may. Where it does, the face's triangles are put together again: the layout is only defined up to the orbifold's group,
and the isometry that carries one copy of the inner edge to the other moves a triangle to where the face continues; it
turns the triangle over where the cut runs along a cross-cap. The seam then runs around the face instead of through it.
(Isometries as in native/src/geometry.h: z is the complex chart, z -> (z - p) / (1 + K conj(p) z) takes p to the origin.)

Two charts of the sphere have a discontinuity of their own, a date line or folds. No face crosses it either: a face
stays on the side of its first corner and may stick out of the unit square.
"""

from __future__ import annotations

import cmath
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from . import charts

if TYPE_CHECKING:
    from .result import Result

FITTED = ("conformal", "stereographic")  # charts that fill the unit square
SAME = 1e-7  # two placings of an edge are one below this part of its length; neighbouring copies differ by far more
APART = 1e-6  # of the unit square: texture coordinates of an edge's two sides that differ by more are a fold


@dataclass(frozen=True)
class WholeLayout:
    """Of the library's t triangles."""

    uv: np.ndarray  # (t, 3, 2)
    points: np.ndarray  # (t, 3, 3) on the plane, sphere or hyperboloid
    seams: np.ndarray  # (k,) edge_keys, ascending
    mended: int  # faces that the cut ran through


@dataclass(frozen=True)
class _Pieces:
    """The library's triangles, each a part of a face; in a filled hole of none."""

    triangles: np.ndarray  # (t, 3) vertices
    faces: np.ndarray  # (t,) the face of each, or a negative number of its own
    keys: np.ndarray  # (t, 3) int64: the edge from each corner to the next
    n_vertices: int


def whole_layout(result: Result, chart: str, faces: np.ndarray | None = None, joins: bool = False) -> WholeLayout:
    """`faces` (m_in,): the face that each given triangle is a part of; None: every triangle is one. `joins`: keep
    faces also on one side of a chart's discontinuity, which then is a seam."""
    pieces = _pieces_of(result, faces)
    uv, placed, seams, mended = _without_cut_faces(result, pieces, chart)
    if joins and chart in charts.DISCONTINUOUS:
        uv, folds = _without_folded_faces(chart, uv, placed, pieces)
        seams = np.union1d(seams, folds)
    return WholeLayout(uv, placed, seams, mended)


def edge_keys(triangles: np.ndarray, n_vertices: int) -> np.ndarray:
    """(m, 3): a number for the edge from each corner to the next, low end * n_vertices + high end."""
    return _keys(np.stack([triangles, np.roll(triangles, -1, axis=1)], -1), n_vertices)


def _pieces_of(result: Result, faces: np.ndarray | None) -> _Pieces:
    origin = result.refined_from
    if faces is None:
        faces = np.arange(len(result.input_corners))
    if origin is not None:
        faces = np.where(origin >= 0, faces[origin], -1 - np.arange(len(origin)))
    n = len(result.vertices)
    return _Pieces(result.triangles, faces, edge_keys(result.triangles, n), n)


# ------------------------------------------------------------------------------------------- the library's cut


def _without_cut_faces(result: Result, pieces: _Pieces, chart: str) -> tuple[np.ndarray, np.ndarray, np.ndarray, int]:
    """uv (t, 3, 2), points (t, 3, 3), keys of the seams, and how many faces were put together."""
    uv = result.tile_uv(chart)
    placed = result.embedding[result.cut_triangles]
    seams = np.unique(_keys(result.seams, pieces.n_vertices))
    groups = _cut_faces(seams, pieces)
    if not groups:
        return uv, placed, seams, 0
    curvature = charts.CURVATURE[result.geometry]
    z = charts.to_complex(placed + result.embedding_low[result.cut_triangles], curvature)
    moved: list[int] = []
    for members in groups:
        moved += _put_together(members, pieces.triangles, z, curvature)
    seams = _seams_of(seams, pieces, np.concatenate([np.asarray(group) for group in groups]), z)
    placed[moved] = charts.to_points(z[moved], curvature)
    unmoved = np.setdiff1d(np.arange(len(uv)), moved)
    fitted = charts.chart_of(chart, result.geometry, placed[unmoved], uv[unmoved])
    uv[moved] = fitted.to_uv(placed[moved])
    return _fitted(uv) if chart in FITTED else uv, placed, seams, len(groups)


def _cut_faces(seams: np.ndarray, pieces: _Pieces) -> list[list[int]]:
    """The triangles of each face that a seam runs through."""
    if len(np.unique(pieces.faces)) == len(pieces.faces):
        return []
    one, other = _sides(pieces.keys, np.isin(pieces.keys, seams))
    first, second = pieces.faces[one[0]], pieces.faces[other[0]]
    cut = np.unique(first[(first == second) & (first >= 0)])
    groups: dict[int, list[int]] = {}
    for triangle in np.flatnonzero(np.isin(pieces.faces, cut)).tolist():
        groups.setdefault(int(pieces.faces[triangle]), []).append(triangle)
    return list(groups.values())


def _put_together(members: list[int], triangles: np.ndarray, z: np.ndarray, curvature: int) -> list[int]:
    """Place the triangles of one face side by side, starting from its first one; writes z, returns those moved."""
    waiting, reached, moved = set(members[1:]), [members[0]], []
    turned = {members[0]: False}
    while reached:
        here = reached.pop()
        for there in sorted(waiting):
            own, its = triangles[here].tolist(), triangles[there].tolist()
            shared = [v for v in own if v in its]
            if len(shared) < 2:
                continue
            at_here, at_there = [own.index(v) for v in shared[:2]], [its.index(v) for v in shared[:2]]
            same_way = (at_here[1] - at_here[0]) % 3 == (at_there[1] - at_there[0]) % 3
            turned[there] = turned[here] != same_way
            p, q = (complex(z[there, c]) for c in at_there)
            p1, q1 = (complex(z[here, c]) for c in at_here)
            if turned[there] or abs(p - p1) + abs(q - q1) > SAME * abs(q1 - p1):
                apply = isometry_pairing(p, q, p1, q1, curvature, turned[there])
                z[there] = [apply(complex(b)) for b in z[there]]
                z[there, at_there] = p1, q1
                moved.append(there)
            waiting.remove(there)
            reached.append(there)
    return moved


def isometry_pairing(p: complex, q: complex, p1: complex, q1: complex, curvature: int, turns_over: bool = False):
    """The function that takes p to p1 and q to q1 (equally far apart) and keeps, or turns over, orientation."""

    def toward(a: complex, b: complex) -> complex:
        return (b - a) / (1 + curvature * a.conjugate() * b)

    def seen(b: complex) -> complex:
        return b.conjugate() if turns_over else b

    turn = cmath.rect(1.0, cmath.phase(toward(p1, q1)) - cmath.phase(toward(seen(p), seen(q))))

    def apply(b: complex) -> complex:
        return toward(-p1, turn * toward(seen(p), seen(b)))

    return apply


def _seams_of(seams: np.ndarray, pieces: _Pieces, touched: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Keys of the seams after the touched triangles were moved: edges whose two sides do not lie on one another."""
    candidates = np.union1d(seams, pieces.keys[touched].ravel())
    one, other = _sides(pieces.keys, np.isin(pieces.keys, candidates))
    low, high = _ends(pieces.triangles, z, one)
    far_low, far_high = _ends(pieces.triangles, z, other)
    apart = np.abs(low - far_low) + np.abs(high - far_high) > SAME * np.abs(high - low)
    return np.unique(pieces.keys[one][apart])


def _fitted(uv: np.ndarray) -> np.ndarray:
    """Into the unit square, filled in one direction, as native/src/layout.c does: a moved triangle may stick out."""
    low, high = uv.reshape(-1, 2).min(0), uv.reshape(-1, 2).max(0)
    return np.clip(0.5 + (uv - (low + high) / 2) / (high - low).max(), 0, 1)


# ------------------------------------------------------------------------------------- folds and the date line


def _without_folded_faces(
    chart: str, uv: np.ndarray, placed: np.ndarray, pieces: _Pieces
) -> tuple[np.ndarray, np.ndarray]:
    """In a chart that is not continuous: no face crosses its fold or date line. uv and keys of the edges along it."""
    uv = charts.joined(chart, uv, placed, pieces.faces)
    one, other = _sides(pieces.keys, np.ones(pieces.keys.shape, bool))
    seen = charts.without_poles(chart, uv)
    sides = [np.concatenate(_ends(pieces.triangles, seen, side), -1) for side in (one, other)]
    return uv, np.unique(pieces.keys[one][np.abs(sides[0] - sides[1]).max(-1) > APART])


# ------------------------------------------------------------------------------------------------------ edges


def _keys(edges: np.ndarray, n_vertices: int) -> np.ndarray:
    return edges.min(-1).astype(np.int64) * n_vertices + edges.max(-1)


def _sides(keys: np.ndarray, chosen: np.ndarray) -> tuple[tuple, tuple]:
    """The two sides, as (triangles, corners) each, of the edges that are `chosen` (t, 3) and have two."""
    rows, corners = np.nonzero(chosen)
    order = np.argsort(keys[rows, corners], kind="stable")
    rows, corners = rows[order], corners[order]
    sorted_keys = keys[rows, corners]
    first = np.flatnonzero(sorted_keys[:-1] == sorted_keys[1:])
    return (rows[first], corners[first]), (rows[first + 1], corners[first + 1])


def _ends(triangles: np.ndarray, values: np.ndarray, side: tuple) -> tuple[np.ndarray, np.ndarray]:
    """Of values (t, 3, ...) at the triangles' corners: those at the two ends of an edge, the lower vertex first."""
    rows, corners = side
    ahead = (corners + 1) % 3
    start, end = values[rows, corners], values[rows, ahead]
    upward = triangles[rows, corners] < triangles[rows, ahead]
    upward = upward.reshape(upward.shape + (1,) * (start.ndim - 1))
    return np.where(upward, start, end), np.where(upward, end, start)
