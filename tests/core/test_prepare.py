# SPDX-License-Identifier: GPL-3.0-or-later
"""Embeddings of a prepared mesh are those of its arrays (more in tests/native/test_prepared.c)."""

import numpy as np
import pytest
from meshes import far_apart, icosphere

import core


@pytest.fixture(scope="module")
def ball():
    vertices, triangles = icosphere(4)
    return vertices, triangles, core.prepare(vertices, triangles)


@pytest.mark.parametrize("signature", ["442", "2222", "432", "237"])
@pytest.mark.parametrize("weights", ["cotan", "conformal"])
def test_the_same_embedding(ball, signature, weights):
    vertices, triangles, prepared = ball
    cones = far_apart(vertices, triangles, len(signature))
    plain = core.embed(vertices, triangles, signature, cones, weights=weights)
    fast = core.embed(vertices, triangles, signature, cones, weights=weights, prepared=prepared)
    assert np.abs(fast.embedding - plain.embedding).max() < 1e-9
    assert np.abs(fast.uv - plain.uv).max() < 1e-9
    assert len(fast.uv) == len(triangles)


def test_a_job_keeps_what_was_prepared():
    vertices, triangles = icosphere(5)
    cones = far_apart(vertices, triangles, 3)
    prepared = core.prepare(vertices, triangles)
    job = core.start_embedding(vertices, triangles, "432", cones, prepared=prepared)
    del prepared
    assert job.finish().report["certificate"]["flipped"] == 0


def test_what_is_wrong_with_the_mesh_is_said():
    vertices, triangles = icosphere(1)
    with pytest.raises(core.OrbifoldError) as caught:
        core.prepare(vertices, np.vstack([triangles, [[0, 1, 2]]]))
    assert caught.value.status.startswith("ORB_") and caught.value.elements
