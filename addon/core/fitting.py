# SPDX-License-Identifier: GPL-3.0-or-later
"""Which signatures fit a mesh and the vertices that are picked on it: what a menu can offer."""

from __future__ import annotations

import functools
import itertools
from collections.abc import Sequence
from fractions import Fraction

from .errors import OrbifoldError
from .signatures import Signature, format_signature, parse_signature

LARGEST_ORDER = 12  # of the families NN, 22N, *NN, ...
SINGLE = (2, 3, 4, 5, 6, 8)  # orders worth offering where one cone makes the orbifold hyperbolic
LAST = (3, 4, 5, 6, 7)
ALIKE = (2, 3, 4, 5, 6)
TRIANGLES = ((2, 3, 7), (2, 4, 5), (3, 3, 4), (4, 4, 4), (5, 5, 5), (6, 6, 6))


def fitting_signatures(
    euler: int,
    boundary_loops: int,
    genus: int,
    orientable: bool,
    n_interior_picks: int,
    n_boundary_picks_per_loop: Sequence[int] = (),
) -> list[Signature]:
    """The signatures that the library embeds whose surface has these invariants (of the mesh; `genus` is the number
    of cross-caps where it is not orientable), with so many cones and so many corners on each boundary loop: all
    spherical and Euclidean ones with orders up to 12, then useful hyperbolic ones."""
    handles, crosscaps = (genus, 0) if orientable else (0, genus)
    if euler != 2 - 2 * handles - crosscaps - boundary_loops or min(genus, boundary_loops, n_interior_picks) < 0:
        return []  # no surface, or one in several pieces
    counts = sorted(n_boundary_picks_per_loop, reverse=True)[:boundary_loops]
    counts += [0] * (boundary_loops - len(counts))
    return list(_fitting(handles, crosscaps, n_interior_picks, tuple(counts)))


@functools.lru_cache(maxsize=64)
def _fitting(handles: int, crosscaps: int, n_cones: int, counts: tuple[int, ...]) -> tuple[Signature, ...]:
    base = Fraction(2 - 2 * handles - crosscaps - len(counts))
    offers = [*_not_hyperbolic(base, n_cones, sum(counts)), *_hyperbolic(n_cones, sum(counts))]
    found: dict[str, Signature] = {}
    for cones, corners in offers:
        rest = iter(corners)
        borders = [tuple(itertools.islice(rest, count)) for count in counts]
        read = _supported(format_signature(cones, borders, handles, crosscaps))
        if read is not None:
            found.setdefault(read.signature, read)
    return tuple(sorted(found.values(), key=_rank))


Orders = tuple[tuple[int, ...], tuple[int, ...]]  # of cones, of corners


def _not_hyperbolic(base: Fraction, n_cones: int, n_corners: int) -> list[Orders]:
    """All orders up to LARGEST_ORDER with a characteristic of at least 0. A cone takes 1/2 or more of `base`, a corner
    1/4 or more, so there are few."""
    if base < Fraction(n_cones, 2) + Fraction(n_corners, 4):
        return []
    found = []
    every = range(LARGEST_ORDER, 1, -1)
    for cones in itertools.combinations_with_replacement(every, n_cones):
        left = base - sum((Fraction(n - 1, n) for n in cones), Fraction(0))
        if left < Fraction(n_corners, 4):
            continue
        for corners in itertools.combinations_with_replacement(every, n_corners):
            if left >= sum((Fraction(n - 1, 2 * n) for n in corners), Fraction(0)):
                found.append((_usual(cones), _usual(corners)))
    return found


def _usual(orders: tuple[int, ...]) -> tuple[int, ...]:
    """432 and 442, but 22N with its N at the end, as in the literature."""
    return (2, 2, orders[0]) if len(orders) == 3 and orders[1:] == (2, 2) else orders


def _hyperbolic(n_cones: int, n_corners: int) -> list[Orders]:
    """Candidates, of which those that are not hyperbolic have been found already."""
    if n_cones + n_corners == 0:
        return [((), ())]
    if n_cones + n_corners == 1:
        return [((n,) * n_cones, (n,) * n_corners) for n in SINGLE]
    found: list[Orders] = []
    if (n_cones, n_corners) in ((3, 0), (0, 3)):
        found += [(orders, ()) if n_cones else ((), orders) for orders in TRIANGLES]
    found.append(((2,) * n_cones, (2,) * n_corners))
    for last in LAST:
        if n_corners:
            found.append(((2,) * n_cones, (2,) * (n_corners - 1) + (last,)))
        if n_cones:
            found.append(((2,) * (n_cones - 1) + (last,), (2,) * n_corners))
    found += [((n,) * n_cones, (n,) * n_corners) for n in ALIKE]
    if n_cones and n_corners:
        found += [((a,) * n_cones, (b,) * n_corners) for a in ALIKE for b in (2, 3, 4) if a != b]
    return found


def _supported(signature: str) -> Signature | None:
    """None too for what is no good orbifold, such as 43."""
    if not signature:
        return None
    try:
        read = parse_signature(signature)
    except OrbifoldError as error:
        if error.status in ("ORB_BAD_ORBIFOLD", "ORB_BAD_SIGNATURE"):
            return None
        raise
    return read if read.supported else None


def _rank(read: Signature) -> tuple:
    """Euclidean first, then spherical, then hyperbolic; the hyperbolic ones stay as they are."""
    place = {0: 0, 1: 1, -1: 2}[read.curvature]
    if read.curvature < 0:
        return (place,)
    dihedral = read.orders.count(2) >= 2 or len(read.orders) < 3
    return (place, dihedral, -max(read.orders, default=0) if not dihedral else max(read.orders, default=0))
