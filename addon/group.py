# SPDX-License-Identifier: GPL-3.0-or-later
"""The elements of an orbifold's group that move its tile to places near by; no bpy.

Points are three coordinates and isometries 3 x 3 matrices (docs/mathematics.md, section 1), the same for the three
geometries, reflections and glides included. The library's generators carry the tile to its neighbours, so that g s is
the neighbour of tile g across the side of s, and every tile near another is reached through tiles near by.

A tile of the hyperbolic plane may have long thin spikes, so that very many reach into any neighbourhood. There the
tile's middle c stands for it: every point of the plane has an image of c within `radius`, so that every image of c
near by is reached in steps of at most twice that.
"""

from __future__ import annotations

import numpy as np

SAMPLES = 64  # points that stand for a tile
CANDIDATES = 20000  # of the layout's points, from which they are chosen
CAP = 40000  # elements at most
LEVELS = 200  # of neighbours of neighbours
CHUNK = 256
HASH = np.random.default_rng(1).integers(-(2**62), 2**62, 9)  # products wrap around, which is what a hash wants


def sample(points: np.ndarray, curvature: int, count: int = SAMPLES) -> tuple[np.ndarray, float]:
    """At most `count` of the points (n, 3), each the farthest from all before it, and how far from them the others
    are at most. The first one is the nearest to the points' middle."""
    points = points[:: max(1, len(points) // CANDIDATES)]
    at = int(np.argmin(distances(points, on_model(points.mean(0), curvature)[None], curvature)))
    gap = np.full(len(points), np.inf)
    chosen = []
    while True:
        chosen.append(at)
        gap = np.minimum(gap, distances(points, points[at][None], curvature)[:, 0])
        at = int(np.argmax(gap))
        if len(chosen) == count or gap[at] < 1e-9:
            return points[chosen], float(gap[at])


class Group:
    """Of a tile whose triangles have the corners `points` (n, 3)."""

    def __init__(self, generators: np.ndarray, curvature: int, points: np.ndarray) -> None:
        self.curvature = curvature
        self.tile, self.gap = sample(points, curvature)  # no point of the tile is farther than gap from these
        self.radius = self.gap
        self._probes = probes_of(self.tile, curvature)
        self._centres, self._moves = self.tile, with_inverses(generators, curvature)
        self._around = np.eye(3)[None]
        if curvature < 0 and len(generators):
            self._step_between_middles()

    def _step_between_middles(self) -> None:
        middle = self.tile[:1]
        neighbours = self._grow(self.tile, np.full(len(self.tile), self.gap))
        to_middle = distances(self.tile, neighbours @ middle[0], self.curvature).min(1)
        self.radius = float(to_middle.max()) + self.gap
        self._around = self._grow(middle, np.array([2 * self.radius + self.gap]))
        steps = distances(self._around @ middle[0], middle, self.curvature)[:, 0]
        self._moves, self._centres = self._around[steps <= 2 * self.radius + 1e-6], middle

    def near(self, seen: np.ndarray, reach: float | np.ndarray) -> np.ndarray:
        """(g, 3, 3) elements, the identity first, at most about CAP. All images that `representative` of a point has
        within `reach` of one of the points `seen` (s, 3), each with its own or all with the same, come from them."""
        return self._grow(seen, np.broadcast_to(reach, len(seen)) + self.radius)

    def representative(self, point: np.ndarray) -> np.ndarray:
        """The image of a point of the tile that is nearest to its middle, or in the sphere and the plane the point."""
        images = self._around @ point
        return images[int(np.argmin(distances(images, self.tile[:1], self.curvature)))]

    def nearest(self, limit: int) -> np.ndarray:
        """(g, 3, 3) the `limit` elements that move the middle of the tile least, the identity first; of a finite group
        perhaps all."""
        middle = self.tile[:1]
        reach = float(distances(self.tile, middle, self.curvature).max())
        while True:
            found = self.near(middle, reach)
            moved = distances(found @ middle[0], middle, self.curvature)[:, 0]
            whole = self.curvature > 0 and reach > np.pi
            if (moved <= reach).sum() >= limit or whole or not len(self._moves) or len(found) >= CAP:
                moved[0] = -1.0
                return found[np.argsort(moved, kind="stable")[:limit]]
            reach *= 1.25

    def _grow(self, seen: np.ndarray, reach: np.ndarray) -> np.ndarray:
        """The elements that carry one of the centres to within reach of what is seen, each from one before it."""
        known = fresh = np.eye(3)[None]
        places = self._probes.reshape(1, 9)
        steps = np.abs(_places(self._moves, self._probes) - places).max(1)
        moves, steps = self._moves[steps > 1e-9], steps[steps > 1e-9]
        for _ in range(LEVELS if len(moves) else 0):
            if not len(fresh) or len(known) >= CAP:
                break
            products = (fresh[:, None] @ moves[None]).reshape(-1, 3, 3)
            both = np.concatenate([places, _places(products, self._probes)])
            new = distinct(both, 1e-3 * float(steps.min()))
            new = new[new >= len(places)]
            products = products[new - len(places)]
            places = both[np.concatenate([np.arange(len(places)), new])]
            fresh = products[_is_near(products, self.curvature, self._centres, seen, reach)]
            known = np.concatenate([known, fresh])
        return known


def with_inverses(generators: np.ndarray, curvature: int) -> np.ndarray:
    if not len(generators):
        return generators.reshape(0, 3, 3)
    if curvature == 0:
        inverses = np.linalg.inv(generators)
    else:
        form = np.array([1.0, 1.0, curvature])
        inverses = form[:, None] * generators.transpose(0, 2, 1) * form
    return np.concatenate([generators, inverses])


def distinct(rows: np.ndarray, cell: float) -> np.ndarray:
    """Indices, ascending, of the first of all rows (n, w) that agree to a small part of `cell`. Two grids, of which
    one lies half a cell off the other: whatever a line of the one separates, the other keeps together."""
    kept = np.arange(len(rows))
    for offset in (0.25, 0.75):
        cells = np.floor(rows[kept] / cell + offset).astype(np.int64)
        keys = (cells * HASH[: cells.shape[1]]).sum(1)
        kept = np.sort(kept[np.unique(keys, return_index=True)[1]])
    return kept


def on_model(point: np.ndarray, curvature: int) -> np.ndarray:
    """(..., 3) scaled onto the plane, the sphere, the hyperboloid."""
    if curvature == 0:
        return point / point[..., 2:]
    square = point[..., 0] ** 2 + point[..., 1] ** 2 + curvature * point[..., 2] ** 2
    return point / np.sqrt(np.abs(square))[..., None]


def distances(points: np.ndarray, others: np.ndarray, curvature: int) -> np.ndarray:
    """(k, l) in the geometry, from the chords, which keep their digits for near points."""
    difference = points[:, None, :] - others[None, :, :]
    square = difference[..., 0] ** 2 + difference[..., 1] ** 2 + curvature * difference[..., 2] ** 2
    chord = np.sqrt(np.maximum(square, 0.0))
    if curvature == 0:
        return chord
    return 2 * (np.arcsin(np.minimum(chord / 2, 1.0)) if curvature > 0 else np.arcsinh(chord / 2))


def _is_near(
    elements: np.ndarray, curvature: int, tile: np.ndarray, seen: np.ndarray, reach: np.ndarray
) -> np.ndarray:
    """(g,) bool: whether an element carries one of the points `tile` to within its reach (s,) of a point `seen`."""
    reach = reach[:, None]
    if curvature == 0:
        seen = seen - [0, 0, 1]  # with z = 0 the scalar product is that of the plane
    flat = seen * [1.0, 1.0, curvature]
    found = np.zeros(len(elements), bool)
    for first in range(0, len(elements), CHUNK):
        images = (elements[first : first + CHUNK] @ tile.T).transpose(1, 0, 2)  # (3, g, p)
        product = flat @ images.reshape(3, -1)  # (s, g * p)
        if curvature == 0:
            square = (images[:2] ** 2).sum(0).ravel() + (seen[:, :2] ** 2).sum(1)[:, None]
            close = square - 2 * product <= reach**2
        elif curvature > 0:
            close = product >= np.cos(np.minimum(reach, np.pi)) - 1e-12
        else:
            close = product >= -np.cosh(reach)
        found[first : first + CHUNK] = close.any(0).reshape(-1, len(tile)).any(1)
    return found


def probes_of(tile: np.ndarray, curvature: int) -> np.ndarray:
    """(3, 3) points of the tile on no common line: where they go tells elements apart."""
    middle = on_model(tile.mean(0), curvature)
    far = tile[int(np.argmax(distances(tile, middle[None], curvature)))]
    aside = tile[int(np.argmax(np.abs(tile @ np.cross(middle, far))))]
    return np.stack([middle, far, aside])


def _places(elements: np.ndarray, probes: np.ndarray) -> np.ndarray:
    """(g, 9) images of the probes."""
    return (elements @ probes.T).transpose(0, 2, 1).reshape(-1, 9)
