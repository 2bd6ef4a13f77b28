# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles with texture coordinates, cut off at a circle about the origin of the plane."""

from __future__ import annotations

import numpy as np


def clip_to_disk(corners: np.ndarray, uv: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """corners (m, 3, 2) and uv (m, 3, 2) -> those of the parts inside. Each triangle that the circle crosses is cut
    along the circle's tangent in the direction of its own middle."""
    far = np.linalg.norm(corners, axis=2).max(axis=1) > radius
    whole, crossing = ~far, np.flatnonzero(far)
    parts, part_uv = [corners[whole]], [uv[whole]]
    middle = corners[crossing].mean(axis=1)
    direction = middle / np.maximum(np.linalg.norm(middle, axis=1, keepdims=True), 1e-300)
    depth = radius - np.einsum("mkx,mx->mk", corners[crossing], direction)  # negative: outside
    n_inside = (depth > 0).sum(axis=1)
    parts.append(corners[crossing[n_inside == 3]])
    part_uv.append(uv[crossing[n_inside == 3]])
    for count in (1, 2):  # turn the corner that is alone on its side to the front, cut its two edges
        chosen = np.flatnonzero(n_inside == count)
        alone = np.argmax((depth[chosen] > 0) == (count == 1), axis=1)
        order = (alone[:, None] + np.arange(3)) % 3
        at = np.take_along_axis(depth[chosen], order, 1)
        points = np.take_along_axis(corners[crossing[chosen]], order[..., None], 1)
        texture = np.take_along_axis(uv[crossing[chosen]], order[..., None], 1)
        for values, store in ((points, parts), (texture, part_uv)):
            a, b, c = values[:, 0], values[:, 1], values[:, 2]
            ab = a + (at[:, 0] / (at[:, 0] - at[:, 1]))[:, None] * (b - a)
            ac = a + (at[:, 0] / (at[:, 0] - at[:, 2]))[:, None] * (c - a)
            store += [np.stack([a, ab, ac], 1)] if count == 1 else [np.stack([ab, b, c], 1), np.stack([ab, c, ac], 1)]
    return np.concatenate(parts), np.concatenate(part_uv)
