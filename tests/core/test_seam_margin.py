# SPDX-License-Identifier: GPL-3.0-or-later
"""Texels around islands (core.fill_seam_margin): a smooth function painted on the mesh is looked up from both sides of
every seam, also in smaller images, as a renderer does."""

import numpy as np
import pytest
import shapes
from meshes import far_apart, icosphere
from surfaces import bare
from test_wallpaper import looked_up

import core

SIDE = 7  # points on an edge
CASES = [  # signature, layout, whether the image repeats
    ("442", "periodic", True), ("2222", "periodic", True), ("333", "periodic", True), ("632", "periodic", True),
    ("432", "octahedral", False), ("332", "stereographic", False), ("22222", "poincare", False),
    ("237", "klein", False),
]
EXACT = ("442", "2222")  # the group takes texels to texels


def layout_of(signature, chart):
    """(vertices, triangles, uv (m, 3, 2))"""
    vertices, triangles = shapes.roughened(icosphere(3), amount=0.1)
    count = len(core.parse_signature(signature).orders)
    result = core.embed(vertices, triangles, signature, far_apart(vertices, triangles, count))
    return vertices, triangles, result.uv_chart(chart)


def function(points):
    """(p, 2) of points (p, 3) of space."""
    return np.stack([np.sin(2 * points[:, 0] + points[:, 1]), np.cos(3 * points[:, 2] - points[:, 0])], 1)


def painted(vertices, triangles, uv, size):
    """(size, size, 2) the function where texels' middles lie in triangles, and else 9; whether they do."""
    texels, of, barycentric = bare("baking").texels_of(uv, size, size)
    image, covered = np.full((size * size, 2), 9, np.float32), np.zeros(size * size, bool)
    image[texels] = function(np.einsum("pc,pcd->pd", barycentric, vertices[triangles[of]]))
    covered[texels] = True
    return image.reshape(size, size, 2), covered.reshape(size, size)


def spread(image, covered, texels):
    """What renderers do themselves: a texel outside takes the mean of those beside it, so many times."""
    image, covered = image.copy(), covered.copy()
    for _ in range(texels):
        rolled = [(np.roll(image, s, a), np.roll(covered, s, a)) for a in (0, 1) for s in (1, -1)]
        count = sum(there.astype(int) for _, there in rolled)
        new = ~covered & (count > 0)
        image[new] = (sum(own * there[:, :, None] for own, there in rolled) / np.maximum(count, 1)[:, :, None])[new]
        covered |= new
    return image


def seams(triangles, uv):
    """Points along every edge whose two sides have different UVs: (k, 2), (k, 2)."""
    there, steps, found = {}, np.linspace(0, 1, SIDE)[:, None], []
    for face, corners in enumerate(triangles.tolist()):
        for c in range(3):
            ends = corners[c], corners[(c + 1) % 3]
            there[ends] = uv[face, c], uv[face, (c + 1) % 3]
    for (a, b), (p, q) in there.items():
        if a < b and (b, a) in there:
            q_, p_ = there[b, a]
            if np.abs([p - p_, q - q_]).max() > 1e-9:
                found.append(((1 - steps) * p + steps * q, (1 - steps) * p_ + steps * q_))
    return [np.concatenate(side) for side in zip(*found)]


def jump(image, sides):
    """The greatest difference over all seams, in the image and half, quarter and eighth as large ones."""
    found = []
    for _ in range(4):
        found.append(np.abs(looked_up(image, sides[0]) - looked_up(image, sides[1])).max())
        image = (image[::2, ::2] + image[1::2, ::2] + image[::2, 1::2] + image[1::2, 1::2]) / 4
    return np.array(found)


@pytest.mark.parametrize("signature, chart, repeats", CASES)
def test_seams_are_smooth_at_four_resolutions_and_their_mipmaps(signature, chart, repeats):
    vertices, triangles, uv = layout_of(signature, chart)
    sides = seams(triangles, uv)
    assert len(sides[0]) > 100
    for size in (128, 256, 512, 1024):
        image, covered = painted(vertices, triangles, uv, size)
        usual, ours = spread(image, covered, 16), image.copy()
        core.fill_seam_margin(ours, triangles, uv, 16, repeats)
        assert (ours[covered] == image[covered]).all()
        there, here = jump(usual, sides), jump(ours, sides)
        if signature in EXACT:
            assert here.max() < 1e-6 < 1e-3 * there.max()
        assert (here[:2] < 0.6 * there[:2]).all() and (here < 0.9 * there).all(), (size, there, here)
        again = ours.copy()
        core.fill_seam_margin(again, triangles, uv, 16, repeats)
        assert (again == ours).all()


def test_only_so_many_texels_are_filled_and_borders_take_the_colour_beside_them():
    square = np.array([[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]]) / 4 + 0.375
    for kind in (np.uint8, np.uint16, np.float32):
        pixels = np.zeros((32, 32, 3), kind)
        pixels[12:20, 12:20] = np.arange(1, 9)[:, None]  # from column to column
        core.fill_seam_margin(pixels, [[0, 1, 2], [0, 2, 3]], square, 3)
        filled = (pixels > 0).all(2)
        assert filled[9:23, 9:23].all() and filled.sum() == 14 * 14
        assert (pixels[9:23, 9:12] == 1).all() and (pixels[9:23, 20:23] == 8).all()  # left and right
        assert (pixels[9:12, 12:20] == np.arange(1, 9)[:, None]).all()


def test_a_strip_is_continued_across_its_seam_also_turned_over():
    """A band of two squares in two islands, one of them mirrored, that share an edge."""
    triangles = np.array([[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]])
    left = np.array([[0.0, 0], [0.25, 0], [0.25, 0.5], [0, 0.5]])
    right = np.array([[1.0, 0.5], [0.75, 0.5], [0.75, 1], [1, 1]])  # of 1, 4, 5, 2: mirrored
    corners = {0: left[0], 1: left[1], 2: left[2], 3: left[3]}
    other = {1: right[0], 4: right[1], 5: right[2], 2: right[3]}
    uv = np.array([[own[v] for v in face] for face, own in zip(triangles.tolist(), (corners, corners, other, other))])
    pixels = np.zeros((64, 64, 1), np.float32)
    pixels[:32, :16, 0] = np.arange(16)
    pixels[32:, 48:, 0] = np.arange(31, 15, -1)
    core.fill_seam_margin(pixels, triangles, uv, 4)
    assert (pixels[:32, 16:20, 0] == np.arange(16, 20)).all() and (pixels[36:, 44:48, 0] == 31).all()
    assert (pixels[:28, 20:] == 0).all()


def test_broken_maps_are_survived():
    random = np.random.default_rng(8)
    for _ in range(30):
        triangles, uv = random.integers(0, 12, (20, 3)), random.random((20, 3, 2)) * 3 - 1
        uv[random.random(20) < 0.2] = 0.5  # without area
        uv[0, 0], uv[1, 1] = np.nan, 1e9
        pixels = random.random((17, 23, 2)).astype(np.float32)
        core.fill_seam_margin(pixels, triangles, uv, 9, repeats=bool(random.integers(2)))
        assert np.isfinite(pixels).all() and pixels.min() >= 0 and pixels.max() <= 1


def test_refusals_say_what_is_wrong():
    pixels, square = np.zeros((8, 8, 4), np.float32), np.zeros((1, 3, 2))
    for words, arguments in (
        ("no contiguous array", (pixels.astype(float), [[0, 1, 2]], square, 1)),
        ("1 to 4 channels", (np.zeros((8, 8, 5), np.float32), [[0, 1, 2]], square, 1)),
        ("the UVs have the shape", (pixels, [[0, 1, 2]], square[:, :2], 1)),
        ("a count is negative", (pixels, [[0, 1, 2]], square, -1)),
    ):
        with pytest.raises(core.OrbifoldError, match=words) as caught:
            core.fill_seam_margin(*arguments)
        assert caught.value.status == "ORB_BAD_ARGUMENT"
