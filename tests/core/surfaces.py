# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of every surface: disks, annuli, Möbius bands, Klein bottles, projective planes, handles; picks on them; and
those parts of the add-on that need no bpy, as a package without Blender."""

import importlib
import sys
import types

import numpy as np
from conftest import CHECKOUT
from meshes import icosphere, subdivided

import core


def bare(name):
    """A module of the add-on by its name below addon/, the package's __init__ (and so bpy) left out."""
    if "bare_addon" not in sys.modules:
        package = types.ModuleType("bare_addon")
        package.__path__ = [str(CHECKOUT / "addon")]
        sys.modules["bare_addon"] = package
    return importlib.import_module(f"bare_addon.{name}")


def grid(n, m, wrap, place):
    """(n, m) quads as triangles. The first parameter is open (wrap "-"), joined ("=") or joined upside down ("~"), the
    second likewise (but not upside down): wrap is two such characters. `place` of (k,) numbers in [0, 1] each."""
    numbers, where = {}, []

    def at(i, j):
        if wrap[0] != "-" and i == n:
            i, j = 0, (m - j if wrap[0] == "~" else j)
        if wrap[1] == "=":
            j %= m
        if (i, j) not in numbers:
            numbers[i, j] = len(where)
            where.append((i / n, j / m))
        return numbers[i, j]

    triangles = []
    for i in range(n):
        for j in range(m):
            a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
            triangles += [[a, b, c], [a, c, d]] if (i + j) % 2 else [[a, b, d], [b, c, d]]
    u, v = np.array(where).T
    return np.stack(place(u, v), 1), np.array(triangles)


def disk(n=14):
    """A bumpy, bent rectangle."""
    def place(u, v):
        return 1.4 * u + 0.1 * v, v + 0.15 * np.sin(3 * u), 0.3 * np.sin(2.5 * u + v) + 0.2 * u * v

    return grid(n, n, "--", place)


def annulus(n=30, m=8):
    def place(u, v):
        angle, radius = 2 * np.pi * u, 1 + v * (1 + 0.3 * np.sin(2 * np.pi * u))
        return radius * np.cos(angle), radius * np.sin(angle), 0.3 * np.cos(2 * angle) * v

    return grid(n, m, "=-", place)


def mobius(n=36, m=8):
    def place(u, v):
        angle, across = 2 * np.pi * u, 0.9 * (v - 0.5)
        radius = 1 + across * np.cos(angle / 2)
        return radius * np.cos(angle), radius * np.sin(angle), across * np.sin(angle / 2)

    return grid(n, m, "~-", place)


def klein(n=40, m=16):
    """The figure of eight, turned over once round the axis."""
    def place(u, v):
        s, t = 2 * np.pi * u, 2 * np.pi * v
        radius = 2.5 + np.cos(s / 2) * np.sin(t) - np.sin(s / 2) * np.sin(2 * t)
        z = np.sin(s / 2) * np.sin(t) + np.cos(s / 2) * np.sin(2 * t)
        return radius * np.cos(s), radius * np.sin(s), z

    return grid(n, m, "~=", place)


def torus(n=24, m=14):
    def place(u, v):
        s, t = 2 * np.pi * u, 2 * np.pi * v
        radius = 2 + (0.8 + 0.2 * np.cos(s)) * np.cos(t)
        return radius * np.cos(s), radius * np.sin(s), 0.9 * np.sin(t) + 0.3 * np.sin(2 * s)

    return grid(n, m, "==", place)


def boy(level=2):
    """The projective plane: Boy's surface after Bryant and Kusner, on the icosphere's pairs of opposite vertices."""
    points, triangles = icosphere(level)
    opposite = np.array([int(np.argmin(((points + p) ** 2).sum(1))) for p in points])
    used, of = np.unique(np.minimum(np.arange(len(points)), opposite), return_inverse=True)
    x, y, z = points[used].T
    up = np.where(z >= 0, 1, -1)  # of two opposite points the upper one
    w = up * (x + 1j * y) / (1 + up * z)
    below = w**6 + np.sqrt(5) * w**3 - 1
    g = np.stack([-1.5 * (w * (1 - w**4) / below).imag, -1.5 * (w * (1 + w**4) / below).real,
                  ((1 + w**6) / below).imag - 0.5])
    vertices = (g / (g**2).sum(0)).T
    faces = of.ravel()[triangles]
    _, first = np.unique(np.sort(faces, 1), axis=0, return_index=True)
    return vertices, faces[np.sort(first)]


def holed(genus, level=1):
    """A closed surface with so many handles: the skin of a row of cubes with holes through it."""
    solid = np.ones((2 * genus + 1, 3, 1), bool)
    solid[1::2, 1] = False
    numbers, quads = {}, []
    for x, y, z in np.argwhere(solid).tolist():
        for axis in range(3):
            for side in (0, 1):
                there = [x, y, z]
                there[axis] += 2 * side - 1
                if all(0 <= c < s for c, s in zip(there, solid.shape)) and solid[tuple(there)]:
                    continue
                corners = []
                for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)) if side else ((0, 0), (0, 1), (1, 1), (1, 0)):
                    corner = [x, y, z]
                    corner[axis] += side
                    corner[(axis + 1) % 3] += a
                    corner[(axis + 2) % 3] += b
                    corners.append(numbers.setdefault(tuple(corner), len(numbers)))
                quads.append(corners)
    quads = np.array(quads)
    vertices = np.array(list(numbers), float)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    for _ in range(level):
        vertices, triangles = subdivided(vertices, triangles)
    return vertices, triangles


def sphere(level=3):
    vertices, triangles = icosphere(level)
    return vertices * [1.0, 0.8, 1.3] + 0.05 * np.sin(4 * vertices[:, [1, 2, 0]]), triangles


def punctured(mesh, count=1):
    """The mesh with `count` faces (and their neighbours around a vertex) left out, far from one another."""
    vertices, triangles = mesh
    border = np.zeros(len(vertices), bool)
    for loop in core.topology_of(triangles).loops:
        border[loop] = True
    away = np.full(len(vertices), np.inf)
    for v in np.flatnonzero(border):
        away = np.minimum(away, np.linalg.norm(vertices - vertices[v], axis=1))
    gone = np.zeros(len(triangles), bool)
    for number in range(count):
        v = int(np.argmax(np.where(np.isfinite(away), away, vertices[:, 0]))) if number or border.any() else 0
        gone |= (triangles == v).any(1)
        away = np.minimum(away, np.linalg.norm(vertices - vertices[v], axis=1))
    return vertices, triangles[~gone]


def surface_for(signature):
    """A mesh of the signature's surface."""
    read = core.parse_signature(signature)
    handles, crosscaps, borders = read.n_handles, read.n_crosscaps, read.n_mirrors
    if crosscaps == 0 and handles == 0:
        return (sphere(), disk(), annulus())[borders] if borders < 3 else punctured(disk(), borders - 1)
    if crosscaps == 0:
        return punctured(torus() if handles == 1 else holed(handles), borders)
    if crosscaps == 1:
        return mobius() if borders == 1 else punctured(boy(), borders)
    return punctured(klein(), borders)


def picks_for(mesh, signature):
    """As `./build.sh run --cones auto` does."""
    return bare("headless.automatic").automatic_cones(*mesh, core.parse_signature(signature))
