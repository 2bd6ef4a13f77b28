# SPDX-License-Identifier: GPL-3.0-or-later
"""The vertices that are picked on a mesh, in the sequence of a signature: cones as they were picked, then the mirror
corners along each boundary loop; no bpy.

A person picks in any sequence; a signature names its cones first and then, after each *, the corners in the sequence
in which its mirror meets them. A loop begins with the corner that was picked first and runs towards the second one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Optional

import numpy as np

from . import core


@dataclass(frozen=True)
class Arrangement:
    """Places count in the list of picks, from 0."""

    cones: tuple[int, ...]  # places of picks inside the surface
    borders: tuple[tuple[int, ...], ...]  # of those on each boundary loop that is a mirror, in turn along it
    handles: int
    crosscaps: int

    @property
    def n_corners(self) -> int:
        return sum(map(len, self.borders))

    @property
    def sequence(self) -> list[int]:
        return [*self.cones, *(place for border in self.borders for place in border)]

    def text(self, orders: Sequence[int]) -> str:
        """The signature of picks with these orders (by place); empty for a sphere without cones."""
        borders = [[orders[place] for place in border] for border in self.borders]
        return core.format_signature([orders[place] for place in self.cones], borders, self.handles, self.crosscaps)

    def matched(self, read: core.Signature) -> Optional[list[int]]:
        """The places in the sequence of this signature. None where it has fewer cones, or fewer corners, than are
        picked; the last ones are missing where it has more."""
        if len(self.cones) > read.n_interior or self.n_corners > len(read.orders) - read.n_interior:
            return None
        left = list(self.borders)
        found = []
        for wanted in read.borders:  # each mirror takes a loop with as many corners
            border = next((border for border in left if len(border) == len(wanted)), None)
            if border is None:
                return self.sequence
            left.remove(border)
            found += border
        return [*self.cones, *found] if not any(left) else self.sequence

    def orders_from(self, read: core.Signature) -> Optional[list[int]]:
        """The order, by place, that a signature gives to each pick; None as in `matched`."""
        places = self.matched(read)
        if places is None:
            return None
        orders = [0] * len(places)
        corners = read.orders[read.n_interior :]
        given = [*read.cone_orders[: len(self.cones)], *corners]
        for place, order in zip(places, given):
            orders[place] = order
        return orders


def arrange(vertices: Sequence[int], surface: core.Topology, all_mirrors: bool) -> Arrangement:
    """Of picks at these vertices on this surface; in several pieces, or no manifold: all picks are cones. Whether
    loops without picks are mirrors too is the caller's choice."""
    places = range(len(vertices))
    if surface.components != 1 or surface.genus < 0:
        return Arrangement(tuple(places), (), 0, 0)
    at = {int(vertex): place for place, vertex in enumerate(vertices)}
    borders = [border for border in (_along(loop, at) for loop in surface.loops) if border or all_mirrors]
    borders.sort(key=lambda border: border[0] if border else len(vertices))
    on_border = {place for border in borders for place in border}
    cones = tuple(place for place in places if place not in on_border)
    genus = surface.genus
    return Arrangement(cones, tuple(borders), *((genus, 0) if surface.orientable else (0, genus)))


def in_sequence(vertices: Sequence[int], surface: core.Topology, signature: str) -> list[int]:
    """These picks in the sequence of a signature, as `core.embed` takes them; as they are where they do not fit it.
    OrbifoldError where it does not parse."""
    read = core.parse_signature(signature)
    places = arrange(vertices, surface, read.n_mirrors == len(surface.loops)).matched(read)
    return [vertices[place] for place in (places or range(len(vertices)))]


def _along(loop: np.ndarray, at: dict[int, int]) -> tuple[int, ...]:
    """The places of the picks on a loop, in turn from the one picked first towards the one picked second."""
    met = [at[vertex] for vertex in loop[np.isin(loop, list(at))].tolist()] if at else []
    if not met:
        return ()
    first, second = sorted(met)[:2] if len(met) > 1 else (met[0], met[0])
    start = met.index(first)
    forward = met[start:] + met[:start]
    backward = [forward[0], *reversed(forward[1:])]
    return tuple(forward if forward.index(second) <= backward.index(second) else backward)
