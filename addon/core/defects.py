# SPDX-License-Identifier: GPL-3.0-or-later
"""What is wrong with a mesh, all of it at once and with every element; the library names the first fault and sixteen
elements of it. It stays the judge: where it refuses a mesh in which nothing is found here, that is a finding too."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from . import topology
from .arrays import mesh_of
from .embed import embed
from .errors import OrbifoldError

# kind -> (one, several) in words, and what its elements are
KINDS = {
    "not_finite": ("vertex whose coordinates are no numbers", "vertices whose coordinates are no numbers", "vertex"),
    "repeated_corner": ("face that names a vertex twice", "faces that name a vertex twice", "face"),
    "repeated_face": ("face on the same vertices as another", "faces on the same vertices as another", "face"),
    "zero_area": ("zero-area face", "zero-area faces", "face"),
    "edge": ("non-manifold edge", "non-manifold edges", "edge"),
    "vertex": ("non-manifold vertex", "non-manifold vertices", "vertex"),
    "flipped": ("flipped face", "flipped faces", "face"),
    "double": ("border vertex at the place of another", "border vertices at the place of another", "vertex"),
    "boundary": ("boundary loop", "boundary loops", "edge"),
    "pieces": ("component", "components", "face"),
    "isolated": ("isolated vertex", "isolated vertices", "vertex"),
    "other": ("further fault", "further faults", "vertex"),
}
# Those that some orbifold or other way of working allows: borders can be mirrors, isolated vertices do not count.
TOLERATED = ("double", "boundary", "pieces", "isolated")
FLAT = 1e-7  # twice the area of a triangle by the square of its longest side: what 32-bit coordinates leave of none
NEAR = 1e-6  # of the mesh's diameter: vertices at one place
MESH_FAULTS = (
    "ORB_NON_FINITE", "ORB_DEGENERATE_TRIANGLE", "ORB_REPEATED_TRIANGLE", "ORB_NON_MANIFOLD_EDGE",
    "ORB_NON_MANIFOLD_VERTEX", "ORB_INCONSISTENT_ORIENTATION", "ORB_SEVERAL_COMPONENTS",
)


@dataclass(frozen=True, eq=False)
class Defect:
    kind: str  # of KINDS
    count: int
    elements: np.ndarray  # vertices or faces (k,), edges as pairs of vertices (k, 2)
    message: str = ""  # of the library, where the kind is "other"

    @property
    def element(self) -> str:
        """What `elements` counts: "vertex", "edge" (pairs of vertices) or "face"."""
        return KINDS[self.kind][2]

    @property
    def blocks(self) -> bool:
        """Whether no orbifold at all can be had while it is there."""
        return self.kind not in TOLERATED

    @property
    def text(self) -> str:
        """ "2 non-manifold edges"; without a full stop."""
        if self.message:
            return self.message.rstrip(".")
        return f"{self.count} {KINDS[self.kind][0 if self.count == 1 else 1]}"


def find_defects(
    vertices: np.ndarray, corners: np.ndarray, sizes: np.ndarray, triangles: np.ndarray, faces: np.ndarray
) -> list[Defect]:
    """Of a mesh of polygons, in the sequence of KINDS: coordinates (n, 3); the polygons' corners (s,), one polygon
    after the other, and how many each has (f,); its triangles (m, 3) and the polygon of each (m,). Polygons that name
    a vertex twice, and all but the first on the same vertices, are left out of what is said of edges and fans."""
    points = np.asarray(vertices, np.float64).reshape(-1, 3)
    corners, sizes = np.asarray(corners, np.int64), np.asarray(sizes, np.int64)
    n, face = len(points), np.repeat(np.arange(len(sizes)), sizes)
    not_finite = np.flatnonzero(~np.isfinite(points).all(1))
    named_twice = _naming_twice(corners, face)
    copies = _copies(corners, face, sizes, named_twice)
    kept = np.ones(len(sizes), bool)
    kept[named_twice] = kept[copies] = False
    links = _Links(corners[kept[face]], face[kept[face]], sizes[kept], n)
    flat = np.unique(faces[_flat(points, triangles)]) if not len(not_finite) else np.zeros(0, np.int64)
    loops, border = links.loops()
    pieces, smaller = links.pieces(len(sizes))
    found = [
        Defect("not_finite", len(not_finite), not_finite),
        Defect("repeated_corner", len(named_twice), named_twice),
        Defect("repeated_face", len(copies), copies),
        _plain("zero_area", flat[kept[flat]]),
        _plain("edge", links.crowded()),
        _plain("vertex", links.pinched()),
        _plain("flipped", links.flipped(len(sizes))),
        _plain("double", _doubles(points, np.unique(border)) if not len(not_finite) else np.zeros(0, np.int64)),
        Defect("boundary", loops, border),
        Defect("pieces", pieces if pieces > 1 else 0, smaller),
        _plain("isolated", np.setdiff1d(np.arange(n), corners)),
    ]
    found = [defect for defect in found if defect.count]
    if not any(defect.blocks or defect.kind == "pieces" for defect in found):
        found += _judged(points, triangles)
    return found


def _plain(kind: str, elements: np.ndarray) -> Defect:
    return Defect(kind, len(elements), elements)


def _naming_twice(corners: np.ndarray, face: np.ndarray) -> np.ndarray:
    """(k,) faces."""
    order = np.lexsort((corners, face))
    v, f = corners[order], face[order]
    return np.unique(f[1:][(v[1:] == v[:-1]) & (f[1:] == f[:-1])])


def _copies(corners: np.ndarray, face: np.ndarray, sizes: np.ndarray, but: np.ndarray) -> np.ndarray:
    """(k,) faces on the same vertices as one before them; those of `but` do not count."""
    order = np.lexsort((corners, face))
    ordered, starts = corners[order], np.concatenate([[0], np.cumsum(sizes)[:-1]]).astype(np.int64)
    copies = []
    for size in np.unique(sizes):
        among = np.setdiff1d(np.flatnonzero(sizes == size), but)
        rows = ordered[starts[among][:, None] + np.arange(size)]
        _, first = np.unique(rows, axis=0, return_index=True)
        copies.append(np.delete(among, first))
    return np.sort(np.concatenate(copies)) if copies else np.zeros(0, np.int64)


def _flat(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(m,) bool."""
    p, q, r = points[triangles].transpose(1, 0, 2)
    longest = np.max([((q - p) ** 2).sum(1), ((r - q) ** 2).sum(1), ((p - r) ** 2).sum(1)], axis=0)
    return np.linalg.norm(np.cross(q - p, r - p), axis=1) <= FLAT * longest


def _doubles(points: np.ndarray, among: np.ndarray) -> np.ndarray:
    """(k,) vertices of `among` at the place of another of them. Two grids, of which one lies half a cell off the other:
    whatever a line of the one separates, the other keeps together."""
    cell = NEAR * float(np.linalg.norm(np.ptp(points, axis=0))) if len(points) else 0.0
    if not len(among) or cell == 0:
        return np.zeros(0, np.int64)
    shared = np.zeros(len(among), bool)
    for offset in (0.25, 0.75):
        cells = np.floor(points[among] / cell + offset)
        _, place, count = np.unique(cells, axis=0, return_inverse=True, return_counts=True)
        shared |= (count > 1)[place.ravel()]
    return among[shared]


class _Links:
    """Which corners of faces lie beside which: half-edge c runs from corner c to the next one of its face."""

    def __init__(self, corners: np.ndarray, face: np.ndarray, sizes: np.ndarray, n: int) -> None:
        self.corners, self.face, self.n = corners, face, n
        starts = np.concatenate([[0], np.cumsum(sizes)[:-1]]).astype(np.int64)
        self.after = np.arange(len(corners)) + 1
        self.after[starts + sizes - 1] = starts
        ends = corners[self.after]
        keys = np.minimum(corners, ends) * n + np.maximum(corners, ends)
        self.order = np.argsort(keys, kind="stable")
        ordered = keys[self.order]
        self.first = np.flatnonzero(np.concatenate([[True], ordered[1:] != ordered[:-1]])) if len(keys) else self.order
        self.count = np.diff(np.concatenate([self.first, [len(keys)]]))
        same = np.flatnonzero(ordered[1:] == ordered[:-1])
        self.one, self.other = self.order[same], self.order[same + 1]  # half-edges of one edge, next to one another
        self.keys = ordered[self.first]

    def _pairs(self, chosen: np.ndarray) -> np.ndarray:
        """(k, 2) the vertices of edges."""
        return np.stack([self.keys[chosen] // self.n, self.keys[chosen] % self.n], 1)

    def crowded(self) -> np.ndarray:
        """(k, 2) edges of more than two faces."""
        return self._pairs(self.count > 2)

    def pinched(self) -> np.ndarray:
        """(k,) vertices whose faces are more than one fan."""
        a, b = self.one, self.other
        alike = self.corners[a] == self.corners[b]
        start = np.concatenate([a, self.after[a]])
        end = np.concatenate([np.where(alike, b, self.after[b]), np.where(alike, self.after[b], b)])
        fan = topology.connected(len(self.corners), start, end)
        vertex = self.corners[np.unique(fan)]  # a fan is numbered by one of its corners
        return np.flatnonzero(np.bincount(vertex, minlength=self.n) > 1)

    def loops(self) -> tuple[int, np.ndarray]:
        """How many loops the edges of a single face make, and these edges (k, 2)."""
        border = self._pairs(self.count == 1)
        named, place = np.unique(border, return_inverse=True)
        place = place.reshape(-1, 2)
        root = topology.connected(len(named), place[:, 0], place[:, 1])
        return len(np.unique(root)), border

    def pieces(self, n_faces: int) -> tuple[int, np.ndarray]:
        """How many components there are, and the faces of all but the largest."""
        label = topology.connected(self.n, self.corners, self.corners[self.after])
        first = np.full(n_faces, -1)
        first[self.face] = label[self.corners]
        present = np.unique(self.face)
        found, place, count = np.unique(first[present], return_inverse=True, return_counts=True)
        if len(found) < 2:
            return len(found), np.zeros(0, np.int64)
        return len(found), present[place.ravel() != int(np.argmax(count))]

    def flipped(self, n_faces: int) -> np.ndarray:
        """(k,) the faces that look the other way than most of their component; none of one-sided ones."""
        m, pair = n_faces, self.count == 2
        a, b = self.order[self.first[pair]], self.order[self.first[pair] + 1]
        turn = np.where(self.corners[a] == self.corners[b], m, 0)
        one, other = self.face[a], self.face[b]
        root = topology.connected(
            2 * m, np.concatenate([one, one + m]), np.concatenate([other + turn, (other + m + turn) % (2 * m)])
        )
        front, back = root[:m], root[m:]
        label = np.minimum(front, back)
        minority = front != label
        total = np.bincount(label, minlength=2 * m)
        other_way = np.bincount(label[minority], minlength=2 * m)
        more = 2 * other_way[label] > total[label]
        present = np.zeros(m, bool)
        present[self.face] = True
        return np.flatnonzero(present & (front != back) & (minority != more))


def _judged(points: np.ndarray, triangles: np.ndarray) -> list[Defect]:
    """What the library says of the surface, before any computation: it is asked for one handle more than there are."""
    if not len(triangles):
        return []
    genus = topology.topology_of(triangles).genus
    try:
        embed(*mesh_of(points, triangles), "o" * (max(genus, 0) + 1 + (genus == 0)), holes="fill")
    except OrbifoldError as error:
        if error.status in MESH_FAULTS:
            there = np.asarray(error.elements, np.int64)
            named = triangles[there] if error.element == "triangle" else there
            return [Defect("other", max(error.found, 1), np.unique(named), str(error))]
    return []
