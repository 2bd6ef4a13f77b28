# SPDX-License-Identifier: GPL-3.0-or-later
"""Images from one UV map to another (addon/baking.py)."""

import numpy as np
from surfaces import bare

SQUARE = np.array([[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]], float)


def itself(triangles, barycentric):
    return triangles, barycentric


def baked(*arguments):
    return bare("steps").Steps(bare("baking").bake(*arguments)).finish()


def picture(height, width):
    return np.random.default_rng(7).random((height, width, 4))


def test_the_same_map_gives_the_same_image():
    pixels = picture(24, 40)
    found = baked(SQUARE, 40, 24, itself, SQUARE, pixels)
    assert np.abs(found - pixels).max() < 1e-12


def test_a_map_that_is_turned_turns_the_image():
    pixels = picture(32, 32)
    turned = np.stack([1 - SQUARE[:, :, 1], SQUARE[:, :, 0]], 2)
    found = baked(turned, 32, 32, itself, SQUARE, pixels)
    assert np.abs(found - np.rot90(pixels, -1)).max() < 1e-12  # rows go upwards


def test_beyond_the_unit_square_the_image_repeats():
    pixels = picture(24, 40)
    found = baked(SQUARE + [0.25, -1.5], 40, 24, itself, SQUARE, pixels)
    assert np.abs(found - np.roll(pixels, (12, 10), (0, 1))).max() < 1e-12
    assert not baked(1e6 * SQUARE, 40, 24, itself, SQUARE, pixels).any()


def test_only_a_margin_is_filled_around_a_small_island():
    baking = bare("baking")
    pixels = np.ones((16, 16, 4))
    small = 0.4 + 0.2 * SQUARE
    found = baked(small, 100, 100, itself, SQUARE, pixels)
    filled = found[:, :, 3] > 0
    rows = np.flatnonzero(filled.any(1))
    assert np.abs(found[filled] - 1).max() < 1e-12
    assert rows[0] == 40 - baking.MARGIN and rows[-1] == 59 + baking.MARGIN and not filled[0, 0]
    nothing = baked(small, 100, 100, lambda t, b: (np.full(len(t), -1), b), SQUARE, pixels)
    assert not nothing.any()


def test_portions_and_triangles_without_area_change_nothing(monkeypatch):
    baking, pixels = bare("baking"), picture(64, 64)
    flat = np.concatenate([SQUARE[:1], np.full((1, 3, 2), 0.5), SQUARE[1:]])
    whole = baked(flat, 64, 64, itself, flat, pixels)
    monkeypatch.setattr(baking, "AT_ONCE", 500)
    assert np.array_equal(baked(flat, 64, 64, itself, flat, pixels), whole)
    assert np.abs(whole - pixels).max() < 1e-12
