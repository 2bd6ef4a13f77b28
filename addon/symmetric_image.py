# SPDX-License-Identifier: GPL-3.0-or-later
"""The symmetry that makes an image seamless on an object: the group of its layout, as motions of the unit square. Only
layouts of the plane have it, and only in `Periodic` is the unit square always a period."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from . import core
from .blender_mesh import BlenderMeshError
from .layouts import Layout

NEAR = 1e-3  # motions of two layouts that are the same one
NOT_PERIODIC = 1e-4  # of the unit square


@dataclass(frozen=True)
class Symmetry:
    owner: str  # the object's name
    signature: str
    motions: np.ndarray  # (n, 2, 3) of (u, v, 1); with the periods they generate the group
    uv: np.ndarray  # (m, 3, 2) the tile
    sides: np.ndarray  # (2, 2) of the period, along u and v, on the plane

    @property
    def tallness(self) -> float:
        """Of the period on the plane: its side along v by that along u."""
        along_u, along_v = np.linalg.norm(self.sides, axis=1)
        return float(along_v / along_u)

    def wallpaper(self, width: int, height: int) -> core.Wallpaper:
        return core.Wallpaper(width, height, self.motions, self.uv)

    def digest(self) -> bytes:
        """Of what a wallpaper is made of."""
        return hashlib.sha1(self.motions.tobytes() + self.uv.tobytes(), usedforsecurity=False).digest()

    def height_for(self, width: int) -> int:
        """That with which texels are as high as they are wide; where it is not the width, even: half a period is then
        a whole number of texels."""
        height = round(width * self.tallness)
        return max(1, height + (height % 2 if height != width else 0))


def symmetry_of(owner: str, layout: Layout) -> Symmetry:
    """Of the layout of an object. BlenderMeshError where no image repeats on it."""
    if layout.lattice is None:
        raise BlenderMeshError(
            f"No image repeats on the layout of {owner}: unwrap it with a signature of the plane, such as 442 or 2222"
        )
    if np.abs(layout.lattice[:2] - np.eye(2)).max() > NOT_PERIODIC:
        raise BlenderMeshError(
            f"The unit square is no period of the layout of {owner}: choose the layout Periodic in Orbifold Unwrap"
        )
    to_uv = layout.to_cells - [[0, 0], [0, 0], layout.lattice[2]]
    sides = np.linalg.inv(to_uv[:2])
    return Symmetry(owner, layout.signature, motions_of(layout.generators, to_uv), layout.uv, sides)


def motions_of(generators: np.ndarray, to_uv: np.ndarray) -> np.ndarray:
    """(n, 2, 3): isometries (n, 3, 3) of the plane's (x, y, 1) as motions of (u, v), to which `to_uv` (3, 2)
    takes (x, y, 1)."""
    moved = generators.transpose(0, 2, 1) @ to_uv
    turns = np.linalg.inv(to_uv[:2]) @ moved[:, :2]
    shifts = moved[:, 2] - to_uv[2] @ turns
    return np.concatenate([turns.transpose(0, 2, 1), shifts[:, :, None]], 2)


def joined(symmetries: Sequence[Symmetry], image: str) -> Symmetry:
    """The first one, if the others have the same group. BlenderMeshError where they have not."""
    first = symmetries[0]
    for other in symmetries[1:]:
        if not _same(_group(first), _group(other)):
            raise BlenderMeshError(
                f"{first.owner} ({first.signature}) and {other.owner} ({other.signature}) share {image}, and their "
                "layouts have different symmetries: give one of them an image of its own"
            )
    return first


def _group(symmetry: Symmetry) -> np.ndarray:
    """(order, 2, 3) all motions, up to periods."""
    return core.Wallpaper(4, 4, symmetry.motions).motions


def _same(one: np.ndarray, other: np.ndarray) -> bool:
    apart = one[:, None] - other
    apart[..., 2] -= np.round(apart[..., 2])
    return len(one) == len(other) and bool((np.abs(apart).max((2, 3)) < NEAR).any(1).all())


def described(symmetry: Symmetry, wallpaper: core.Wallpaper) -> str:
    """How an image has been made symmetric, for a message."""
    if wallpaper.order == 1:
        return f"{symmetry.signature} has no copies: any image that repeats is seamless"
    told = f"{symmetry.signature} has {wallpaper.order} copies of each place"
    if wallpaper.exact:
        return f"{told}, exact"
    told = f"{told}, interpolated"
    height = symmetry.height_for(wallpaper.width)
    if height == wallpaper.height:
        return told
    return f"{told}; at {wallpaper.width} x {height} texels would be square on the mesh"
