# SPDX-License-Identifier: GPL-3.0-or-later
"""A target's faces cut where the source's UV maps are torn, so that none crosses a seam; arrays only, no bpy.

The torn edges' courses over the target (core.SurfaceMap.trace) are straight in each of its triangles. Their ends become
vertices: on the target's edges, within its faces, or those that are there. Faces are put together from the parts of
their triangles, so that what is cut stays as whole as it can. On a seam a corner's UV is that of the source's edge, on
the side that its piece is on: exactly, however fine the pieces are.
"""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass
from functools import cached_property
from typing import Optional

import numpy as np

from . import core, planar
from .correspondence import Correspondence, Spots, torn_edges
from .steps import Step

SNAP = 1e-6  # what is so near a corner or a side of a triangle, in barycentric coordinates, is on it
BESIDE = 1e-5  # how far beside a seam a corner that only touches it is looked up, in the size of its piece
STEP = 1000  # faces
PROBE = 0.01  # how far beside its edge a stretch's side is looked up, in the stretch's length


@dataclass(frozen=True)
class Piece:
    """A face, or what it is cut into: vertices in turn, new ones from the mesh's number of vertices on."""

    polygon: int
    vertices: list[int]


@dataclass(frozen=True, eq=False)
class SeamCut:
    """New vertices, and the pieces of all faces that have one or that a seam touches."""

    triangles: np.ndarray  # (k,) of the target, in which the new vertices are
    barycentric: np.ndarray  # (k, 3) there
    ends: np.ndarray  # (k, 2) the target's edge that each is on, -1 for those within a face
    factors: np.ndarray  # (k,) where on it, from the first end
    pieces: list[Piece]
    corners: Spots  # on the source, of the pieces' corners one after the other
    seams: np.ndarray  # (s, 2) vertices of the edges along seams
    crossing: np.ndarray  # faces that could not be cut

    @cached_property
    def cut_faces(self) -> int:
        """Faces that became several."""
        return int((np.unique([piece.polygon for piece in self.pieces], return_counts=True)[1] > 1).sum())

    @cached_property
    def cut_pieces(self) -> int:
        """What they became."""
        counts = np.unique([piece.polygon for piece in self.pieces], return_counts=True)[1]
        return int(counts[counts > 1].sum())


def cut_along(work: Correspondence, uv_maps: list[np.ndarray]) -> Generator[Step, None, SeamCut]:
    """Where any of these UV maps (loops, 2) of the source is torn. Raises OrbifoldError."""
    yield "seams", 0.0
    torn = [torn_edges(work.source.triangles, uv[work.source.loops]) for uv in uv_maps]
    torn = np.unique(np.concatenate([np.zeros((0, 2), int), *torn]), axis=0)
    cutting = _Cutting(work, torn, work.back.trace(torn[:, 0]))
    yield from cutting.faces()
    return cutting.result()


@dataclass(frozen=True)
class _Seam:
    """A part of a torn edge between two nodes, the lower one first; straight in a triangle or along its side."""

    triangle: int
    edge: int
    at: tuple[float, float]  # of both nodes along the edge
    own: bool  # the triangle of the source that the edge begins in is on the left of it, as the triangle sees it


class _Cutting:
    def __init__(self, work: Correspondence, torn: np.ndarray, trace: core.Trace) -> None:
        self.work, self.torn, self.target = work, torn, work.target
        self.n = len(self.target.vertices)
        known = trace.triangles >= 0
        self.edges, self.at = trace.edges[known], trace.at[known]
        self.over, self.ends = trace.triangles[known], trace.barycentric[known].copy()
        self._find_nodes()
        self._find_seams()

    # -------------------------------------------------------------------------------------------------- nodes

    def _find_nodes(self) -> None:
        """Each end of a stretch becomes a node: a vertex, or a new one from n on."""
        ends = self.ends.reshape(-1, 3)
        triangles = np.repeat(self.over, 2)
        corners = self.target.triangles[triangles].astype(np.int64)
        ends[ends < SNAP] = 0
        ends /= ends.sum(1, keepdims=True)
        node = np.where(ends.max(1) == 1, corners[np.arange(len(ends)), ends.argmax(1)], -1)
        sides = np.flatnonzero((node < 0) & (ends.min(1, initial=1.0) == 0))
        rows, facing = np.arange(len(sides)), ends[sides].argmin(1)
        pair = np.stack([(facing + 1) % 3, (facing + 2) % 3], 1)
        vertices, weights = corners[sides][rows[:, None], pair], ends[sides][rows[:, None], pair]
        turned = vertices[:, 0] > vertices[:, 1]
        vertices[turned], weights[turned] = vertices[turned, ::-1], weights[turned, ::-1]
        keys, factors = vertices[:, 0] * self.n + vertices[:, 1], weights[:, 1]
        order = np.lexsort([factors, keys])
        fresh = np.ones(len(order), bool)
        fresh[1:] = (np.diff(keys[order]) > 0) | (np.diff(factors[order]) > SNAP)
        numbers = np.cumsum(fresh) - 1
        node[sides[order]] = self.n + numbers
        first = order[fresh]
        within = np.flatnonzero(node < 0)
        alike = np.column_stack([triangles[within], ends[within, :2]])
        _, some, inverse = np.unique(alike, axis=0, return_index=True, return_inverse=True)
        node[within] = self.n + len(first) + inverse.ravel()
        chosen = np.concatenate([sides[first], within[some]])
        self.triangles, self.barycentric = triangles[chosen], ends[chosen]
        self.side_ends = np.full((len(chosen), 2), -1, np.int64)
        self.side_ends[: len(first)] = vertices[first]
        self.factors = np.zeros(len(chosen))
        self.factors[: len(first)] = factors[first]
        self.nodes = node.reshape(-1, 2)
        self.on_side: dict[tuple[int, int], list[int]] = {}  # by ascending factor, as they are numbered
        for number, side in enumerate(self.side_ends[: len(first)].tolist()):
            self.on_side.setdefault(tuple(side), []).append(self.n + number)

    def _side(self, a: int, b: int) -> list[int]:
        """The new nodes between two vertices, in turn."""
        between = self.on_side.get((min(a, b), max(a, b)), [])
        return between if a < b else between[::-1]

    def _place(self, node: int, triangle: int) -> list[float]:
        """Barycentric coordinates in a triangle that it is in."""
        corners = self.target.triangles[triangle].tolist()
        if node < self.n:
            return [float(corner == node) for corner in corners]
        low, high = self.side_ends[node - self.n].tolist()
        if low < 0:
            return self.barycentric[node - self.n].tolist()
        factor = self.factors[node - self.n]
        return [1 - factor if corner == low else factor if corner == high else 0.0 for corner in corners]

    # -------------------------------------------------------------------------------------------------- seams

    def _find_seams(self) -> None:
        """`seams` by their nodes, the lower one first; `through`: those within each triangle."""
        own = self._sides_of_stretches()
        self.seams: dict[planar.Edge, _Seam] = {}
        self.through: dict[int, list[planar.Edge]] = {}
        for k, (a, b) in enumerate(self.nodes.tolist()):
            triangle = int(self.over[k])
            if a == b:
                continue
            side = self._common_side(a, b, triangle)
            parts = [a, b]
            if side is not None:
                line = [side[0], *self._side(*side), side[1]]
                i, j = line.index(a), line.index(b)
                parts = line[i : j + 1] if i < j else line[j : i + 1][::-1]
            steps = np.linspace(*self.at[k], len(parts)).tolist()
            for p, q, s, t in zip(parts, parts[1:], steps, steps[1:]):
                forward = p < q
                key = (p, q) if forward else (q, p)
                if key in self.seams:
                    continue
                at = (s, t) if forward else (t, s)
                self.seams[key] = _Seam(triangle, int(self.edges[k]), at, bool(own[k]) == forward)
                if side is None:
                    self.through.setdefault(triangle, []).append(key)

    def _common_side(self, a: int, b: int, triangle: int) -> Optional[tuple[int, int]]:
        corners = self.target.triangles[triangle].tolist()
        places = [self._place(node, triangle) for node in (a, b)]
        for c in range(3):
            if places[0][c] == places[1][c] == 0:
                return corners[(c + 1) % 3], corners[(c + 2) % 3]
        return None

    def _sides_of_stretches(self) -> np.ndarray:
        """(s,) whether the source's triangle that the edge begins in is on the left of the stretch, in the target's
        triangle: where a point of it beside the stretch goes; where that is too far away, as for most."""
        corner, long = self.torn[self.edges, 0], np.ptp(self.at, axis=1)
        middle, beside = self.at.mean(1), PROBE * long
        weights, rows = np.zeros((len(corner), 3)), np.arange(len(corner))
        weights[rows, corner % 3] = (1 - middle) * (1 - beside)
        weights[rows, (corner + 1) % 3] = middle * (1 - beside)
        weights[rows, (corner + 2) % 3] = beside
        there, where = self.work.back.evaluate(corner // 3, weights)
        left = np.sign(np.linalg.det(np.stack([self.ends[:, 0], self.ends[:, 1], where], 1)))
        left[there != self.over] = 0
        return np.where(left == 0, left.sum() > 0, left > 0)

    # ------------------------------------------------------------------------------------------------- pieces

    def faces(self) -> Generator[Step, None, None]:
        """Cuts all that are touched."""
        self._rows: list[tuple[int, list[float]]] = []  # of all pieces' corners: a triangle and weights of the source,
        self._asked: list[int] = []  # or of the target, for these rows
        self._pieces: list[Piece] = []
        self._crossing: list[int] = []
        groups = self._touched()
        for number, group in enumerate(groups):
            if number % STEP == 0:
                yield "seams", number / len(groups)
            pieces, whole = self._faces(group.tolist())
            polygon = int(self.target.polygons[group[0]])
            if not whole:
                self._crossing.append(polygon)
            for piece in pieces:
                self._pieces.append(Piece(polygon, [node for node, _ in piece]))
                self._locate(piece)

    def _touched(self) -> list[np.ndarray]:
        """The triangles of each face that a seam runs through or touches."""
        met = np.zeros(self.n + len(self.triangles), bool)
        met[self.nodes] = True
        touched = met[self.target.triangles].any(1)
        touched[self.over] = True
        ends = np.sort(np.stack([self.target.triangles, np.roll(self.target.triangles, -1, 1)], 2), axis=2)
        sides = np.array([low * self.n + high for low, high in self.on_side], np.int64)
        touched |= np.isin(ends[:, :, 0].astype(np.int64) * self.n + ends[:, :, 1], sides).any(1)
        of = self.target.polygons
        order = np.flatnonzero(np.isin(of, of[touched]))
        order = order[np.argsort(of[order], kind="stable")]
        return np.split(order, np.flatnonzero(np.diff(of[order])) + 1) if len(order) else []

    def result(self) -> SeamCut:
        """After `faces`."""
        drawn = {
            tuple(sorted(edge)) for piece in self._pieces
            for edge in zip(piece.vertices, [*piece.vertices[1:], piece.vertices[0]])
        }
        seams = np.array([key for key in self.seams if key in drawn], np.int64).reshape(-1, 2)
        return SeamCut(
            *(self.triangles, self.barycentric, self.side_ends, self.factors, self._pieces, self._spots(), seams),
            np.array(self._crossing, int),
        )

    def _faces(self, triangles: list[int]) -> tuple[list[list[tuple[int, tuple]]], bool]:
        """The pieces of one face, each corner with the triangle that the edge after it is in and the directions of both
        edges there; and whether it could be cut."""
        faces, spare, within = [], [], set()
        for triangle in triangles:
            found = self._triangle(triangle)
            if found is None:  # as if no seam were in it
                return self._uncut(triangles), False
            faces += found[0]
            spare += found[1]
        for triangle in triangles:
            a, b, c = self.target.triangles[triangle].tolist()
            for p, q in ((a, b), (b, c), (c, a)):
                line = [p, *self._side(p, q), q]
                for edge in zip(line, line[1:]):
                    edge = tuple(sorted(edge))
                    if edge in within and edge not in self.seams:
                        spare.append(edge)
                    within.add(edge)
        return planar.merged(faces, spare), True

    def _uncut(self, triangles: list[int]) -> list[list[tuple[int, tuple]]]:
        faces, met, spare = [], set(), []
        for triangle in triangles:
            border = self._border(triangle)
            faces.append(self._corners(triangle, border))
            for edge in zip(border, [*border[1:], border[0]]):
                edge = tuple(sorted(edge))
                if edge in met:
                    spare.append(edge)
                met.add(edge)
        return planar.merged(faces, spare)

    def _border(self, triangle: int) -> list[int]:
        a, b, c = self.target.triangles[triangle].tolist()
        return [a, *self._side(a, b), b, *self._side(b, c), c, *self._side(c, a)]

    def _triangle(self, triangle: int) -> Optional[tuple[list[list[tuple[int, tuple]]], list[planar.Edge]]]:
        """The faces of a triangle, and the edges between them that are no seams; None where it cannot be cut."""
        border, through = self._border(triangle), self.through.get(triangle, [])
        if not through:
            return [self._corners(triangle, border)], []
        nodes = list(dict.fromkeys([*border, *(node for edge in through for node in edge)]))
        number = {node: k for k, node in enumerate(nodes)}
        points = planar.whole(np.array([self._place(node, triangle) for node in nodes]))
        found = planar.faces_of(
            points, [number[node] for node in border], [(number[a], number[b]) for a, b in through]
        )
        if found is None:
            return None
        faces = [self._corners(triangle, [nodes[k] for k in face]) for face in found[0]]
        return faces, [tuple(sorted((nodes[a], nodes[b]))) for a, b in found[1]]

    def _corners(self, triangle: int, face: list[int]) -> list[tuple[int, tuple]]:
        return [(node, (triangle, face[k - 1], face[(k + 1) % len(face)])) for k, node in enumerate(face)]

    # ------------------------------------------------------------------------------------------------- corners

    def _locate(self, face: list[tuple[int, tuple]]) -> None:
        """Where each corner of a piece is on the source: on the piece's side of the seam that it is on."""
        for (last, behind), (node, here), (after, _) in zip([face[-1], *face[:-1]], face, [*face[1:], face[0]]):
            found = self._beside(node, after, here[0], node) or self._beside(last, node, behind[0], node)
            if found is None:
                self._asked.append(len(self._rows))
                found = here[0], self._inside(node, *here)
            self._rows.append(found)

    def _beside(self, p: int, q: int, triangle: int, node: int) -> Optional[tuple[int, list[float]]]:
        """On the source's edge that a seam from p to q is a part of, in its triangle to the left."""
        seam = self.seams.get((p, q) if p < q else (q, p))
        if seam is None:
            return None
        forward = p < q
        own = seam.own == forward
        if seam.triangle != triangle:  # across a side of that
            border = self._border(seam.triangle)
            along = border[(border.index(min(p, q)) + 1) % len(border)] == max(p, q)
            own = seam.own != along
        corner, other = self.torn[seam.edge].tolist()
        at = seam.at[0] if node == min(p, q) else seam.at[1]
        corners = self.work.source.triangles.ravel()
        start, chosen = corners[corner], corner if own else other
        following = chosen - 2 if chosen % 3 == 2 else chosen + 1
        weights = [0.0, 0.0, 0.0]
        first = corners[chosen] == start
        weights[chosen % 3], weights[following % 3] = (1 - at, at) if first else (at, 1 - at)
        return chosen // 3, weights

    def _inside(self, node: int, triangle: int, last: int, after: int) -> list[float]:
        """Barycentric coordinates a little within the corner; exactly at it where no seam is."""
        place = np.array(self._place(node, triangle))
        if node not in self._on_seams:
            return place.tolist()
        one, other = (np.array(self._place(end, triangle)) - place for end in (after, last))
        lengths = np.linalg.norm(one), np.linalg.norm(other)
        turn = one[1] * other[2] - one[2] * other[1]
        way = one / lengths[0] + other / lengths[1]
        if abs(turn) <= 1e-9 * lengths[0] * lengths[1]:  # straight on: to the left
            x, y = one[1:] / lengths[0]
            way = np.array([y - x, -y, x])
        elif turn < 0:
            way = -way
        return (place + BESIDE * min(lengths) * way).tolist()

    @cached_property
    def _on_seams(self) -> set[int]:
        return {node for edge in self.seams for node in edge}

    def _spots(self) -> Spots:
        triangles = np.array([row[0] for row in self._rows], np.int32)
        barycentric = np.array([row[1] for row in self._rows]).reshape(-1, 3)
        asked = np.array(self._asked, int)
        weights = np.maximum(barycentric[asked], 0)
        weights /= weights.sum(1, keepdims=True)
        triangles[asked], barycentric[asked] = self.work.map.evaluate(triangles[asked], weights)
        return Spots(triangles, barycentric)
