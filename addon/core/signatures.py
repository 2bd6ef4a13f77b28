# SPDX-License-Identifier: GPL-3.0-or-later
"""Conway's signatures: reading them, writing them, and what a menu can offer. The native library does the reading."""

from __future__ import annotations

import functools
from collections.abc import Iterable
from dataclasses import dataclass

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


@functools.lru_cache(maxsize=1024)  # a panel asks for the same few at every redraw
def parse_signature(signature: str) -> Signature:
    """OrbifoldError: ORB_BAD_SIGNATURE (`elements[0]`: position), ORB_BAD_ORDER, ORB_BAD_ORBIFOLD."""
    info, orders = binding.read_signature(signature)
    return Signature(
        signature, info.geometry.decode(), info.curvature, info.euler, tuple(orders), info.supported
    )


def geometry_of(signature: str) -> str:
    """ "spherical", "euclidean" or "hyperbolic"."""
    return parse_signature(signature).geometry


def format_signature(orders: Iterable[int]) -> str:
    """The signature of a sphere with these cones, in the sequence given: (2, 2, 12) -> "22(12)"."""
    return "".join(str(order) if 0 <= order <= 9 else f"({order})" for order in orders)


def _offers(n_cones: int) -> list[tuple[int, ...]]:
    """Orders worth offering for a number of cones, the most useful first."""
    if n_cones < 2:
        return []
    if n_cones == 2:
        return [(n, n) for n in range(2, 13)]
    if n_cones == 3:
        return [
            *[(4, 4, 2), (3, 3, 3), (6, 3, 2)],
            *[(4, 3, 2), (5, 3, 2), (3, 3, 2)],
            *[(2, 2, n) for n in range(2, 13)],
            *[(2, 3, 7), (2, 4, 5), (3, 3, 4), (4, 4, 4), (5, 5, 5), (6, 6, 6)],
        ]
    twos = (2,) * (n_cones - 1)
    return [(*twos, last) for last in (2, 3, 4, 5, 6)] + [(n,) * n_cones for n in (3, 4, 6)]


def suggest_signatures(n_cones: int) -> list[Signature]:
    """The signatures to offer where `n_cones` vertices have been picked, each with its geometry; none below two."""
    return [parse_signature(format_signature(orders)) for orders in _offers(n_cones)]
