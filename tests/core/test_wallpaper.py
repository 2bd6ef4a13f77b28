# SPDX-License-Identifier: GPL-3.0-or-later
"""Images that a wallpaper group leaves as they are (core.Wallpaper), on every group that has a square period."""

import numpy as np
import pytest

import core

TURN = {2: [[-1, 0, 0], [0, -1, 0]], 4: [[0, -1, 0], [1, 0, 0]]}
# In the rectangle 1 : sqrt(3), which is two periods of the hexagonal lattice.
THIRD, SIXTH = [[-0.5, -1.5, 0], [0.5, -0.5, 0]], [[0.5, -1.5, 0], [0.5, 0.5, 0]]
CENTRED = [[1, 0, 0.5], [0, 1, 0.5]]
MIRROR, AWAY = [[1, 0, 0], [0, -1, 0]], [[1, 0, 0], [0, -1, 0.5]]
GLIDE = [[1, 0, 0.5], [0, -1, 0]]
GROUPS = {  # motions, order, whether texels go to texels on a square
    "o": ([], 1, True), "2222": ([TURN[2]], 2, True), "442": ([TURN[4]], 4, True), "333": ([THIRD, CENTRED], 6, False),
    "632": ([SIXTH, CENTRED], 12, False), "**": ([MIRROR], 2, True), "xx": ([GLIDE], 2, True),
    "*2222": ([MIRROR, TURN[2]], 4, True), "22*": ([AWAY, TURN[2]], 4, True), "*442": ([TURN[4], MIRROR], 8, True),
    "*632": ([SIXTH, CENTRED, MIRROR], 24, False), "*333": ([THIRD, CENTRED, MIRROR], 12, False),
}
TYPES = {np.uint8: 255, np.uint16: 65535, np.float32: 1}


def noise(height, width, kind=np.float32, channels=4, seed=0):
    values = np.random.default_rng(seed).random((height, width, channels)) * TYPES[kind]
    return values.astype(kind)


def smooth(height, width):
    """A function of period 1 with few waves."""
    v, u = (np.mgrid[:height, :width] + 0.5) / [[[height]], [[width]]]
    waves = [np.sin(2 * np.pi * (a * u + b * v) + c) for a, b, c in ((1, 0, 1), (1, 2, 0.3), (-2, 1, 2), (0, 1, 0.7))]
    return np.stack([waves[0] + waves[1], waves[2], waves[3] * waves[0], 1 + 0 * u], 2).astype(np.float32)


def looked_up(pixels, uv):
    """Bilinear, (n, channels)."""
    height, width = pixels.shape[:2]
    at = uv * [width, height] - 0.5
    low = np.floor(at).astype(int)
    (s, t), (x, y) = (at - low).T[:, :, None], low.T
    rows = [(1 - s) * pixels[j % height, x % width] + s * pixels[j % height, (x + 1) % width] for j in (y, y + 1)]
    return (1 - t) * rows[0] + t * rows[1]


def middles(height, width):
    """(h, w, 2) of texels."""
    v, u = (np.mgrid[:height, :width] + 0.5) / [[[height]], [[width]]]
    return np.stack([u, v], 2)


@pytest.mark.parametrize("kind", TYPES)
@pytest.mark.parametrize("name", GROUPS)
def test_once_is_enough_from_anything(name, kind):
    motions, order, exact = GROUPS[name]
    wallpaper = core.Wallpaper(48, 48, motions)
    assert (wallpaper.order, wallpaper.exact) == (order, exact)
    kept = wallpaper.to_tile == 0
    assert abs(kept.mean() * order - 1) < 0.05 and (wallpaper.to_tile < order).all()
    for source in ("tile", "all"):
        pixels = noise(48, 48, kind)
        before = pixels.copy()
        wallpaper.symmetrize(pixels, source)
        assert source == "all" or (pixels[kept] == before[kept]).all()
        assert order == 1 or (pixels != before).any()
        for again in ("tile", "all", "painted"):
            same = pixels.copy()
            wallpaper.symmetrize(same, again, painted=np.ones((48, 48)) if again == "painted" else None)
            assert (same == pixels).all(), (source, again)


@pytest.mark.parametrize("name", [name for name, (_, _, exact) in GROUPS.items() if exact])
def test_copies_are_equal_to_the_bit(name):
    motions, order, _ = GROUPS[name]
    wallpaper = core.Wallpaper(32, 32, motions)
    for kind in TYPES:
        pixels = noise(32, 32, kind)
        average = pixels.astype(float)
        wallpaper.symmetrize(pixels, "all")
        at = middles(32, 32)
        copies = []
        for motion in wallpaper.motions:
            column, row = ((at @ motion[:, :2].T + motion[:, 2]) * 32 - 0.5).round().astype(int).transpose(2, 0, 1) % 32
            assert (pixels[row, column] == pixels).all()
            copies.append(average[row, column])
        assert np.abs(pixels - np.mean(copies, 0)).max() <= (0.5 if kind is not np.float32 else 1e-6)


@pytest.mark.parametrize("name, tall", [("333", 1), ("632", 1), ("333", 3**0.5), ("632", 3**0.5), ("*632", 3**0.5)])
def test_interpolated_copies_approach_the_symmetric_function(name, tall):
    """The mean of a smooth function's copies, known at any point. The error falls with the square of the texels, except
    along the tile's border, where copies are interpolated from one side."""
    errors = []
    for width in (60, 120):
        height = round(width * tall)
        wallpaper = core.Wallpaper(width, height, GROUPS[name][0])
        pixels, fine = smooth(height, width), smooth(16 * 60, 16 * 60)
        wallpaper.symmetrize(pixels, "all")
        at = middles(height, width).reshape(-1, 2)
        images = [looked_up(fine, at @ motion[:, :2].T + motion[:, 2]) for motion in wallpaper.motions]
        error = np.abs(pixels.reshape(-1, 4) - np.mean(images, 0)).max(1)
        errors.append([error.mean(), error.max()])
    (mean, greatest), (finer_mean, finer_greatest) = errors
    assert mean < 2e-3 and finer_mean < 0.35 * mean and max(greatest, finer_greatest) < 0.03, errors


def test_the_tile_of_a_layout_is_kept():
    """A tile of 442 that is no square, beyond the unit square: a triangle about a cone, cut at the mirror line."""
    uv = np.array([[[0, 0], [0.5, 0], [0.5, 0.5]], [[0, 0], [0.5, 0.5], [0, 0.5]]]) + [3, -2]
    wallpaper = core.Wallpaper(40, 40, [TURN[4]], uv)
    kept = np.zeros((40, 40), bool)
    kept[:20, :20] = True
    assert ((wallpaper.to_tile == 0) == kept).all()
    pixels = noise(40, 40)
    before = pixels.copy()
    wallpaper.symmetrize(pixels)
    assert (pixels[kept] == before[kept]).all() and (pixels == np.rot90(pixels)).all()


def test_what_a_layout_leaves_out_is_filled_and_of_copies_one_is_taken():
    for uv in ([[[0, 0], [0.25, 0], [0.25, 0.5]]], [[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]]):
        wallpaper = core.Wallpaper(40, 40, [TURN[4]], uv)
        assert (wallpaper.to_tile == 0).sum() == 400
        pixels = noise(40, 40)
        wallpaper.symmetrize(pixels)
        assert (pixels == np.rot90(pixels)).all()


@pytest.mark.parametrize("name", ["2222", "442", "*442", "333", "632", "*632"])
def test_a_stroke_is_repeated_and_nothing_else_changes(name):
    motions, order, exact = GROUPS[name]
    wallpaper = core.Wallpaper(96, 96, motions)
    random = np.random.default_rng(5)
    for _ in range(6):
        before = noise(96, 96)  # of no symmetry
        x, y = random.integers(0, 88, 2)
        pixels, painted = before.copy(), np.zeros((96, 96), bool)
        painted[y : y + 8, x : x + 8] = True
        pixels[painted] = 2
        whole, part = pixels.copy(), pixels.copy()
        wallpaper.symmetrize(whole, "painted", painted)
        wallpaper.symmetrize(part, "painted", painted, area=(x, y, 8, 8))
        assert (whole == part).all()
        at = middles(96, 96)
        near, far = np.zeros((96, 96), bool), np.ones((96, 96), bool)
        for motion in wallpaper.motions:  # of the middle of the stroke
            moved = motion[:, :2] @ ((np.array([x, y]) + 4) / 96) + motion[:, 2]
            away = np.abs((at - moved + 0.5) % 1 - 0.5).max(2) * 96
            near |= away < 1
            far &= away > 14
        assert np.abs(whole[near] - 2).max() < (1e-6 if exact else 0.5), name
        assert (whole[far] == before[far]).all()


def test_of_a_stroke_over_the_border_the_tile_s_part_counts():
    wallpaper = core.Wallpaper(32, 32, [TURN[2]], [[[0, 0], [1, 0], [1, 0.5]], [[0, 0], [1, 0.5], [0, 0.5]]])
    pixels, painted = np.zeros((32, 32, 1), np.float32), np.zeros((32, 32))
    pixels[15, 4], pixels[16, 27] = 0.25, 0.75  # copies of one another
    painted[15, 4] = painted[16, 27] = 1
    wallpaper.symmetrize(pixels, "painted", painted)
    assert pixels[15, 4] == pixels[16, 27] == 0.25


@pytest.mark.parametrize("name", ["442", "632"])
def test_where_a_soft_stroke_runs_over_its_own_copy_the_stronger_part_counts(name):
    motions = GROUPS[name][0]
    wallpaper, at = core.Wallpaper(96, 96, motions), middles(96, 96)
    strength = np.exp(-(((at - 0.03) % 1 - 0.5) ** 2).sum(2) / 0.02)  # over all that lies around a centre of turns
    strength[strength < 0.1] = 0
    pixels = np.repeat(strength[:, :, None], 4, 2).astype(np.float32)
    wallpaper.symmetrize(pixels, "painted", np.uint8(255 * strength))
    moved = [at @ motion[:, :2].T + motion[:, 2] for motion in wallpaper.motions]
    strongest = np.max([looked_up(strength[:, :, None], one.reshape(-1, 2)) for one in moved], 0).reshape(96, 96)
    inside = strongest > 0.2
    assert np.abs(pixels[:, :, 0] - strongest)[inside].max() < 0.05


def test_number_of_threads_changes_nothing():
    for name in ("442", "632"):
        pixels = [noise(90, 70) for _ in range(2)]
        for own, threads in zip(pixels, (1, 5)):
            wallpaper = core.Wallpaper(70, 90, GROUPS[name][0], threads=threads)
            wallpaper.symmetrize(own, "all")
        assert (pixels[0] == pixels[1]).all()


def test_refusals_say_what_is_wrong():
    def refused(words, call, *arguments, **more):
        with pytest.raises(core.OrbifoldError, match=words) as caught:
            call(*arguments, **more)
        assert caught.value.status == "ORB_BAD_ARGUMENT"

    refused("do not fit the image's period", core.Wallpaper, 8, 8, [[[0.8, -0.6, 0], [0.6, 0.8, 0]]])
    refused("does not keep areas", core.Wallpaper, 8, 8, [[[2, 0, 0], [0, 1, 0]]])
    refused("does not keep areas", core.Wallpaper, 8, 8, [[[np.nan, 0, 0], [0, 1, 0]]])
    refused("a side has 1 to 32768", core.Wallpaper, 8, 40000, [])
    wallpaper, pixels = core.Wallpaper(8, 8, [TURN[2]]), noise(8, 8)
    refused("8 x 9 texels", wallpaper.symmetrize, noise(9, 8))
    refused("1 to 4 channels", wallpaper.symmetrize, noise(8, 8, channels=5))
    refused("no contiguous array", wallpaper.symmetrize, pixels.astype(float))
    refused("no contiguous array", wallpaper.symmetrize, pixels[:, ::-1])
    refused("area is not in the image", wallpaper.symmetrize, pixels, "painted", np.ones((8, 8)), (4, 4, 5, 1))
    refused("what is painted has the shape", wallpaper.symmetrize, pixels, "painted")
    refused("there is no source 'left'", wallpaper.symmetrize, pixels, "left")
