#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The meshes of docs/orbifolds.md, one of each topology, as .off files:   sample_meshes.py FOLDER"""

import sys
from pathlib import Path

import numpy as np

TURN = 2 * np.pi


# ------------------------------------------------------------------------------------------------- grids, glued


def grid(nx, ny, glue, place):
    """nx by ny quads in two triangles each; glue(i, j): the grid point that stands for (i, j); place(x, y) in space."""
    i, j = np.meshgrid(np.arange(nx + 1), np.arange(ny + 1), indexing="ij")
    keys, number = np.unique(np.ravel_multi_index(glue(i, j), (nx + 1, ny + 1)).ravel(), return_inverse=True)
    number = number.reshape(i.shape)
    a, b, c, d = (n.ravel() for n in (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]))
    other = ((i + j)[:-1, :-1] % 2 == 1).ravel()[:, None]
    first = np.where(other, np.stack([a, b, d], 1), np.stack([a, b, c], 1))
    second = np.where(other, np.stack([b, c, d], 1), np.stack([a, c, d], 1))
    place_of = place(keys // (ny + 1) / nx, keys % (ny + 1) / ny)
    return np.stack(np.broadcast_arrays(*place_of), 1), np.concatenate([first, second])


def vase(nx=160, ny=60):
    """An annulus: a tube of changing girth with four soft ribs."""

    def place(x, y):
        r = 0.75 + 0.25 * np.sin(TURN * (0.9 * y + 0.1)) + 0.05 * np.cos(4 * TURN * x) * np.sin(np.pi * y)
        return r * np.cos(TURN * x), r * np.sin(TURN * x), 2.1 * y

    return grid(nx, ny, lambda i, j: (i % nx, j), place)


def moebius(nx=260, ny=24, width=0.75):
    def place(x, y):
        r = 1 + width * (y - 0.5) * np.cos(TURN * x / 2)
        return r * np.cos(TURN * x), width * (y - 0.5) * np.sin(TURN * x / 2), r * np.sin(TURN * x)

    return grid(nx, ny, lambda i, j: (i % nx, np.where(i == nx, ny - j, j)), place)


def bottle(nx=180, ny=60):
    """Klein's bottle, the neck of which enters its side."""

    def place(x, y):
        u, v = TURN * x, TURN * y
        r = 4 - 2 * np.cos(u)
        first = u < np.pi
        across = 6 * np.cos(u) * (1 + np.sin(u)) + r * np.where(first, np.cos(u), -1) * np.cos(v)
        return across / 10, r * np.sin(v) / 10, -(16 * np.sin(u) + np.where(first, r * np.sin(u) * np.cos(v), 0)) / 10

    return grid(nx, ny, lambda i, j: (i % nx, np.where(i == nx, ny // 2 - j, j) % ny), place)


def knot(nx=360, ny=26, thickness=0.42):
    """A torus: a trefoil knot."""
    t = TURN * np.arange(nx) / nx
    middle = np.stack([np.sin(t) + 2 * np.sin(2 * t), 0.8 * np.sin(3 * t), np.cos(t) - 2 * np.cos(2 * t)], 1)
    tangent = np.roll(middle, -1, 0) - np.roll(middle, 1, 0)
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    side = np.cross(tangent, [0, 1, 0])  # the knot is nowhere upright
    side /= np.linalg.norm(side, axis=1)[:, None]
    other = np.cross(tangent, side)

    def place(x, y):
        at, c, s = np.round(x * nx).astype(int), np.cos(TURN * y)[:, None], np.sin(TURN * y)[:, None]
        return tuple((middle[at] + thickness * (c * side[at] + s * other[at])).T)

    return grid(nx, ny, lambda i, j: (i % nx, j % ny), place)


# ------------------------------------------------------------------------------------------------- rings


def rings(n):
    """(radius, angle, triangles): a middle vertex and n rings of 6, 12, 18 ... vertices."""
    radius, angle = [0.0], [0.0]
    for r in range(1, n + 1):
        radius += [r / n] * (6 * r)
        angle += [TURN * i / (6 * r) for i in range(6 * r)]

    def number(r, i):
        return 1 + 3 * r * (r - 1) + i % (6 * r) if r else 0

    triangles = []
    for r in range(1, n + 1):
        for side in range(6):
            for i in range(r):
                inner, outer = number(r - 1, side * (r - 1) + i), side * r + i
                triangles.append((inner, number(r, outer), number(r, outer + 1)))
                if i < r - 1:
                    triangles.append((inner, number(r, outer + 1), number(r - 1, side * (r - 1) + i + 1)))
    return np.array(radius), np.array(angle), np.array(triangles)


def mask(n=44, eyes=False):
    """A disk: a face in relief, with or without holes for the eyes."""
    radius, angle, triangles = rings(n)
    x, z = 0.85 * radius * np.sin(angle), 1.1 * radius * np.cos(angle) * (1 + 0.05 * np.cos(2 * angle) * radius)

    def bump(cx, cz, wx, wz, height):
        return 1.6 * height * np.exp(-(((x - cx) / wx) ** 2) - ((z - cz) / wz) ** 2)

    relief = 0.55 * np.sqrt(np.maximum(0, 1.15 - radius**2))
    relief += bump(0, -0.05, 0.11, 0.26, 0.26) + bump(0, -0.2, 0.17, 0.1, 0.12)  # nose
    relief += bump(0, -0.5, 0.24, 0.055, 0.1) + bump(0, -0.62, 0.2, 0.06, 0.08)  # lips
    relief += bump(0, -0.88, 0.2, 0.12, 0.08)  # chin
    for side in (1, -1):
        relief += bump(side * 0.32, 0.34, 0.24, 0.07, 0.1) - bump(side * 0.3, 0.14, 0.17, 0.09, 0.16)  # brows, sockets
        relief += bump(side * 0.3, 0.13, 0.09, 0.05, 0.09) + bump(side * 0.42, -0.2, 0.2, 0.18, 0.07)  # eyes, cheeks
    vertices, triangles = np.stack([x, -relief, z], 1), triangles[:, ::-1]
    if eyes:
        return with_holes(vertices, triangles, [(0.3, 0.13), (-0.3, 0.13)], (0.15, 0.085))
    return vertices, triangles


def with_holes(vertices, triangles, centres, radii):
    """Elliptic holes, seen along y; the vertices on a rim are moved onto it."""
    for centre in centres:
        away = (vertices[:, [0, 2]] - centre) / radii
        kept = triangles[~((away**2).sum(1) < 1)[triangles].any(1)]
        rim = np.intersect1d(kept, triangles[((away**2).sum(1) < 1)[triangles].any(1)])
        vertices[np.ix_(rim, [0, 2])] = centre + radii * away[rim] / np.linalg.norm(away[rim], axis=1)[:, None]
        used, number = np.unique(kept, return_inverse=True)
        vertices, triangles = vertices[used], number.reshape(-1, 3)
    return vertices, triangles


def leaf(n=44):
    """A disk: its rim is longer than a flat one's, and goes up and down."""
    radius, angle, triangles = rings(n)
    bowl = 0.45 * radius**2 + 0.16 * radius**3 * np.sin(5 * angle)
    return np.stack([1.2 * radius * np.cos(angle), -1.1 * bowl, radius * np.sin(angle)], 1), triangles


def boy(n=40):
    """The projective plane, immersed (Bryant, Kusner): opposite vertices of the last ring are one."""
    radius, angle, triangles = rings(n)
    w = radius * np.exp(1j * (angle + 0.01))
    below = w**6 + np.sqrt(5) * w**3 - 1
    g = np.stack([-1.5 * (w * (1 - w**4) / below).imag, -1.5 * (w * (1 + w**4) / below).real,
                  ((1 + w**6) / below).imag - 0.5], 1)
    number = np.arange(len(w))
    first = len(w) - 6 * n
    number[first + 3 * n :] = number[first : first + 3 * n]
    return (g / (g**2).sum(1)[:, None])[: first + 3 * n], number[triangles]


# ------------------------------------------------------------------------------------------------- blocks


def block(filled, fineness):
    """The boundary of a solid of cubes, filled[x, y, z], each cut into fineness^3, smoothed."""
    solid = np.pad(np.asarray(filled, bool).repeat(fineness, 0).repeat(fineness, 1).repeat(fineness, 2), 1)
    unit, quads = np.eye(3, dtype=int), []
    for axis in range(3):
        one, two = unit[(axis + 1) % 3], unit[(axis + 2) % 3]
        step = np.diff(solid.astype(int), axis=axis)
        for sign in (1, -1):  # -1: the axis points out of the solid here
            at = np.argwhere(step == sign) + unit[axis]
            quads.append(np.stack([at, at + one, at + one + two, at + two][::-sign], 1))
    corners = np.concatenate(quads)
    shape = np.array(solid.shape) + 1
    keys, number = np.unique(np.ravel_multi_index(corners.reshape(-1, 3).T, shape), return_inverse=True)
    a, b, c, d = number.reshape(-1, 4).T
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    places = np.stack(np.unravel_index(keys, shape), 1) / fineness
    return smoothed(places, triangles, 3 * fineness), triangles


def smoothed(vertices, triangles, rounds):
    edges = np.unique(np.sort(np.stack([triangles, np.roll(triangles, -1, 1)], 2).reshape(-1, 2), 1), axis=0)
    a, b = np.concatenate([edges, edges[:, ::-1]]).T
    degree = np.bincount(a)[:, None]
    for _ in range(rounds):
        total = np.stack([np.bincount(a, vertices[b, k]) for k in range(3)], 1)
        vertices = 0.5 * vertices + 0.5 * total / degree
    return vertices


def pretzel(genus, fineness=8):
    filled = np.ones((2 * genus + 1, 1, 3), bool)
    filled[1::2, 0, 1] = False
    return block(filled, fineness)


MESHES = {
    "mask": mask,
    "open_mask": lambda: mask(eyes=True),
    "leaf": leaf,
    "vase": vase,
    "moebius": moebius,
    "bottle": bottle,
    "boy": boy,
    "knot": knot,
    "pretzel": lambda: pretzel(2),
    "long_pretzel": lambda: pretzel(3),
}


def write_off(path, vertices, triangles):
    with open(path, "w", encoding="ascii") as file:
        file.write(f"OFF\n{len(vertices)} {len(triangles)} 0\n")
        np.savetxt(file, vertices, "%.9g")
        np.savetxt(file, np.column_stack([np.full(len(triangles), 3), triangles]), "%d")


def main():
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, make in MESHES.items():
        write_off(folder / f"{name}.off", *make())


if __name__ == "__main__":
    main()
