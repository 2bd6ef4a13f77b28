# SPDX-License-Identifier: GPL-3.0-or-later
"""Images that a wallpaper group leaves as they are: seamless on a mesh with the layout of an orbifold of the plane.

    wallpaper = Wallpaper(2048, 2048, motions, uv)
    wallpaper.symmetrize(pixels)                      # copies become what the tile has
"""

from __future__ import annotations

import os

import numpy as np
from numpy.typing import ArrayLike

from . import binding
from .arrays import integers, unknown
from .errors import OrbifoldError


class Wallpaper:
    """The texels of an image of one size under a group; of those that are copies of one another one is kept, on the
    tile, and the others follow from it. To be used again for images of this size."""

    def __init__(
        self, width: int, height: int, motions: ArrayLike, uv: ArrayLike | None = None, threads: int | None = None
    ) -> None:
        """`motions` (n, 2, 3): affine maps of the unit square, which is a period of the group that they generate; row
        (a, b, c) gives a u + b v + c. `uv` (m, 3, 2): the triangles of a tile; None: one is chosen. OrbifoldError
        "ORB_BAD_ARGUMENT" where the unit square is no period."""
        self.width, self.height = int(width), int(height)
        self._threads = threads or os.cpu_count() or 1
        generators = np.array(motions, np.float64).reshape(-1, 6)
        triangles = np.array(() if uv is None else uv, np.float64).reshape(-1, 6)
        self._native = binding.Wallpaper(self.width, self.height, generators, triangles, self._threads)

    @property
    def order(self) -> int:
        """Copies of a texel, itself included."""
        return self._native.view.order

    @property
    def exact(self) -> bool:
        """All motions take texels to texels. Otherwise copies are interpolated."""
        return self._native.view.exact

    @property
    def motions(self) -> np.ndarray:
        """(order, 2, 3), the identity first."""
        return binding.copied(self._native.view.motions, self.order, 2, 3)

    @property
    def to_tile(self) -> np.ndarray:
        """(height, width) uint16 the number of the motion that takes a texel onto the tile; 0: it is of the tile."""
        return binding.copied(self._native.view.to_tile, self.height, self.width)

    def symmetrize(
        self, pixels: np.ndarray, source: str = "tile", painted: np.ndarray | None = None,
        area: tuple[int, int, int, int] | None = None,
    ) -> None:
        """Makes (height, width, channels) uint8, uint16 or float32, first row at v = 0, invariant, in place.

        source  "tile": copies become what the tile has; "all": their mean; "painted": what the one has where `painted`
                (height, width), bool or uint8, how much was painted, is greatest, and where it is 0 on all they stay
        area    x, y, width, height: what is outside of it is not painted. The time is in proportion to it
        """
        if source not in binding.SOURCES:
            raise unknown("source", source, binding.SOURCES)
        check_pixels(pixels)
        mask = None
        if source == "painted":
            mask = np.zeros(0, np.uint8) if painted is None else np.ascontiguousarray(painted)
            if mask.dtype != np.uint8:
                mask = (mask != 0).astype(np.uint8)
            if mask.shape != pixels.shape[:2]:
                raise OrbifoldError(
                    "ORB_BAD_ARGUMENT", f"what is painted has the shape {mask.shape}; give one number for each of "
                    f"{pixels.shape[:2]} texels"
                )
        box = None if area is None else np.array(area, np.int32).reshape(4)
        self._native.apply(pixels, binding.SOURCES[source], mask, box, self._threads)


def fill_seam_margin(
    pixels: np.ndarray, triangles: ArrayLike, uv: ArrayLike, texels: int, repeats: bool = False
) -> None:
    """Fills the texels around the islands of any UV map, in place, so far that filters and mipmaps read what they would
    if there were no seams: where the surface goes on across a seam, there the image goes on too.

    pixels     (height, width, channels) uint8, uint16 or float32, first row at v = 0
    triangles  (m, 3) vertices of the mesh; uv (m, 3, 2)
    texels     how far: 2^k for the k-th mipmap
    repeats    the image does, and islands may lie anywhere
    """
    check_pixels(pixels)
    faces = integers(triangles, (-1, 3), "triangles", "ORB_INDEX_OUT_OF_RANGE", "triangle")
    points = np.array(uv, np.float64, order="C")
    if points.shape != (len(faces), 3, 2):
        raise OrbifoldError(
            "ORB_BAD_ARGUMENT", f"the UVs have the shape {points.shape}; give (u, v) for each corner of {len(faces)} "
            "triangles"
        )
    binding.fill_seam_margin(pixels, repeats, faces, points, texels)


def check_pixels(pixels: np.ndarray) -> None:
    if (
        not isinstance(pixels, np.ndarray) or pixels.dtype.name not in binding.TEXELS or pixels.ndim != 3
        or not pixels.flags.c_contiguous or not pixels.flags.writeable
    ):
        raise OrbifoldError(
            "ORB_BAD_ARGUMENT", "the pixels are no contiguous array (height, width, channels) of uint8, uint16 or "
            "float32 that can be written to"
        )
