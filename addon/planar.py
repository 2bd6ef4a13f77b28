# SPDX-License-Identifier: GPL-3.0-or-later
"""A triangle that segments run through -> the faces of that arrangement, and these put together; no bpy.

Points are whole numbers in the triangle's barycentric coordinates, so that which side of a line one is on is exact, and
points on one side of the triangle are on one line. Faces are lists of nodes, counter-clockwise.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Sequence

import numpy as np

ONE = 2**30  # products of differences fit into 64 bits

Edge = tuple[int, int]


def whole(barycentric: np.ndarray) -> np.ndarray:
    """(p, 2) int64 of barycentric coordinates (p, 3); what is on a side stays there."""
    points = np.rint(barycentric[:, 1:] * ONE).astype(np.int64)
    points[barycentric[:, 0] == 0, 1] = ONE - points[barycentric[:, 0] == 0, 0]
    return points


def _turn(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> np.ndarray:
    """Twice the area of the triangles a b c (..., 2), > 0 counter-clockwise."""
    ab, ac = b - a, c - a
    return ab[..., 0] * ac[..., 1] - ab[..., 1] * ac[..., 0]


def faces_of(
    points: np.ndarray, border: Sequence[int], segments: Iterable[Edge]
) -> tuple[list[list[int]], list[Edge]] | None:
    """The faces of a triangle whose border is these nodes in turn, numbers of points (p, 2), cut by segments between
    nodes, all of them of the border or a segment's end; and the edges that were added so that each face is one simple
    polygon: where a segment ends within the triangle. None where segments cross."""
    around = list(zip(border, [*border[1:], border[0]]))
    edges = {tuple(sorted(edge)) for edge in (*around, *segments)}
    found, added = _walk(points, edges, around), []
    if not _simple(found, edges):
        added = _triangulated(points, border, edges)
        found = _walk(points, edges | set(added), around)
    areas = [_area(points, face) for face in found]
    if not _simple(found, edges | set(added)) or sum(areas) != _area(points, border) or min(areas) <= 0:
        return None
    return found, added


def _area(points: np.ndarray, face: Sequence[int]) -> int:
    at = [tuple(map(int, points[node])) for node in face]
    return sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(at, [*at[1:], at[0]]))


def _simple(faces: Sequence[Sequence[int]], edges: set[Edge]) -> bool:
    """No face meets a node twice, and all edges are on faces."""
    met = {tuple(sorted(edge)) for face in faces for edge in zip(face, [*face[1:], face[0]])}
    return all(len(set(face)) == len(face) for face in faces) and met >= edges


def _walk(points: np.ndarray, edges: set[Edge], around: Sequence[Edge]) -> list[list[int]]:
    """The faces left of edges that can be reached from the border."""
    near: dict[int, list[int]] = {}
    for a, b in edges:
        near.setdefault(a, []).append(b)
        near.setdefault(b, []).append(a)
    before: dict[Edge, int] = {}  # (node, neighbour) -> the next neighbour clockwise
    for node, others in near.items():
        away = points[others] - points[node]
        turned = [others[k] for k in np.argsort(np.arctan2(away[:, 1], away[:, 0]), kind="stable").tolist()]
        before.update({(node, other): turned[k - 1] for k, other in enumerate(turned)})
    done = {(b, a) for a, b in around}  # of the face outside
    waiting, faces = list(around), []
    while waiting:
        start = waiting.pop()
        if start in done:
            continue
        face, edge = [], start
        while edge not in done:
            done.add(edge)
            face.append(edge[0])
            waiting.append(edge[::-1])
            edge = edge[1], before[edge[::-1]]
        faces.append(face)
    return faces


def _triangulated(points: np.ndarray, border: Sequence[int], edges: set[Edge]) -> list[Edge]:
    """Edges that make triangles of all faces: the shortest first that cross none. Few, as it looks at all pairs."""
    nodes = np.array(sorted({node for edge in edges for node in edge}))
    first, second = (nodes[k] for k in np.triu_indices(len(nodes), 1))
    order = np.argsort(((points[first] - points[second]).astype(float) ** 2).sum(1), kind="stable")
    ends = np.array(sorted(edges))
    added: list[Edge] = []
    wanted = 3 * len(nodes) - 3 - len(border)
    for a, b in zip(first[order].tolist(), second[order].tolist()):
        if len(ends) == wanted:
            break
        if (a, b) in edges or _blocked(points, a, b, nodes, ends):
            continue
        added.append((a, b))
        ends = np.concatenate([ends, [(a, b)]])
    return added


def _blocked(points: np.ndarray, a: int, b: int, nodes: np.ndarray, ends: np.ndarray) -> bool:
    """Whether the segment from a to b meets another node or crosses an edge."""
    p, q, others = points[a], points[b], points[nodes]
    along = ((others - p) * (q - p)).sum(1) > 0
    along &= ((others - q) * (p - q)).sum(1) > 0
    if (along & (_turn(p, q, others) == 0)).any():
        return True
    r, s = points[ends[:, 0]], points[ends[:, 1]]
    apart = np.sign(_turn(p, q, r)) * np.sign(_turn(p, q, s)) < 0
    return bool((apart & (np.sign(_turn(r, s, p)) * np.sign(_turn(r, s, q)) < 0)).any())


def merged(faces: Sequence[Sequence[tuple[int, Hashable]]], spare: Iterable[Edge]) -> list[list[tuple[int, Hashable]]]:
    """Faces, whose corners are (node, anything), across spare edges put together where the result is a simple polygon.
    A corner keeps what belongs to the edge that begins with it."""
    faces = {number: list(face) for number, face in enumerate(faces)}
    left = {(one[0], other[0]): number for number, face in faces.items()
            for one, other in zip(face, [*face[1:], face[0]])}
    for a, b in spare:
        one, other = left.get((a, b)), left.get((b, a))
        if one is None or other is None or one == other:
            continue
        kept, gone = (_from(faces[number], node) for number, node in ((one, b), (other, a)))
        whole_loop = [*kept[:-1], *gone[:-1]]  # b ... a is left with, then a ... b
        if len({node for node, _ in whole_loop}) < len(whole_loop):
            continue
        faces[one] = whole_loop
        del faces[other], left[a, b], left[b, a]
        left.update({(x[0], y[0]): one for x, y in zip(gone[:-1], gone[1:])})
    return list(faces.values())


def _from(face: Sequence[tuple[int, Hashable]], node: int) -> list[tuple[int, Hashable]]:
    """Turned so that it begins with this node."""
    at = next(k for k, corner in enumerate(face) if corner[0] == node)
    return [*face[at:], *face[:at]]
