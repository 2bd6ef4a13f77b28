# SPDX-License-Identifier: GPL-3.0-or-later
"""Times of surface maps on the shared meshes, and random ones until something goes wrong (docs/decisions.md).

    python3 tests/bench/surface_maps.py [RANDOM [SEED]]
"""

import functools
import sys
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "addon"), str(ROOT / "tests" / "core")]

import core  # noqa: E402
from mapping import corresponding, embedded, trials  # noqa: E402
from meshes import far_apart  # noqa: E402

MESHES = ROOT.parent / "shared" / "meshes"
ROUNDS = 5


@functools.lru_cache(None)
def read(name):
    return core.read_mesh(MESHES / name)


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


def main(number=0, seed=1):
    for signature, count in (("442", 3), ("432", 3), ("2222", 4), ("2" * 7, 7)):
        timed("head_max.off", "head_julius.off", signature, count)
    timed("david.obj", "armadillo.obj", "2" * 20, 20)
    random = np.random.default_rng(seed)
    wrong = [line for line in trials(random, number, read) if line]
    print(*wrong, f"{number} random landmark sets, {len(wrong)} wrong", sep="\n")


if __name__ == "__main__":
    main(*(int(word) for word in sys.argv[1:3]))
