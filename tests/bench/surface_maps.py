# SPDX-License-Identifier: GPL-3.0-or-later
"""Times of surface maps on the shared meshes, and random ones until something goes wrong (docs/decisions.md).

    python3 tests/bench/surface_maps.py [RANDOM [SEED]]
"""

import sys
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "addon"), str(ROOT / "tests" / "core")]

import core  # noqa: E402
import picks  # noqa: E402
from conway import features  # noqa: E402
from families import EUCLIDEAN, HYPERBOLIC, SPHERICAL, mesh_named  # noqa: E402
from meshes import far_apart  # noqa: E402
from test_surface_map import corresponding, embedded, there_and_back  # noqa: E402

MESHES = ROOT.parent / "shared" / "meshes"
ROUNDS = 5
SPHERES = ("ellipsoid", "spot.obj", "bunny.obj", "fandisk.off")
DISKS = ("disk", "plate", "cap", "hemisphere.obj", "lion.off", "camelhead.off")
ON_DISKS = [name for name in [*SPHERICAL, *EUCLIDEAN, *HYPERBOLIC] if features(name).topology == (0, 0, 1)]
ON_THREE = ("442", "333", "632", "432", "532", "332", "225", "237", "334", "(11)32")


def read(name):
    return core.read_mesh(MESHES / name) if "." in name else mesh_named((0, 0, 1 if name in DISKS else 0), name)


def timed(source, target, signature, count):
    mesh, other = read(source), read(target)
    picked = far_apart(*mesh, count)
    picked = picked[core.landmark_sequence(*mesh, picked)] if count > 3 else picked
    a = embedded(mesh, signature, picked, weights="conformal")
    b = embedded(other, signature, corresponding(mesh, other, picked), weights="conformal")
    least = {}
    for _ in range(ROUNDS):
        start = time.perf_counter()
        core.surface_map(a, b)
        middle = time.perf_counter()
        distortion = core.SurfaceMap(a, b).distortion
        for what, seconds in (("map", middle - start), ("distortion", time.perf_counter() - middle)):
            least[what] = min(least.get(what, np.inf), seconds)
    crossed = core.SurfaceMap(a, b).steps / len(mesh[0])
    print(
        f"{source} to {target}, {signature}: {1e3 * least['map']:.0f} ms, {crossed:.1f} sides a vertex, distortion "
        f"{1e3 * least['distortion']:.0f} ms, mean {distortion.quasi_conformal_mean:.2f}",
        flush=True,
    )


def landmarks(random, mesh, signature):
    """Spread out along a short walk, or anywhere."""
    described = features(signature)
    if described.topology != (0, 0, 0):
        return picks.picks_for(*mesh, described, start=random.random())
    count = len(described.cones)
    if random.random() < 0.4 and count < 13:
        return random.choice(np.unique(mesh[1]), count, replace=False)
    spread = far_apart(*mesh, count)
    return spread[core.landmark_sequence(*mesh, spread)] if count > 3 else spread


def tried(random):
    """One random map between two spheres or disks, and what is wrong with it."""
    names, signatures = (SPHERES, [*ON_THREE, "55", *("2" * n for n in (4, 5, 7, 12, 20, 50))])
    if random.random() < 0.5:
        names, signatures = DISKS, ON_DISKS
    signature, chosen = str(random.choice(signatures)), [str(name) for name in random.choice(names, 2)]
    meshes = [read(name) for name in chosen]
    weights = str(random.choice(["cotan", "uniform", "mean-value", "conformal"]))
    what = f"{chosen} {signature} {weights}"
    try:
        a, b = (embedded(mesh, signature, landmarks(random, mesh, signature), weights=weights) for mesh in meshes)
    except core.OrbifoldError as error:
        return f"no embedding: {what}: {error.status} {error}"
    try:
        off, distortion = there_and_back(a, b), core.SurfaceMap(a, b).distortion
    except core.OrbifoldError as error:
        return f"NO MAP: {what}: {error.status} {error}"
    fine = off < 1e-12 * max(1, distortion.quasi_conformal_max) ** 1.5 + 1e-9 and distortion.flipped == 0
    return None if fine else f"WRONG: {what}: there and back {off:.1e}, distortion {distortion.quasi_conformal_max:.1e}"


def main(number=0, seed=1):
    for signature, count in (("442", 3), ("432", 3), ("2222", 4), ("2" * 7, 7)):
        timed("head_max.off", "head_julius.off", signature, count)
    timed("david.obj", "armadillo.obj", "2" * 20, 20)
    random = np.random.default_rng(seed)
    said = [line for line in (tried(random) for _ in range(number)) if line]
    print(*said, f"{number} random maps, {sum(not line.startswith('no') for line in said)} wrong", sep="\n")


if __name__ == "__main__":
    main(*(int(word) for word in sys.argv[1:3]))
