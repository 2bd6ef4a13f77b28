# SPDX-License-Identifier: GPL-3.0-or-later
"""An image by one mesh's UV map -> an image by another's, through their surface map; arrays only, no bpy.

Each texel of the target's map is a point of the target, which has a place on the source, and there a place in the
source's image. So neither mesh's seams can be seen, and no vertex is asked for anything."""

from __future__ import annotations

from collections.abc import Callable, Generator

import numpy as np

from .steps import Step

MARGIN = 8  # texels around the faces that take the colours beside them: filtering reads across a border
LARGEST = 4  # images that a triangle may reach across
AT_ONCE = 500_000  # texels of bounding boxes that are held at a time

Spots = tuple[np.ndarray, np.ndarray]  # (p,) triangles, -1 for none, and (p, 3) barycentric coordinates


def bake(
    target_uv: np.ndarray, width: int, height: int, on_source: Callable[[np.ndarray, np.ndarray], Spots],
    source_uv: np.ndarray, pixels: np.ndarray,
) -> Generator[Step, None, np.ndarray]:
    """(height, width, 4) by the UV map (m, 3, 2) of the target's triangles: what `pixels` (h, w, 4) has by the
    `source_uv` (m', 3, 2) where `on_source` maps the points of the target to, and the colours beside it for MARGIN
    texels. Without alpha where there is nothing. A step for each portion of the triangles."""
    image, covered = yield from on_islands(target_uv, width, height, on_source, source_uv, pixels)
    return _spread(image, covered)


def on_islands(
    target_uv: np.ndarray, width: int, height: int, on_source: Callable[[np.ndarray, np.ndarray], Spots],
    source_uv: np.ndarray, pixels: np.ndarray,
) -> Generator[Step, None, tuple[np.ndarray, np.ndarray]]:
    """The same without a margin, and (height, width) which texels have got something."""
    image = np.zeros((height * width, 4))
    covered = np.zeros(height * width, bool)
    for first, last in portions(target_uv, width, height):
        yield "image", first / len(target_uv)
        texels, triangles, barycentric = texels_of(target_uv[first:last], width, height)
        at, where = on_source(triangles + first, barycentric)
        known = at >= 0
        places = np.einsum("pc,pcd->pd", where[known], source_uv[at[known]])
        image[texels[known]] = sampled(pixels, places)
        covered[texels[known]] = True
    return image.reshape(height, width, 4), covered.reshape(height, width)


def _boxes(uv: np.ndarray, width: int, height: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Corners in texels (m, 3, 2), whose centres are whole numbers; the first texel of each box and its size (m, 2).
    Layouts may lie beyond the unit square, for images repeat."""
    points = uv * [width, height] - 0.5
    low = np.ceil(points.min(1) - 1e-6).astype(np.int64)
    size = np.maximum(np.floor(points.max(1) + 1e-6).astype(np.int64) - low + 1, 0)
    return points, low, np.where((size > LARGEST * np.array([width, height])).any(1)[:, None], 0, size)


def portions(uv: np.ndarray, width: int, height: int) -> list[tuple[int, int]]:
    """Triangles from, to, so that their boxes do not have too many texels in all."""
    _, _, size = _boxes(uv, width, height)
    part = np.cumsum(size.prod(1)) // AT_ONCE
    starts = np.flatnonzero(np.diff(part, prepend=-1))
    return list(zip(starts.tolist(), [*starts[1:].tolist(), len(uv)]))


def texels_of(uv: np.ndarray, width: int, height: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(p,) the texels whose centres lie in triangles (m, 3, 2), which triangles, and (p, 3) where in these."""
    points, low, size = _boxes(uv, width, height)
    counts = size.prod(1)
    triangle = np.repeat(np.arange(len(uv)), counts)
    number = np.arange(len(triangle)) - np.repeat(np.cumsum(counts) - counts, counts)
    x = low[triangle, 0] + number % np.maximum(size[triangle, 0], 1)
    y = low[triangle, 1] + number // np.maximum(size[triangle, 0], 1)
    corner, sides = points[:, 0], points[:, 1:] - points[:, :1]
    area = sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]
    to = np.stack([x, y], 1) - corner[triangle]
    one, other = sides[triangle, 0], sides[triangle, 1]
    with np.errstate(divide="ignore", invalid="ignore"):
        second = (to[:, 0] * other[:, 1] - to[:, 1] * other[:, 0]) / area[triangle]
        third = (one[:, 0] * to[:, 1] - one[:, 1] * to[:, 0]) / area[triangle]
    barycentric = np.stack([1 - second - third, second, third], 1)
    inside = (barycentric >= -1e-6).all(1)  # not where it is no number
    barycentric = np.maximum(barycentric[inside], 0.0)
    return (y % height * width + x % width)[inside], triangle[inside], barycentric / barycentric.sum(1, keepdims=True)


def sampled(pixels: np.ndarray, uv: np.ndarray) -> np.ndarray:
    """(p, 4) of an image (h, w, 4) that repeats, at texture coordinates (p, 2), bilinear."""
    height, width = pixels.shape[:2]
    place = uv * [width, height] - 0.5
    low = np.floor(place).astype(np.int64)
    (u, v), (x, y) = (place - low).T[:, :, None], low.T
    below = (1 - u) * pixels[y % height, x % width] + u * pixels[y % height, (x + 1) % width]
    above = (1 - u) * pixels[(y + 1) % height, x % width] + u * pixels[(y + 1) % height, (x + 1) % width]
    return (1 - v) * below + v * above


def _spread(image: np.ndarray, covered: np.ndarray) -> np.ndarray:
    """Texels beside covered ones get the mean of those, again and again, MARGIN times."""
    for _ in range(MARGIN):
        sums, counts = np.zeros_like(image), np.zeros(covered.shape)
        for axis in (0, 1):
            for step in (1, -1):
                beside = np.roll(covered, step, axis)
                sums += np.roll(image, step, axis) * beside[:, :, None]
                counts += beside
        new = ~covered & (counts > 0)
        image[new] = sums[new] / counts[new][:, None]
        covered = covered | new
    return image
