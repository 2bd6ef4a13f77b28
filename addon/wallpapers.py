# SPDX-License-Identifier: GPL-3.0-or-later
"""Images that a group of the plane leaves as they are, from formulas and from any picture; arrays only, no bpy.

An image is one period: the unit square of the UV map. Rows go upwards."""

from __future__ import annotations

import numpy as np

from . import baking, core, formulas

FINER = 4  # points along each side of a texel, at which a formula is computed
THINNEST = 0.004  # of the period: lines of patterns are not thinner
AT_ONCE = 2**20  # points
LEAST = 1e-9  # of weights


def of_formula(
    pattern: formulas.Pattern, width: int, height: int, origin: np.ndarray, dark: np.ndarray, light: np.ndarray
) -> np.ndarray:
    """(height, width, 4) float32: `dark` and `light` (3,) in the proportion that the pattern's two colours have in a
    texel. The image's corner is at `origin` (2,) of the lattice's coordinates."""
    u, v = (np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height
    share = np.empty((height, width), np.float32)
    for first in range(0, height, max(1, AT_ONCE // width)):
        rows = slice(first, first + max(1, AT_ONCE // width))
        share[rows] = _chosen(pattern, np.stack(np.meshgrid(u, v[rows]), -1) + origin)
    mixed = np.ones((height, width), bool)
    if min(width, height) * THINNEST > 1:  # a texel of another colour than those beside it: no line is missed
        mixed = np.logical_or.reduce([share != np.roll(share, step, axis) for axis in (0, 1) for step in (1, -1)])
    at = np.argwhere(mixed)
    steps = (np.arange(FINER) + 0.5) / FINER - 0.5
    within = np.stack(np.meshgrid(steps / width, steps / height), -1).reshape(-1, 2)
    for first in range(0, len(at), AT_ONCE // FINER**2):
        y, x = at[first : first + AT_ONCE // FINER**2].T
        points = np.stack([u[x], v[y]], 1)[:, None] + within + origin
        share[y, x] = _chosen(pattern, points).mean(1)
    pixels = np.ones((height, width, 4), np.float32)
    pixels[:, :, :3] = share[:, :, None] * np.subtract(light, dark) + dark
    return pixels


def _chosen(pattern: formulas.Pattern, points: np.ndarray) -> np.ndarray:
    """(...) bool at points (..., 2): whether they have the second colour."""
    return (formulas.value_at(pattern, points.reshape(-1, 2)) > 0).reshape(points.shape[:-1])


def of_picture(
    picture: np.ndarray, wallpaper: core.Wallpaper, tile: np.ndarray, sides: np.ndarray, blend: float,
    whole: bool = False,
) -> np.ndarray:
    """(height, width, 4) float32: a picture (h, w, 4) float32 that is laid over the tile (m, 3, 2) and its
    surroundings, folded by the group: each place gets the mean of what its copies have in the picture, weighted by 1 on
    the tile and less and less around it. So it goes on without a break where the tile meets its copies.

    sides  (2, 2) of the period, in the plane: the picture keeps its proportions, and what of it is too wide or too high
           is cut off
    blend  how far around the tile's border weights change, for half the root of the tile's area; at least a texel
    whole  nothing is cut off, the picture is stretched
    """
    size = np.array([wallpaper.width, wallpaper.height])
    texels = tile * size
    area = np.abs(np.cross(texels[:, 1] - texels[:, 0], texels[:, 2] - texels[:, 0])).sum() / 2
    reach = max(1, int(blend * np.sqrt(area) / 2))
    low = np.floor(texels.min((0, 1))).astype(int) - reach
    extent = np.ceil(texels.max((0, 1))).astype(int) + reach - low
    weights = np.zeros(extent[0] * extent[1])
    within = (texels - low) / extent
    for first, last in baking.portions(within, *extent):
        weights[baking.texels_of(within[first:last], *extent)[0]] = 1
    weights = _blurred(weights.reshape(extent[::-1]), reach).ravel()
    if not whole:
        picture = _cut_to(picture, extent * np.linalg.norm(sides, axis=1) / size)
    fine = resized(picture, *np.minimum(extent, picture.shape[1::-1]))
    half = 0.5 / np.array(fine.shape[1::-1])  # the picture's border does not repeat
    sums = np.zeros((size[1] * size[0], 5))
    at = np.flatnonzero(weights > 0)
    for first in range(0, len(at), AT_ONCE):
        some = at[first : first + AT_ONCE]
        place = np.stack([some % extent[0], some // extent[0]], 1)
        colours = baking.sampled(fine, np.clip((place + 0.5) / extent, half, 1 - half))
        colours[:, :3] *= colours[:, 3:]
        x, y = ((place + low) % size).T
        for channel, values in enumerate((*colours.T, 1)):
            sums[:, channel] += np.bincount(y * size[0] + x, weights[some] * values, len(sums))
    sums = sums.astype(np.float32).reshape(size[1], size[0], 5)
    colours, total = np.ascontiguousarray(sums[:, :, :4]), np.ascontiguousarray(sums[:, :, 4:])
    for values in (colours, total):
        wallpaper.symmetrize(values, "all")
    colours[:, :, :3] /= np.maximum(colours[:, :, 3:], LEAST)
    colours[:, :, 3:] /= np.maximum(total, LEAST)
    return colours


def _blurred(values: np.ndarray, reach: int) -> np.ndarray:
    """Means over three squares in turn, which reach so far together at most, or a texel."""
    radius = max(1, reach // 3)
    for _ in range(3 if reach >= 3 else 1):
        for axis in (0, 1):
            padded = np.pad(values, [(radius + 1, radius) if k == axis else (0, 0) for k in (0, 1)])
            sums = np.moveaxis(np.cumsum(padded, axis), axis, 0)
            values = np.moveaxis(sums[2 * radius + 1 :] - sums[: -2 * radius - 1], 0, axis) / (2 * radius + 1)
    return np.maximum(values, 0)


def _cut_to(picture: np.ndarray, extent: np.ndarray) -> np.ndarray:
    """The largest part in the picture's middle that is wide and high in this proportion."""
    height, width = picture.shape[:2]
    scale = min(width / extent[0], height / extent[1])
    w, h = (int(np.clip(round(scale * side), 1, most)) for side, most in zip(extent, (width, height)))
    x, y = (width - w) // 2, (height - h) // 2
    return picture[y : y + h, x : x + w]


def resized(picture: np.ndarray, width: int, height: int) -> np.ndarray:
    """(height, width, 4) of a picture that is not smaller: each texel is the mean of what it covers, by alpha."""
    covering = picture.astype(np.float64)
    covering[:, :, :3] *= covering[:, :, 3:]
    for axis, count in ((0, height), (1, width)):
        covering = _means(covering, count, axis)
    alpha = covering[:, :, 3:]
    covering[:, :, :3] = np.divide(covering[:, :, :3], alpha, out=np.zeros_like(covering[:, :, :3]), where=alpha > 0)
    return covering


def _means(values: np.ndarray, count: int, axis: int) -> np.ndarray:
    """So many means along an axis, of equal parts of it, which begin and end anywhere in an element."""
    length = values.shape[axis]
    if count == length:
        return values
    values = np.moveaxis(values, axis, 0)
    sums = np.concatenate([np.zeros_like(values[:1]), np.cumsum(values, axis=0)])
    ends = np.arange(count + 1) * length / count
    whole = np.minimum(ends.astype(int), length - 1)
    at_ends = sums[whole] + (ends - whole).reshape(-1, 1, 1) * values[whole]
    return np.moveaxis(np.diff(at_ends, axis=0) * (count / length), 0, axis)


def difference(pixels: np.ndarray, motions: np.ndarray) -> float:
    """The root of the mean square by which texels differ from what is looked up at their copies under the motions."""
    height, width = pixels.shape[:2]
    at = np.stack(np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height), -1)
    some = at[:: max(1, height // 256), :: max(1, width // 256)].reshape(-1, 2)
    own = baking.sampled(pixels, some)
    squares = [np.square(baking.sampled(pixels, some @ one[:, :2].T + one[:, 2]) - own).mean() for one in motions]
    return float(np.sqrt(np.mean(squares))) if squares else 0.0
