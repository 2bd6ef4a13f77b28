# SPDX-License-Identifier: GPL-3.0-or-later
"""Images to start from (addon/wallpapers.py, addon/formulas.py): formulas under groups, pictures that are laid over a
tile."""

import numpy as np
import pytest
from surfaces import bare
from test_wallpaper import AWAY, GLIDE, GROUPS, MIRROR, SIXTH, THIRD, TURN

import core

SQUARE = np.array([[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]], float)
HALF = SQUARE * [1, 0.5] + [0, -0.5]  # a tile of 2222, beyond the unit square
EQUAL = np.eye(2)
MOTIONS = {"2": TURN[2], "4": TURN[4], "3": THIRD, "6": SIXTH, "*": MIRROR, "x": GLIDE, "away": AWAY}
KEPT_BY = {  # the motions that leave the patterns as they are
    "CHECKER": "2 4 * x away", "STRIPES": "2 * x away", "TRIANGLES": "3", "QUADS": "2 4 * x away",
    "HEXAGONS": "2 3 6 * x away", "BRICKS": "2 * x away", "WEAVE": "2 4", "SCALES": "* x away",
}


def move(motion):
    rows = np.array(motion, float)
    return lambda points: points @ rows[:, :2].T + rows[:, 2]


@pytest.mark.parametrize("kind", KEPT_BY)
def test_patterns_fit_these_motions_and_no_others(kind):
    formulas = bare("formulas")
    assert KEPT_BY.keys() == formulas.PATTERNS.keys()
    pattern = formulas.PATTERNS[kind]
    assert {name for name, one in MOTIONS.items() if formulas.fits(pattern, [move(one)])} == set(KEPT_BY[kind].split())
    for period in ([[1, 0, 1], [0, 1, 0]], [[1, 0, 0], [0, 1, 1]]):
        assert formulas.fits(pattern, [move(period)])


@pytest.mark.parametrize("kind, name", [("WEAVE", "442"), ("BRICKS", "2222"), ("SCALES", "o"), ("SCALES", "xx")])
def test_images_of_patterns_are_as_the_group_leaves_them(kind, name):
    wallpapers, formulas = bare("wallpapers"), bare("formulas")
    pixels = wallpapers.of_formula(formulas.PATTERNS[kind], 96, 96, np.zeros(2), np.zeros(3), np.ones(3))
    symmetric = pixels.copy()
    core.Wallpaper(96, 96, GROUPS[name][0]).symmetrize(symmetric)
    assert np.abs(symmetric - pixels).max() < 1e-6 and pixels[:, :, 0].std() > 0.05
    assert set(np.unique(16 * pixels)) <= set(range(17))  # of 4 x 4 points
    moved = wallpapers.of_formula(formulas.PATTERNS[kind], 96, 96, np.array([0.25, 0.5]), np.zeros(3), np.ones(3))
    assert np.abs(moved - np.roll(pixels, (-48, -24), (0, 1))).max() < 1e-6


@pytest.mark.parametrize("width, height", [(5, 3), (7, 6), (1, 1), (10, 9)])
def test_smaller_pictures_are_means_of_what_they_cover(width, height):
    picture = np.random.default_rng(2).random((9, 10, 4)).astype(np.float32)
    picture[:, :, 3] = 1
    found = bare("wallpapers").resized(picture, width, height)
    finer = np.repeat(np.repeat(picture.astype(float), height, 0), width, 1)  # whole numbers of these in each texel
    wanted = finer.reshape(height, 9, width, 10, 4).mean((1, 3))
    assert np.abs(found - wanted).max() < 1e-12
    picture[4:, :, 3] = 0
    picture[4:, :, :3] = 9
    assert bare("wallpapers").resized(picture, 1, 1)[0, 0, :3].max() < 1  # what cannot be seen has no colour


def folded(picture, size=80, sides=EQUAL, blend=0.0, whole=False):
    wallpaper = core.Wallpaper(size, size, [TURN[2]], HALF)
    return bare("wallpapers").of_picture(picture, wallpaper, HALF, sides, blend, whole)


def ramps(height, width):
    """u and v as red and green."""
    v, u = (np.mgrid[:height, :width] + 0.5) / [[[height]], [[width]]]
    return np.stack([u, v, 0 * u, 1 + 0 * u], 2).astype(np.float32)


def test_a_picture_lies_over_the_tile_and_is_folded_to_the_rest():
    for whole in (False, True):  # the tile is twice as wide as high, as the picture is
        pixels = folded(ramps(60, 120), whole=whole)
        there = (np.arange(80) + 0.5) / 80
        inside = pixels[43:77, 3:77]  # v from -0.5 to 0 is the image's upper half
        assert np.abs(inside[:, :, 0] - there[3:77]).max() < 0.03
        assert np.abs(inside[:, :, 1] - ((np.arange(3, 37) + 0.5) / 40)[:, None]).max() < 0.03
        assert np.abs(pixels - pixels[::-1, ::-1]).max() < 1e-6


def test_tile_and_copies_are_blended_without_a_break():
    def steps(pixels):
        return max(np.abs(np.roll(pixels, 1, axis) - pixels)[:, :, :3].max() for axis in (0, 1))

    waves = 0.5 + 0.5 * np.cos(3 * ramps(160, 320))
    waves[:, :, 3] = 1
    assert steps(folded(waves, 160)) > 0.25 and steps(folded(waves, 160, blend=0.8)) < 0.1


def test_proportions_are_kept_unless_the_whole_picture_is_asked_for():
    cut, whole = (folded(ramps(90, 90), whole=whole)[42:78, 2:78] for whole in (False, True))
    assert abs(np.ptp(cut[:, :, 1]) - 0.45) < 0.06 and abs(cut[:, :, 1].mean() - 0.5) < 0.02
    assert np.ptp(whole[:, :, 1]) > 0.8 and np.ptp(cut[:, :, 0]) > 0.85
    high = folded(ramps(90, 90), sides=np.diag([1.0, 2.0]))[42:78, 2:78]  # the tile is a square then
    assert np.abs(high - whole).max() < 0.03


def test_the_difference_is_that_of_the_copies():
    difference = bare("wallpapers").difference
    pixels = np.random.default_rng(1).random((32, 32, 4)).astype(np.float32)
    turned = np.array([TURN[2]])
    assert difference(pixels, turned) > 0.1
    core.Wallpaper(32, 32, turned).symmetrize(pixels)
    assert difference(pixels, turned) < 1e-6 and difference(pixels, turned[:0]) == 0
