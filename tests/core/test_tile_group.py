# SPDX-License-Identifier: GPL-3.0-or-later
"""addon/group.py: the elements near a tile are all found, once each."""

import numpy as np
import pytest
import surfaces

import core

CURVATURE = {"spherical": 1, "euclidean": 0, "hyperbolic": -1}


def group_of(signature):
    mesh = surfaces.surface_for(signature)
    result = core.embed(*mesh, signature, surfaces.picks_for(mesh, signature))
    module, curvature = surfaces.bare("group"), CURVATURE[result.geometry]
    points = result.embedding[result.cut_triangles].reshape(-1, 3)
    return module, module.Group(result.generators, curvature, points), result, curvature


def words(module, result, curvature, length):
    """All products of so many generators, each element once."""
    moves = np.concatenate([np.eye(3)[None], module.with_inverses(result.generators, curvature)])
    probes = result.embedding[:: max(1, len(result.embedding) // 5)][:5]
    found = np.eye(3)[None]
    for _ in range(length):
        found = (found[:, None] @ moves[None]).reshape(-1, 3, 3)
        keys = np.round((found @ probes.T).reshape(len(found), -1), 5)
        found = found[np.unique(keys, axis=0, return_index=True)[1]]
    return found


@pytest.mark.parametrize("signature", ["442", "**", "xx", "*632", "22x", "237", "*237", "o2", "oo", "5*3", "2**"])
def test_all_images_near_by_are_found(signature):
    module, group, result, curvature = group_of(signature)
    seen = group.tile[:: 4]
    reach = 0.6 * float(module.distances(group.tile, group.tile[:1], curvature).max())
    elements = group.near(seen, reach)
    for point in group.tile[::16]:
        point = group.representative(point)
        images = elements @ point
        others = words(module, result, curvature, 3) @ point
        close = others[(module.distances(others, seen, curvature) <= reach).any(1)]
        missing = module.distances(close, images, curvature).min(1)
        assert len(close) and missing.max() < 1e-4


@pytest.mark.parametrize("signature", ["442", "*632", "532", "*44", "oo", "*x"])
def test_elements_are_told_apart(signature):
    module, group, result, curvature = group_of(signature)
    elements = group.nearest(60)
    assert np.array_equal(elements[0], np.eye(3)) and len(elements) == {"*44": 8}.get(signature, 60)
    images = (elements @ group.tile[:5].T).reshape(len(elements), -1)
    gaps = np.abs(images[:, None] - images[None]).max(2) + 9 * np.eye(len(elements))
    assert gaps.min() > 1e-3


def test_rows_that_agree_are_one_however_they_are_rounded():
    distinct = surfaces.bare("group").distinct
    rows = np.repeat(np.random.default_rng(3).normal(size=(400, 9)), 5, axis=0)
    noisy = rows + np.random.default_rng(4).normal(scale=1e-12, size=rows.shape)
    assert len(distinct(noisy, 1e-3)) == 400
