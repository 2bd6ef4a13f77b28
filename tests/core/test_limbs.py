# SPDX-License-Identifier: GPL-3.0-or-later
"""Precision: hundreds of cones, and limbs whose triangles shrink to nothing."""

import numpy as np
import pytest
import shapes
from conway import features
from judged import verdict
from meshes import shared_file
from picks import picks_for

import core


@pytest.mark.parametrize(
    "file, signature",
    [
        *[("bunny.obj", "2" * 200), ("spot.obj", "2" * 100), ("hemisphere.obj", "*" + "2" * 60)],
        *[("hemisphere.obj", "2" * 100 + "*" + "3" * 20), ("halftunnel.off", "2" * 20 + "*2222*222*22")],
        *[("three_holes.off", "ooo" + "2" * 50), ("lion.off", "(50)(50)*(50)(50)")],
    ],
    ids=lambda text: text[:8],
)
def test_many_cones(file, signature, tmp_path):
    mesh = core.read_mesh(shared_file("meshes", file))
    result = core.embed(*mesh, signature, picks_for(*mesh, features(signature)), weights="cotan")
    said = verdict(result, tmp_path)
    assert said["ok"], said["why"]


def finger(length, rings=3):
    """A tube of radius 1 with a round tip."""
    tip, triangles = shapes.hemisphere(rings)
    around = 6 * rings
    step = 2 * np.pi / around
    rim, first = np.arange(len(tip) - around, len(tip)), len(tip)
    vertices, triangles = [tip], [triangles]
    for row in range(1, int(length / step) + 1):
        vertices.append(tip[-around:] - [0, 0, row * step])
        new = np.arange(first, first + around)
        first += around
        triangles.append(np.stack([rim, new, np.roll(new, -1)], 1))
        triangles.append(np.stack([rim, np.roll(new, -1), np.roll(rim, -1)], 1))
        rim = new
    return np.concatenate(vertices), np.concatenate(triangles)


@pytest.mark.parametrize("signature", ["*442", "*2222", "*432", "*237", "*22222", "22*2", "3*22"])
def test_a_limb_inside_mirrors(signature, tmp_path):
    """The tile's edges at the tip are 1e-14 long where no cone is; in single precision its triangles are lost."""
    mesh = shapes.roughened(finger(30), flips=0.1)
    result = core.embed(*mesh, signature, picks_for(*mesh, features(signature)), weights="cotan")
    said = verdict(result, tmp_path)
    assert said["ok"], said["why"]


@pytest.mark.parametrize("signature", ["*442", "*432", "*237"])
def test_a_limb_that_is_out_of_the_judge_s_sight(signature):
    """Edges of 1e-22: past the long doubles of check_layout.py, not past the library's certificate."""
    mesh = shapes.roughened(finger(50), flips=0.1)
    result = core.embed(*mesh, signature, picks_for(*mesh, features(signature)), weights="cotan")
    certificate = result.report["certificate"]
    assert certificate["flipped"] == 0 and certificate["seam_residual"] < 1e-7
