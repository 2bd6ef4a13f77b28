# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes embedded for maps, and random landmarks on the shared meshes with a map for each: what is wrong, if any."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import picks
from conway import features
from families import EUCLIDEAN, HYPERBOLIC, SPHERICAL
from meshes import far_apart

import core

# How often each is taken: the large ones rarely, for the time that they take.
SPHERES = {
    "spot.obj": 50, "fandisk.off": 15, "bunny.obj": 15, "halftunnel.off": 10, "david.obj": 3, "head_max.off": 2,
    "head_julius.off": 2, "armadillo.obj": 2, "nefertiti.obj": 1,
}
DISKS = {"hemisphere.obj": 70, "lion.off": 20, "camelhead.off": 10}
ON_SPHERES = [
    *["442", "333", "632", "432", "532", "332", "225", "237", "334", "55"], *("2" * n for n in (4, 5, 7, 12, 20, 50))
]
ON_DISKS = [name for name in [*SPHERICAL, *EUCLIDEAN, *HYPERBOLIC] if features(name).topology == (0, 0, 1)]
WEIGHTS = ("cotan", "conformal", "uniform", "mean-value")


def embedded(mesh, signature, picked, **settings):
    return core.embed(*mesh, signature, picked, cut="path", **settings)


def there_and_back(a, b):
    """The farthest that a vertex of a comes to lie from itself, relative to the mesh's size."""
    back = core.SurfaceMap(b, a).evaluate(*core.SurfaceMap(a, b).spots)
    vertices = a.vertices[: a.n_input_vertices]
    moved = np.abs(core.interpolated(a, vertices, *back) - vertices)
    return np.nanmax(moved) / np.ptp(vertices)  # what lies in a hole of b does not come back


def corresponding(mesh, other, picked):
    """Vertices of another mesh that are where these are once both fill the same box."""
    a, b = ((v - v.min(0)) / np.ptp(v, axis=0) for v in (mesh[0], other[0]))
    free, found = list(np.unique(other[1])), []
    for vertex in picked:
        found.append(free.pop(int(((b[free] - a[vertex]) ** 2).sum(1).argmin())))
    return np.array(found)


def landmarks(random, mesh, signature):
    """Spread out in the sequence of a short walk, or anywhere and in any sequence."""
    described = features(signature)
    if described.topology != (0, 0, 0):
        return picks.picks_for(*mesh, described, start=random.random())
    vertices, count = np.unique(mesh[1]), len(described.cones)
    if random.random() < 0.4 and count < 13:
        return random.choice(vertices, count, replace=False)
    picked = far_apart(mesh[0], random.choice(vertices, 4 * count, replace=False), count)
    return picked[core.landmark_sequence(*mesh, picked)] if count > 3 else picked


def drawn(random, names: dict[str, int]) -> str:
    odds = np.array(list(names.values()), float)
    return str(random.choice(list(names), p=odds / odds.sum()))


def trials(random, number: int, read: Callable[[str], tuple]) -> Iterator[str | None]:
    """For each of so many random landmark sets, on meshes that `read` reads by their names: None, or what is wrong with
    the embedding, or with its map to the one before with the same signature and back."""
    last = {}
    for _ in range(number):
        disk = random.random() < 0.3
        signature = str(random.choice(ON_DISKS if disk else ON_SPHERES))
        name, weights = drawn(random, DISKS if disk else SPHERES), str(random.choice(WEIGHTS))
        mesh = read(name)
        picked = landmarks(random, mesh, signature)
        what = f"{signature} on {name}, {weights}, landmarks {np.asarray(picked).tolist()}"
        try:
            result = embedded(mesh, signature, picked, weights=weights, holes="fill")
            other, last[signature] = last.get(signature, result), result
            off, distortion = there_and_back(result, other), core.SurfaceMap(result, other).distortion
        except core.OrbifoldError as error:
            yield f"{what}: {error.status} {error}"
            continue
        # Where angles are distorted much, so is rounding.
        fine = off < 1e-12 * max(1, distortion.quasi_conformal_max) ** 1.5 + 1e-9 and distortion.flipped == 0
        yield None if fine else f"{what}: {off:.1e} off, {distortion.flipped} flipped"
