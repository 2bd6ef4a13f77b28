# SPDX-License-Identifier: GPL-3.0-or-later
"""../shared/tools/check_layout.py says ok on the .npz of every sphere-like shared mesh under every kind of orbifold.

The judge walks the mesh in Python, so two of them run at once, ahead of the tests that wait for their verdicts."""

import functools
from concurrent.futures import ThreadPoolExecutor

import pytest
from conftest import SHARED
from meshes import CHECK_LAYOUT, far_apart, judge, shared_file

import core

MESHES = [
    *["spot.obj", "fandisk.off", "bunny.obj", "david.obj", "head_max.off", "head_julius.off"],
    *["armadillo.obj", "nefertiti.obj"],
]
SIGNATURES = ["442", "333", "632", "2222", "432", "532", "332", "22(5)", "33", "237", "22222", "2" * 10]


read = functools.lru_cache(maxsize=2)(core.read_mesh)


def verdict(path, signature, layout):
    """The library's certificate and the judge's verdict, or the error."""
    vertices, triangles = read(path)
    cones = far_apart(vertices, triangles, len(core.parse_signature(signature).orders))
    try:
        result = core.embed(vertices, triangles, signature, cones)
    except core.OrbifoldError as error:
        return None, {"ok": False, "why": [f"{error.status}: {error} {error.element} {error.elements}"]}
    result.save(layout)
    said = judge(layout)
    layout.unlink()
    return result.report, said


@pytest.fixture(scope="module")
def verdicts(request, tmp_path_factory):
    """Futures of the verdicts of those tests of this file that have been selected, in their sequence."""
    folder = tmp_path_factory.mktemp("layouts")
    chosen = [item.callspec.params for item in request.session.items if "verdicts" in getattr(item, "fixturenames", ())]
    with ThreadPoolExecutor(2) as pool:
        futures = {}
        for mesh, signature in ((c["mesh"], c["signature"]) for c in chosen):
            path = SHARED / "meshes" / mesh
            if path.is_file() and CHECK_LAYOUT.is_file():
                layout = folder / f"{mesh}_{signature}.npz"
                futures[mesh, signature] = pool.submit(verdict, path, signature, layout)
        yield futures
        pool.shutdown(cancel_futures=True)


@pytest.mark.parametrize("signature", SIGNATURES)
@pytest.mark.parametrize("mesh", MESHES)
def test_layout_of_shared_mesh_is_judged_ok(mesh, signature, verdicts):
    shared_file("meshes", mesh)
    shared_file("tools", "check_layout.py")
    report, said = verdicts[mesh, signature].result()
    assert said["ok"], said["why"]
    assert "harmonic_residual" in said  # the judge has seen the weights
    assert report["certificate"]["flipped"] == said["flipped"] == 0
