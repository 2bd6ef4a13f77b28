# SPDX-License-Identifier: GPL-3.0-or-later
"""The elements of an orbifold's group that move its tile to places near by; no bpy.

Points are three coordinates and isometries 3 x 3 matrices (docs/mathematics.md, section 1), the same for the three
geometries, reflections and glides included. The library's generators carry the tile to its neighbours, so that g s is
the neighbour of tile g across the side of s, and every tile near another is reached through tiles near by.
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


def near(generators: np.ndarray, curvature: int, tile: np.ndarray, seen: np.ndarray, reach: float) -> np.ndarray:
    """(g, 3, 3) the elements, the identity first, that carry one of the points `tile` (p, 3) to within `reach` of one
    of the points `seen`; at most about CAP of them."""
    known, probes = np.eye(3)[None], _probes(tile, curvature)
    places = probes.reshape(1, 9)
    moves = with_inverses(generators, curvature)
    steps = np.abs(_places(moves, probes) - places).max(1)
    moves, steps = moves[steps > 1e-9], steps[steps > 1e-9]
    start = 0
    for _ in range(LEVELS if len(moves) else 0):
        fresh = known[start:]
        if not len(fresh) or len(known) >= CAP:
            break
        start = len(known)
        products = (fresh[:, None] @ moves[None]).reshape(-1, 3, 3)
        both = np.concatenate([places, _places(products, probes)])
        new = distinct(both, 1e-3 * float(steps.min()))
        new = new[new >= start] - start
        products = products[new]
        products = products[_is_near(products, curvature, tile, seen, reach)]
        known = np.concatenate([known, products])
        places = np.concatenate([places, _places(products, probes)])
    return known


def nearest(generators: np.ndarray, curvature: int, tile: np.ndarray, limit: int) -> np.ndarray:
    """(g, 3, 3) the `limit` elements that move the middle of the tile least, the identity first; of a finite group
    perhaps all."""
    middle = on_model(tile.mean(0), curvature)[None]
    reach = float(distances(tile, middle, curvature).max())
    found = near(generators, curvature, tile, middle, reach)
    while True:
        moved = distances(found @ middle[0], middle, curvature)[:, 0]
        whole = curvature > 0 and reach > np.pi
        if (moved <= reach).sum() >= limit or whole or not len(generators) or len(found) >= CAP:
            return found[np.argsort(np.where(np.arange(len(found)), moved, -1.0), kind="stable")[:limit]]
        reach *= 1.25
        found = near(generators, curvature, tile, middle, reach)


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


def _is_near(elements: np.ndarray, curvature: int, tile: np.ndarray, seen: np.ndarray, reach: float) -> np.ndarray:
    """(g,) bool."""
    if curvature == 0:
        seen = seen - [0, 0, 1]  # with z = 0 the scalar product is that of the plane
    flat = seen * [1.0, 1.0, curvature]
    found = []
    for first in range(0, len(elements), CHUNK):
        images = elements[first : first + CHUNK] @ tile.T  # (g, 3, p)
        product = np.einsum("xk,gkp->gxp", flat, images)
        if curvature == 0:
            square = (images[:, :2] ** 2).sum(1)[:, None] + (seen[:, :2] ** 2).sum(1)[:, None] - 2 * product
            found.append(square.min((1, 2)) <= reach**2)
        elif curvature > 0:
            found.append(product.max((1, 2)) >= np.cos(min(reach, np.pi)) - 1e-12)
        else:
            found.append(-product.max((1, 2)) <= np.cosh(reach))
    return np.concatenate(found) if found else np.zeros(0, bool)


def _probes(tile: np.ndarray, curvature: int) -> np.ndarray:
    """(3, 3) points of the tile on no common line: where they go tells elements apart."""
    middle = on_model(tile.mean(0), curvature)
    far = tile[int(np.argmax(distances(tile, middle[None], curvature)))]
    aside = tile[int(np.argmax(np.abs(tile @ np.cross(middle, far))))]
    return np.stack([middle, far, aside])


def _places(elements: np.ndarray, probes: np.ndarray) -> np.ndarray:
    """(g, 9) images of the probes."""
    return (elements @ probes.T).transpose(0, 2, 1).reshape(-1, 9)
