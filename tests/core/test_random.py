# SPDX-License-Identifier: GPL-3.0-or-later
"""Random orbifolds on random coarse surfaces with random picks, where the cut hardly finds its way: judged, or refused
for a reason that is one of the orbifold's or of the picks'."""

import numpy as np
import pytest
import shapes
from conway import features
from judged import verdict
from meshes import icosphere
from picks import boundary_loops
from topology import topology_of

import core

SURFACES = [
    lambda n: icosphere(n // 2),
    lambda n: shapes.disk(1 + n),
    lambda n: shapes.annulus(4 + n, n),
    lambda n: shapes.moebius_band(5 + n, n),
    lambda n: shapes.klein_figure_eight(5 + n, 4 + n),
    lambda n: shapes.torus(4 + n, 5 + n),
    lambda n: shapes.boy_surface(1 + n // 2),
    lambda n: shapes.pretzel(n, 1 + n // 2),
    lambda n: shapes.plate(n - 1, 4 - n),
]
REFUSALS = {"ORB_BAD_ORBIFOLD", "ORB_UNSUPPORTED_SIGNATURE"}  # MN, or one that is too round to be rigid


def written(orders):
    return core.format_signature([int(n) for n in orders])


def random_case(random):
    """(mesh, signature, picks)"""
    make = SURFACES[random.integers(len(SURFACES))]
    mesh = shapes.roughened(make(int(random.integers(1, 4))), int(random.integers(1000)), flips=0.3)
    found, loops = topology_of(mesh[1]), boundary_loops(mesh[1])
    missing = 2 - found.euler - found.loops
    free = np.setdiff1d(mesh[1], [v for loop in loops for v in loop])
    picks = random.choice(free, min(len(free), int(random.integers(5))), replace=False).tolist()
    signature = "o" * (missing // 2) * found.orientable + written(random.choice([2, 2, 3, 4, 5, 11], len(picks)))
    for loop in loops:
        places = np.sort(random.choice(len(loop), min(len(loop), int(random.integers(5))), replace=False))
        corners = [loop[at] for at in (places if random.random() < 0.5 else places[::-1])]
        signature += "*" + written(random.choice([2, 2, 3, 4, 11], len(corners)))
        picks += corners
    return mesh, signature + "x" * missing * (not found.orientable), picks


@pytest.mark.parametrize("seed", range(12))
def test_random_orbifolds(seed, tmp_path):
    random = np.random.default_rng(seed)
    for _ in range(15):
        mesh, signature, picks = random_case(random)
        if not signature:
            continue
        try:
            result = core.embed(*mesh, signature, picks, weights="cotan")
        except core.OrbifoldError as error:
            near = error.status == "ORB_BAD_CONE" and "neighbours" in str(error)  # opposite poles on one edge
            assert error.status in REFUSALS or near, f"{signature}: {error}"
            continue
        assert result.geometry == features(signature).geometry
        said = verdict(result, tmp_path)
        assert said["ok"], (signature, said["why"])
