# SPDX-License-Identifier: GPL-3.0-or-later
"""Patterns of the plane as formulas: functions of the lattice's coordinates, in which the unit square is a period (the
layout `Periodic`), that groups leave as they are; no bpy. The same formula is computed with numbers here, and becomes
shader nodes in procedural.py.

Coordinates are u and v, or for the patterns of triangles and hexagons a = u - v, b = 2 v, c = -(u + v): there the unit
square is a rectangle 1 : 1.73 of the hexagonal lattice, and a third of a turn about its corner permutes a, b, c.
Which of the patterns a group leaves as it is is not looked up but tried: at many points, under each generator.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial, reduce

import numpy as np

POINTS = 400  # at which a pattern is tried


class Numbers:
    """What formulas are made of, at points (k, 2) in the lattice's coordinates: arrays (k,)."""

    def __init__(self, uv: np.ndarray) -> None:
        self._uv = uv

    def line(self, a: int, b: int) -> np.ndarray:
        """a u + b v."""
        return self._uv @ (a, b)

    def math(self, operation: str, *values) -> np.ndarray:
        """An operation of Blender's node Math."""
        return OPERATIONS[operation](*values)

    def wave(self, a: int, b: int, sine: bool = False) -> np.ndarray:
        """The cosine, or the sine, of pi (a u + b v)."""
        return self.math("SINE" if sine else "COSINE", np.pi * self.line(a, b))


OPERATIONS = {
    "ADD": np.add, "SUBTRACT": np.subtract, "MULTIPLY": np.multiply, "MINIMUM": np.minimum, "ABSOLUTE": np.abs,
    "SIGN": np.sign, "FLOOR": np.floor, "FRACT": lambda value: value - np.floor(value), "SINE": np.sin,
    "COSINE": np.cos,
}
Formula = Callable[[Numbers], np.ndarray]


@dataclass(frozen=True)
class Pattern:
    name: str
    description: str
    formula: Formula  # of numbers or of nodes; its sign chooses the colour


def _combined(operation: str, waves: tuple[tuple, ...], offset: float = 0.0) -> Formula:
    """The sum or product of waves, and an offset."""
    return lambda on: on.math("ADD", reduce(partial(on.math, operation), [on.wave(*wave) for wave in waves]), offset)


def _bricks(on: Numbers):
    """Rows of height 1 / 20 between joints; in every other one the joints across are half a brick further on."""
    row = on.wave(0, 20)
    across = on.math("MULTIPLY", on.math("SIGN", row), on.wave(16, 0))
    along = on.math("SUBTRACT", on.math("ABSOLUTE", row), 0.25)
    return on.math("MINIMUM", along, on.math("SUBTRACT", 0.98, across))


def _weave(on: Numbers):
    """Cells of 1 / 16 in turn with three strips along u and along v."""
    ends = [on.wave(16, 0, True), on.wave(0, 16, True)]
    parity = on.math("SIGN", on.math("MULTIPLY", *ends))
    one, other = on.wave(0, 96), on.wave(96, 0)
    turned = on.math("MULTIPLY", parity, on.math("SUBTRACT", one, other))
    twice = on.math("ADD", on.math("ADD", one, other), turned)  # of the cosine across the strips
    gaps = [on.math("SUBTRACT", on.math("ABSOLUTE", end), 0.12) for end in ends]
    return on.math("MINIMUM", on.math("SUBTRACT", 1.5, twice), on.math("MINIMUM", *gaps))


def _scales(on: Numbers):
    """Rows of height 1 / 24 with arcs; in every other one they are half an arc further on."""
    turn = on.math("MULTIPLY", on.math("FLOOR", on.line(24, 0)), np.pi / 2)
    arc = on.math("ABSOLUTE", on.math("COSINE", on.math("ADD", on.math("MULTIPLY", on.line(0, 12), np.pi), turn)))
    beside = on.math("SUBTRACT", on.math("FRACT", on.line(24, 0)), arc)
    return on.math("SUBTRACT", on.math("ABSOLUTE", beside), 0.1)


PATTERNS = {
    "CHECKER": Pattern(
        "Checker", "Squares in two colours, about every corner of the lattice",
        _combined("MULTIPLY", ((16, 0), (0, 16))),
    ),
    "STRIPES": Pattern(
        "Stripes", "For 2222: stripes, which half a turn leaves as they are", _combined("ADD", ((24, 0),)),
    ),
    "TRIANGLES": Pattern(
        "Triangles", "For 333: triangles in two colours, which a third of a turn leaves as they are",
        _combined("MULTIPLY", ((16, -16, True), (0, 32, True), (-16, -16, True))),
    ),
    "QUADS": Pattern(
        "Quads", "For 442: rounded quads, which a quarter of a turn leaves as they are",
        _combined("ADD", ((16, 0), (0, 16)), -0.25),
    ),
    "HEXAGONS": Pattern(
        "Hexagons", "For 632 and 333: rounded hexagons, which a sixth of a turn leaves as they are",
        _combined("ADD", ((16, -16), (0, 32), (-16, -16)), 0.8),
    ),
    "BRICKS": Pattern("Bricks", "For 2222: bricks, whose rows half a turn leaves as they are", _bricks),
    "WEAVE": Pattern("Woven Strips", "For 442 and 2222: strips along and across, in turn", _weave),
    "SCALES": Pattern("Scales", "For o: scales, which all point the same way", _scales),
}


def value_at(pattern: Pattern, uv: np.ndarray) -> np.ndarray:
    """(k,) at points (k, 2) in the lattice's coordinates."""
    return pattern.formula(Numbers(uv))


def fits(pattern: Pattern, moves: list[Callable[[np.ndarray], np.ndarray]]) -> bool:
    """Whether these motions, of points (k, 2) in the lattice's coordinates, leave the pattern as it is."""
    points = np.random.default_rng(0).uniform(-1, 1, (POINTS, 2))
    here = value_at(pattern, points)
    sure = np.abs(here) > 1e-3
    return all((np.sign(value_at(pattern, move(points))) == np.sign(here))[sure].all() for move in moves)
