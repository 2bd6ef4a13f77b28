# SPDX-License-Identifier: GPL-3.0-or-later
"""Which copies of a tile to show: 3 x 3 cells of the plane's lattice, the whole group on the sphere, three rings in
the hyperbolic plane; no bpy."""

from __future__ import annotations

from typing import Optional

import numpy as np

from . import group
from .core.charts import to_complex

CELLS = 3
GRID = 13  # points a side that stand for the cells
RINGS = 3
MOST = 2000  # copies
TOUCH = 1e-3  # of 1 - |z|^2: how near two corners are that are one


def copies_of(
    generators: np.ndarray, curvature: int, points: np.ndarray, corners: np.ndarray, euler: float,
    to_cells: Optional[np.ndarray],
) -> np.ndarray:
    """(g, 3, 3) elements of the group, the identity first, at most MOST: the tile has the points (n, 3) and, where
    tiles meet, the corners (k, 3); `to_cells` (3, 2) takes the plane's (x, y, 1) to the lattice's coordinates."""
    if not len(generators):
        return np.eye(3)[None]
    if curvature < 0:
        return _rings(generators, points, corners)
    of_tile = group.Group(generators, curvature, points)
    if curvature > 0:
        return of_tile.nearest(min(MOST, max(1, round(2 / euler))))
    return _cells(of_tile, to_cells)


def _cells(of_tile: group.Group, to_cells: np.ndarray) -> np.ndarray:
    """Those that move the tile's middle within CELLS x CELLS cells, of which its own is the one in the middle."""
    middle = of_tile.tile[0]
    home = np.floor(middle @ to_cells)
    steps = np.linspace(-(CELLS // 2), CELLS - CELLS // 2, GRID)
    grid = home + np.stack(np.meshgrid(steps, steps), -1).reshape(-1, 2)
    seen = np.column_stack([(grid - to_cells[2]) @ np.linalg.inv(to_cells[:2]), np.ones(len(grid))])
    gap = 1.5 * np.linalg.norm(seen[:, None] - seen, axis=-1)[0, 1 : GRID + 1].max()
    elements = of_tile.near(seen, gap)
    away = np.floor((elements @ middle) @ to_cells - home + 1e-9)
    elements = elements[(np.abs(away) <= CELLS // 2).all(1)]
    return elements[:MOST]


def _rings(generators: np.ndarray, points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """The tile, the copies that touch it, those that touch these, and so on; of too many those nearest to it. Whatever
    meets at a corner is reached by walking around that corner, so only through copies that touch the tile there."""
    moves = group.with_inverses(generators, -1)
    probes = group.probes_of(group.sample(points, -1)[0], -1)
    touching = fresh = np.eye(3)[None]
    while len(fresh):
        fresh = _new(touching, fresh, moves, probes)
        fresh = fresh[_touches(fresh, corners)]
        touching = np.concatenate([touching, fresh])
    known = fresh = np.eye(3)[None]
    for _ in range(RINGS):
        fresh = _new(known, fresh, touching, probes)[:MOST]
        known = np.concatenate([known, fresh])
    moved = group.distances(known @ probes[0], probes[:1], -1)[:, 0]
    moved[0] = -1.0
    return known[np.argsort(moved, kind="stable")[:MOST]]


def _new(known: np.ndarray, fresh: np.ndarray, moves: np.ndarray, probes: np.ndarray) -> np.ndarray:
    """Products of the fresh elements with the moves that are not known yet, those that move the tile least first."""
    products = (fresh[:, None] @ moves[None]).reshape(-1, 3, 3)
    both = np.concatenate([known, products])
    rows = (both @ probes.T).transpose(0, 2, 1).reshape(len(both), -1)
    step = np.linalg.norm((moves @ probes[0]) - probes[0], axis=1)
    kept = group.distinct(rows, 1e-3 * float(step[step > 1e-9].min()))
    products = products[kept[kept >= len(known)] - len(known)]
    return products[np.argsort((products @ probes[0])[:, 2], kind="stable")]


def _touches(elements: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """(g,) bool: whether an element brings one of the tile's corners to one of them."""
    at = to_complex(corners, -1)
    there = to_complex((elements @ corners.T).transpose(0, 2, 1), -1)
    return (np.abs(there[..., None] - at) <= TOUCH * (1 - np.abs(at) ** 2) + 1e-6).any((1, 2))
