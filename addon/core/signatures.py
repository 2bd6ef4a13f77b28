# SPDX-License-Identifier: GPL-3.0-or-later
"""Conway's signatures: reading and writing them, and saying them in words. The native library does the reading."""

from __future__ import annotations

import functools
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from . import binding


@dataclass(frozen=True)
class Signature:
    """A signature as read. `euler` is the orbifold's Euler characteristic, `orders` those of all cones and corners."""

    signature: str
    geometry: str  # "spherical", "euclidean", "hyperbolic"
    curvature: int  # 1, 0, -1
    euler: float
    orders: tuple[int, ...]
    supported: bool  # whether `embed` takes it
    n_interior: int  # of the orders, the first ones: those of cones
    borders: tuple[tuple[int, ...], ...]  # the orders of each mirror's corners; they follow those of the cones
    n_crosscaps: int
    n_handles: int

    @property
    def n_mirrors(self) -> int:
        return len(self.borders)

    @property
    def cone_orders(self) -> tuple[int, ...]:
        return self.orders[: self.n_interior]


@functools.lru_cache(maxsize=4096)  # a panel asks for the same few at every redraw
def parse_signature(signature: str) -> Signature:
    """OrbifoldError: ORB_BAD_SIGNATURE (`elements[0]`: position), ORB_BAD_ORDER, ORB_BAD_ORBIFOLD."""
    info, orders = binding.read_signature(signature)
    return Signature(
        *(signature, info.geometry.decode(), info.curvature, info.euler, tuple(orders), info.supported),
        *(info.n_interior, _borders(signature), info.n_crosscaps, info.n_handles),
    )


def _borders(signature: str) -> tuple[tuple[int, ...], ...]:
    """Of a signature that parses: the orders between one * and the next."""
    parts = signature.split("*")[1:]
    return tuple(tuple(int(big or small) for big, small in re.findall(r"\((\d+)\)|(\d)", part)) for part in parts)


def geometry_of(signature: str) -> str:
    """ "spherical", "euclidean" or "hyperbolic"."""
    return parse_signature(signature).geometry


def format_signature(
    orders: Iterable[int], borders: Iterable[Iterable[int]] = (), handles: int = 0, crosscaps: int = 0
) -> str:
    """The signature with these orders of cones and of each mirror's corners, in the sequence given:
    (2, 2, 12) -> "22(12)", (4,) and [(2,)] -> "4*2", () and [(), ()] -> "**"."""

    def digits(of: Iterable[int]) -> str:
        return "".join(str(order) if 0 <= order <= 9 else f"({order})" for order in of)

    mirrors = "".join(f"*{digits(corners)}" for corners in borders)
    return "o" * handles + digits(orders) + mirrors + "x" * crosscaps


@dataclass(frozen=True)
class Outline:
    """The tile of a signature's simplest cut."""

    corners: np.ndarray  # (k, 3) points of the geometry's model, counter-clockwise
    mirrors: np.ndarray  # (k,) bool: whether the side from each corner to the next is a mirror
    curvature: int
    area: float  # of the orbifold, 2 pi |euler|; 0 in the plane


def tile_outline(signature: str) -> Outline:
    """For drawings. OrbifoldError as `parse_signature`, or ORB_UNSUPPORTED_SIGNATURE."""
    corners, mirrors = binding.signature_tile(signature)
    read = parse_signature(signature)
    return Outline(corners, mirrors, read.curvature, 2 * np.pi * abs(read.euler) if read.curvature else 0.0)


# ------------------------------------------------------------------------------------------------- in words


def describe(signature: str) -> str:
    """ "4*2: disk with a cone of 90 degrees and a mirror corner of 90 degrees"."""
    read = parse_signature(signature)
    features = _angles("cone", [360 / order for order in read.cone_orders])
    corners = [180 / order for border in read.borders for order in border]
    features += _angles("mirror corner", corners)
    text = f"{signature}: {surface_name(read.n_handles, read.n_crosscaps, read.n_mirrors)}"
    if features:
        text += f" with {' and '.join(features)}"
    if read.n_mirrors and not corners:
        text += f", {_all_mirrors(read.n_mirrors)}"
    return text


def _all_mirrors(count: int) -> str:
    if count == 1:
        return "its border a mirror"
    return "both borders mirrors" if count == 2 else f"all {count} borders mirrors"


def _angles(name: str, degrees: Sequence[float]) -> list[str]:
    if not degrees:
        return []
    words = [f"{angle:.4g}" for angle in degrees]
    if len(words) == 1:
        return [f"a {name} of {words[0]} degrees"]
    if len(words) > 3 and len(set(words)) == 1:
        return [f"{len(words)} {name}s of {words[0]} degrees"]
    return [f"{name}s of {', '.join(words[:-1])} and {words[-1]} degrees"]


def surface_name(handles: int, crosscaps: int, borders: int) -> str:
    """ "disk", "torus with 2 borders", ... Three cross-caps are a handle and a cross-cap."""
    if crosscaps:
        crosscaps += 2 * handles
        if borders == 1 and crosscaps == 1:
            return "Möbius band"
        names = {1: "projective plane", 2: "Klein bottle"}
        name = names.get(crosscaps, f"surface with {crosscaps} cross-caps")
    else:
        if handles == 0 and borders in (1, 2):
            return ("disk", "annulus")[borders - 1]
        names = {0: "sphere", 1: "torus"}
        name = names.get(handles, f"surface of genus {handles}")
    if borders:
        name += f" with {borders} border{'s' if borders > 1 else ''}"
    return name
