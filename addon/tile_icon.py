# SPDX-License-Identifier: GPL-3.0-or-later
"""A small drawing of a signature's tile, as pixels; no bpy. Sides are geodesics: straight in the plane, arcs of circles
in the stereographic and Poincaré charts. Mirrors are thick."""

from __future__ import annotations

import numpy as np

from . import core, group

STEPS = 24  # of a side
MARGIN = 0.12  # of the image
THIN, THICK = 0.018, 0.045  # half the width of a line, of the image
COLOURS = {1: (0.93, 0.62, 0.31), 0: (0.42, 0.68, 0.93), -1: (0.56, 0.80, 0.45)}  # by curvature
LINE = (0.93, 0.93, 0.93)
FARTHEST = 6.0  # in the stereographic chart: what lies near the point opposite to the middle is cut off
ANTIPODES = 1e-6


def tile_pixels(signature: str, size: int) -> np.ndarray:
    """(size, size, 4) float32, straight alpha, first row at the bottom. OrbifoldError as `core.tile_outline`."""
    outline = core.tile_outline(signature)
    sides = [_in_chart(_side(outline, k), outline.curvature) for k in range(len(outline.corners))]
    points = np.concatenate(sides)
    low, high = points.min(0), points.max(0)
    scale = (1 - 2 * MARGIN) / max((high - low).max(), 1e-9)
    sides = [0.5 + (side - (low + high) / 2) * scale for side in sides]
    y, x = (np.mgrid[0:size, 0:size] + 0.5) / size
    at = np.stack([x.ravel(), y.ravel()], -1)
    border = np.concatenate([side[:-1] for side in sides])
    colour = np.zeros((size * size, 4))
    _paint(colour, COLOURS[outline.curvature], _coverage(np.where(_inside(at, border), -1.0, 1.0), size))
    for mirror in (False, True):
        for side, is_mirror in zip(sides, outline.mirrors):
            if is_mirror == mirror:
                _paint(colour, LINE, _coverage(_distance(at, side) - (THICK if mirror else THIN), size))
    return colour.reshape(size, size, 4).astype(np.float32)


def _side(outline: core.Outline, number: int) -> np.ndarray:
    """(STEPS + 1, 3) points of the geodesic from a corner to the next."""
    p, q = outline.corners[number], outline.corners[(number + 1) % len(outline.corners)]
    t = np.linspace(0, 1, STEPS + 1)[:, None]
    if outline.curvature > 0 and np.linalg.norm(p + q) < ANTIPODES:
        return _half_circle(outline, number, t)
    if outline.curvature == 0:
        return p + t * (q - p)
    straight = (1 - _even(t, p, q, outline.curvature)) * p + _even(t, p, q, outline.curvature) * q
    return group.on_model(straight, outline.curvature)


def _even(t: np.ndarray, p: np.ndarray, q: np.ndarray, curvature: int) -> np.ndarray:
    """Where on the chord the points at even distances along the geodesic are seen."""
    length = float(group.distances(p[None], q[None], curvature)[0, 0])
    wave = np.sin if curvature > 0 else np.sinh
    if length < 1e-9:
        return t
    return wave(t * length) / (wave(t * length) + wave((1 - t) * length))


def _half_circle(outline: core.Outline, number: int, t: np.ndarray) -> np.ndarray:
    """Between antipodes, where any great circle would do: the sides of a lune about the direction (0, 0, 1), as wide
    as its signature's area says, are turned from there by half of the lune's angle each."""
    p = outline.corners[number]
    others = [c for c in outline.corners if min(np.linalg.norm(c - p), np.linalg.norm(c + p)) > 1e-3]
    middle = np.array([0.0, 0.0, 1.0])
    middle -= (middle @ p) * p
    middle /= np.linalg.norm(middle)
    aside = np.cross(p, middle)
    angle = _lune_angle(outline, others, p, middle, aside) / 2
    through = np.cos(angle) * middle - np.sin(angle) * aside  # counter-clockwise about the tile
    return np.cos(np.pi * t) * p + np.sin(np.pi * t) * through


def _lune_angle(outline: core.Outline, others: list, p: np.ndarray, middle: np.ndarray, aside: np.ndarray) -> float:
    """Twice the angle at which a third corner lies, on the side opposite to this one; else that of the area."""
    for corner in others:
        return 2 * abs(np.arctan2(corner @ aside, corner @ middle))
    return outline.area / 2


def _in_chart(points: np.ndarray, curvature: int) -> np.ndarray:
    """(k, 3) -> (k, 2) stereographic, plane, Poincaré."""
    if curvature == 0:
        return points[:, :2]
    flat = points[:, :2] / np.maximum(1 + points[:, 2:], 1e-6)
    size = np.linalg.norm(flat, axis=1, keepdims=True)
    return flat * np.minimum(1.0, FARTHEST / np.maximum(size, 1e-9))


def _inside(at: np.ndarray, border: np.ndarray) -> np.ndarray:
    """(k,) bool: an odd number of the border's edges to the right."""
    start, end = border, np.roll(border, -1, axis=0)
    crosses = (start[None, :, 1] > at[:, None, 1]) != (end[None, :, 1] > at[:, None, 1])
    rise = np.where(end[:, 1] == start[:, 1], 1.0, end[:, 1] - start[:, 1])
    x = start[:, 0] + (at[:, None, 1] - start[:, 1]) / rise * (end[:, 0] - start[:, 0])
    return (crosses & (x > at[:, None, 0])).sum(1) % 2 == 1


def _distance(at: np.ndarray, line: np.ndarray) -> np.ndarray:
    """(k,) to a polygonal line."""
    start, step = line[:-1], line[1:] - line[:-1]
    square = np.maximum((step**2).sum(1), 1e-18)
    part = np.clip(((at[:, None] - start) * step).sum(-1) / square, 0, 1)
    return np.linalg.norm(at[:, None] - start - part[..., None] * step, axis=-1).min(1)


def _coverage(signed: np.ndarray, size: int) -> np.ndarray:
    """How much of a pixel is covered by what lies within `signed` < 0."""
    return np.clip(0.5 - signed * size, 0, 1)


def _paint(colour: np.ndarray, over: tuple[float, float, float], coverage: np.ndarray) -> None:
    """Over what is there, in place."""
    alpha = coverage + colour[:, 3] * (1 - coverage)
    mixed = coverage[:, None] * np.array(over) + (colour[:, 3] * (1 - coverage))[:, None] * colour[:, :3]
    colour[:, :3] = mixed / np.maximum(alpha, 1e-9)[:, None]
    colour[:, 3] = alpha
