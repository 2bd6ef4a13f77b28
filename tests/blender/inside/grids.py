# SPDX-License-Identifier: GPL-3.0-or-later
"""Disks, annuli, Möbius bands, Klein bottles and tori as grids of triangles or quads; NumPy only."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

Mesh = tuple[np.ndarray, np.ndarray]  # (n, 3) vertices, (m, 3) triangles or (m, 4) quads


def grid(n: int, m: int, wrap: str, place: Callable, quads: bool) -> Mesh:
    """n times m quads. Each parameter is open "-", joined "=" or, the first one, joined upside down "~"; `place` takes
    both as angles, from 0 to 2 pi."""
    numbers: dict[tuple[int, int], int] = {}
    where = []

    def at(i: int, j: int) -> int:
        if wrap[0] != "-" and i == n:
            i, j = 0, (m - j if wrap[0] == "~" else j)
        if wrap[1] == "=":
            j %= m
        if (i, j) not in numbers:
            numbers[i, j] = len(where)
            where.append((2 * np.pi * i / n, 2 * np.pi * j / m))
        return numbers[i, j]

    found = []
    for i in range(n):
        for j in range(m):
            a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
            found += [[a, b, c, d]] if quads else [[a, b, c], [a, c, d]] if (i + j) % 2 else [[a, b, d], [b, c, d]]
    return np.array([place(u, v) for u, v in where]), np.array(found)


def disk(quads: bool = False, n: int = 12) -> Mesh:
    return grid(n, n, "--", lambda u, v: (u + 0.1 * v, v, 0.8 * np.sin(0.5 * u + 0.3 * v)), quads)


def annulus(quads: bool = False) -> Mesh:
    return grid(24, 6, "=-", lambda u, v: ((3 + v) * np.cos(u), (3 + v) * np.sin(u), np.cos(2 * u) * v / 6), quads)


def mobius(quads: bool = False) -> Mesh:
    def place(u: float, v: float) -> tuple[float, float, float]:
        across = 0.3 * (v - np.pi)
        radius = 2 + across * np.cos(u / 2)
        return radius * np.cos(u), radius * np.sin(u), across * np.sin(u / 2)

    return grid(30, 6, "~-", place, quads)


def klein(quads: bool = False) -> Mesh:
    """The figure of eight, turned over once round the axis."""

    def place(u: float, v: float) -> tuple[float, float, float]:
        radius = 2.5 + np.cos(u / 2) * np.sin(v) - np.sin(u / 2) * np.sin(2 * v)
        return radius * np.cos(u), radius * np.sin(u), np.sin(u / 2) * np.sin(v) + np.cos(u / 2) * np.sin(2 * v)

    return grid(32, 16, "~=", place, quads)


def torus(quads: bool = False) -> Mesh:
    return grid(24, 12, "==", lambda u, v: ((2 + np.cos(v)) * np.cos(u), (2 + np.cos(v)) * np.sin(u), np.sin(v)), quads)
