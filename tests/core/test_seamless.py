# SPDX-License-Identifier: GPL-3.0-or-later
"""The periodic layout is seamless: across every seam the UVs differ by a symmetry of the repeating image."""

import numpy as np
import pytest
from meshes import far_apart, icosphere

import core

# signature: the order of the image's rotations, and the cell's height in units of its width
IMAGES = {"442": (4, 1.0), "2222": (2, 1.0), "333": (3, np.sqrt(3)), "632": (6, np.sqrt(3))}


def seam_sides(result):
    """UVs (k, 2 sides, 2 ends, 2) of every seam edge, the ends in the same sequence on both sides."""
    corners = {}
    for triangle, uv in zip(result.triangles, result.uv):
        for c in range(3):
            corners[int(triangle[c]), int(triangle[(c + 1) % 3])] = uv[c], uv[(c + 1) % 3]
    return np.array([(corners[i, j], corners[j, i][::-1]) for i, j in result.seams.tolist()])


def symmetry_residual(sides, order, height):
    """For every seam edge the least distance, over the rotations of the image, between one side turned and shifted by a
    whole number of periods, and the other side. On the tall cell the shift by half of both periods is one too."""
    best = np.full(len(sides), np.inf)
    scale = np.array([1.0, height])
    for turns in range(order):
        angle = 2 * np.pi * turns / order
        rotation = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        turned = (sides[:, 0] * scale) @ rotation.T / scale
        shift = sides[:, 1] - turned  # (k, 2 ends, 2)
        same = np.abs(shift[:, 0] - shift[:, 1]).max(1)
        periods = [np.zeros(2)] if height == 1 else [np.zeros(2), np.full(2, 0.5)]
        whole = np.min([np.abs(shift[:, 0] - p - np.round(shift[:, 0] - p)).max(1) for p in periods], 0)
        best = np.minimum(best, np.maximum(same, whole))
    return best.max()


@pytest.mark.parametrize("signature", IMAGES)
def test_repeating_images_are_seamless(signature):
    vertices, triangles = icosphere(4)
    vertices = vertices * [1.0, 0.7, 1.6] + 0.1 * np.sin(3 * vertices[:, [1, 2, 0]])
    cones = far_apart(vertices, triangles, 4 if signature == "2222" else 3)
    result = core.embed(vertices, triangles, signature, cones)
    sides = seam_sides(result)
    assert len(sides) > 20
    assert symmetry_residual(sides, *IMAGES[signature]) < 1e-12


@pytest.mark.parametrize("signature", ["442", "2222"])
def test_texels_meet_texels(signature):
    """The rotations fix points whose coordinates are multiples of one half: a whole texel for any even image size."""
    vertices, triangles = icosphere(3)
    cones = far_apart(vertices, triangles, 4 if signature == "2222" else 3)
    result = core.embed(vertices, triangles, signature, cones)
    for cone, order in zip(result.cones, result.orders):
        at = result.uv[result.triangles == cone]
        doubled = 2 * at
        assert np.abs(doubled - np.round(doubled)).max() < 1e-12
        if order == 4:  # a quarter turn maps texels to texels about corners and middles of the cell only
            assert np.abs((at - at[:, ::-1]) - np.round(at - at[:, ::-1])).max() < 1e-12
