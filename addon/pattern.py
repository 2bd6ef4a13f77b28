# SPDX-License-Identifier: GPL-3.0-or-later
"""An image in the layout's own coordinates whose pattern the orbifold's group leaves as it is.

The colour of a point follows from its distances to the images of the cones under the group. Points that the group
carries to one another, so the two sides of every seam too, have the same distances: seen on the mesh, the pattern
crosses the seams without a break, whatever the geometry. The distances to all images of a cone are joined to one
smooth function (a soft minimum), lest the lines between two cones' regions, or mirrors, look like seams. Mirror
corners count as cones do; an orbifold with fewer than two of them has other centres instead.
"""

from __future__ import annotations

import colorsys

import numpy as np

from . import group
from .core import Result
from .core.charts import CURVATURE, Chart, chart_of
from .faces import FaceLayout

BLOCK, LEAST_BLOCK = 32, 4  # pixels; the orbit points that matter are looked up once for each block
LEAST_CENTRES = 2
RINGS = 20.0  # per square root of the tile's area
WIDEST_RING = 0.15  # in the hyperbolic plane, where the number of tiles near by grows exponentially with it
SOFTNESS = 1.5  # of the minimum, in rings
TAIL = 9.0  # orbit points farther than the nearest by this many softnesses are left out: exp(-9) of a ring's phase
BACKGROUND = (0.5, 0.5, 0.5)
REPEATING = ("periodic", "equirectangular")  # charts in which an image has to repeat


def image(result: Result, layout: FaceLayout, size: int = 1024) -> np.ndarray:
    """(size, size, 4) float32, size a multiple of BLOCK, first row at the bottom: the pattern on the unit square of
    the layout. Where that repeats, so does the image; elsewhere it is drawn about the layout only."""
    corners = layout.embedding
    chart = chart_of(layout.chart, result.geometry, corners, layout.uv)
    curvature = CURVATURE[result.geometry]
    spacing = ring_spacing(result)
    orbits = orbits_of(result, layout, chart, spacing)
    pixels = np.ones((size, size, 4), np.float32)
    pixels[..., :3] = BACKGROUND
    blocks = np.ones((size // BLOCK, size // BLOCK), bool)
    if layout.chart not in REPEATING:
        blocks = _covered_blocks(layout.uv, size // BLOCK)
    waiting = [(y, x, BLOCK, orbits) for y, x in (np.argwhere(blocks) * BLOCK).tolist()]
    while waiting:
        row, column, side, orbits = waiting.pop()
        y, x = np.mgrid[row : row + side, column : column + side]
        points = chart.to_point((np.stack([x.ravel(), y.ravel()], -1) + 0.5) / size)
        inside = np.isfinite(points).all(-1)
        if not inside.any():
            continue
        orbits = [_that_count(points[inside], orbit, curvature, SOFTNESS * spacing) for orbit in orbits]
        if side > LEAST_BLOCK and not (inside.all() and _width(points, curvature) < 2 * SOFTNESS * spacing):
            half = side // 2  # few of the orbit count only where the points are near one another
            waiting += [(row + i, column + j, half, orbits) for i in (0, half) for j in (0, half)]
            continue
        colours = np.tile(np.float32(BACKGROUND), (len(points), 1))
        colours[inside] = colour_at(points[inside], orbits, curvature, spacing)
        pixels[row : row + side, column : column + side, :3] = colours.reshape(*x.shape, 3)
    return pixels


def _covered_blocks(uv: np.ndarray, blocks: int) -> np.ndarray:
    """(blocks, blocks) bool, rows from below: those of the unit square that a triangle's bounding box touches, and
    their neighbours."""
    low = np.clip(np.floor(uv.min(1) * blocks).astype(int) - 1, 0, blocks)
    high = np.clip(np.floor(uv.max(1) * blocks).astype(int) + 2, 0, blocks)
    steps = np.zeros((blocks + 1, blocks + 1), int)
    for x, y, step in ((low, low, 1), (high, low, -1), (low, high, -1), (high, high, 1)):
        np.add.at(steps, (y[:, 1], x[:, 0]), step)
    return steps.cumsum(0).cumsum(1)[:blocks, :blocks] > 0


def colour_at(points: np.ndarray, orbits: list[np.ndarray], curvature: int, spacing: float) -> np.ndarray:
    """(k, 3) points near one another -> (k, 3) colours: rings about the cones, each cone with its hue."""
    softness = SOFTNESS * spacing
    nearness = np.stack([_nearness(points, orbit, curvature, softness) for orbit in orbits])  # (cones, k)
    total = np.logaddexp.reduce(nearness, axis=0)
    weight = np.exp(0.4 * (nearness - total))
    colours = (weight / weight.sum(0)).T @ palette(len(orbits))
    wave = np.cos(2 * np.pi * SOFTNESS * total)
    shade = 0.5 + 0.5 * np.clip(3 * wave, -1, 1)  # rings with soft edges
    return (0.3 + 0.7 * shade[:, None]) * colours


def palette(n: int) -> np.ndarray:
    """(n, 3) hues around the circle."""
    return np.array([colorsys.hsv_to_rgb((0.03 + i / n) % 1, 0.75, 0.95) for i in range(n)])


# ------------------------------------------------------------------------------------------------- the group


def orbits_of(result: Result, layout: FaceLayout, chart: Chart, spacing: float) -> list[np.ndarray]:
    """For each cone and corner (or other centre, where there are fewer than two) the images (., 3) that count
    anywhere in the layout or, where that repeats, in the unit square."""
    curvature = CURVATURE[result.geometry]
    of_tile = group.Group(result.generators, curvature, result.embedding[result.cut_triangles].reshape(-1, 3))
    seen, gap = group.sample(_seen(layout, chart), curvature, 4 * group.SAMPLES)
    centres = [of_tile.representative(cone) for cone in result.embedding[result.cones]]
    tail = TAIL * SOFTNESS * spacing
    reach = np.full(len(seen), tail)
    while True:
        elements = of_tile.near(seen, reach + gap)
        found = [_images(elements, centre) for centre in centres]
        while len(found) < LEAST_CENTRES:
            centres.append(of_tile.representative(_new_centre(of_tile.tile, found, curvature)))
            found.append(_images(elements, centres[-1]))
        wanted = np.max([group.distances(seen, orbit, curvature).min(1) for orbit in found], axis=0) + tail
        if (reach >= wanted).all() or len(elements) >= group.CAP:
            return [_near_enough(orbit, seen, wanted + gap, curvature) for orbit in found]
        reach = np.clip(wanted, reach, reach + tail)


def _near_enough(orbit: np.ndarray, seen: np.ndarray, reach: np.ndarray, curvature: int) -> np.ndarray:
    """Those of an orbit that are within reach of one of the points `seen` (s, 3), of each its own reach (s,)."""
    return orbit[(group.distances(orbit, seen, curvature) <= reach).any(1)]


def _seen(layout: FaceLayout, chart: Chart) -> np.ndarray:
    """(k, 3) points of the layout, and of the whole image where that repeats in the plane."""
    corners = layout.embedding.reshape(-1, 3)
    if layout.chart != "periodic":
        return corners
    grid = np.stack(np.meshgrid(*[np.linspace(0, 1, 17)] * 2), -1).reshape(-1, 2)
    step = max(1, len(corners) // group.CANDIDATES)
    return np.concatenate([corners[::step], np.repeat(chart.to_point(grid), step, axis=0)])


def _images(elements: np.ndarray, point: np.ndarray) -> np.ndarray:
    """(., 3) where the elements carry a point; a cone, which several of them leave where it is, counts once."""
    images = elements @ point
    return images[group.distinct(images, 1e-5)]


def _new_centre(tile: np.ndarray, orbits: list[np.ndarray], curvature: int) -> np.ndarray:
    """The point of the tile farthest from all images of the centres so far; at first that in its middle."""
    if not orbits:
        return tile[0]
    return tile[int(np.argmax(group.distances(tile, np.concatenate(orbits), curvature).min(1)))]


# ------------------------------------------------------------------------------------------------- distances


def _nearness(points: np.ndarray, orbit: np.ndarray, curvature: int, softness: float) -> np.ndarray:
    """(k,) log of the sum of exp(-distance / softness) over the orbit: minus the soft minimum of the distances, in
    units of softness. The points are near one another, so that few of the orbit count."""
    candidates = _that_count(points, orbit, curvature, softness)
    distances = group.distances(points, candidates, curvature) / softness
    least = distances.min(1)
    return np.log(np.exp(least[:, None] - distances).sum(1)) - least


def _that_count(points: np.ndarray, orbit: np.ndarray, curvature: int, softness: float) -> np.ndarray:
    """Those of an orbit that are nearly as near to one of the points as the nearest, or nearer."""
    middle = points[len(points) // 2][None]
    from_middle = group.distances(orbit, middle, curvature)[:, 0]
    reach = 2 * _width(points, curvature) + TAIL * softness
    return orbit[from_middle <= from_middle.min() + reach]


def _width(points: np.ndarray, curvature: int) -> float:
    """The greatest distance from the middle one of the points."""
    return float(group.distances(points, points[len(points) // 2][None], curvature).max())


def ring_spacing(result: Result) -> float:
    """From the tile's area: 2 pi |chi|, or the sum of its triangles, each as flat as it nearly is."""
    curvature = CURVATURE[result.geometry]
    if curvature and result.signature:
        area = 2 * np.pi * abs(result.report["orbifold"]["euler"])
    else:
        p, q, r = result.embedding[result.cut_triangles].transpose(1, 0, 2)
        form = np.array([1.0, 1.0, curvature])
        aa, bb, ab = (((u - p) * (v - p) * form).sum(1) for u, v in ((q, q), (r, r), (q, r)))
        area = np.sqrt(np.maximum(aa * bb - ab**2, 0)).sum() / 2
    return min(float(np.sqrt(area)) / RINGS, WIDEST_RING if curvature < 0 else np.inf)
