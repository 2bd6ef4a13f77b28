# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces of every topology that an orbifold may have, made by the tests: vertices (n, 3), triangles (m, 3).

Orientable ones are consistently oriented. `roughened` makes a mesh generic: its vertices moved and its edges flipped at
random, so that no symmetry hides a mistake. What is made here is checked by test_shapes.py."""

import numpy as np
from meshes import icosphere
from picks import boundary_loops

TURN = 2 * np.pi


# ------------------------------------------------------------------------------------------------- grids, glued


def grid(nx, ny, glue, place):
    """An nx by ny grid of quads in two triangles each. glue(i, j): the grid point that stands for (i, j), where several
    are one vertex; place(x, y): where in space, x and y in [0, 1]."""
    i, j = np.meshgrid(np.arange(nx + 1), np.arange(ny + 1), indexing="ij")
    x, y = glue(i, j)
    keys, number = np.unique((x * (ny + 1) + y).ravel(), return_inverse=True)
    number = number.reshape(i.shape)
    vertices = place(keys // (ny + 1) / nx, keys % (ny + 1) / ny)
    a, b, c, d = (n.ravel() for n in (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]))
    other = ((i + j)[:-1, :-1] % 3 == 1).ravel()[:, None]
    first = np.where(other, np.stack([a, b, d], 1), np.stack([a, b, c], 1))
    second = np.where(other, np.stack([b, c, d], 1), np.stack([a, c, d], 1))
    return np.stack(vertices, 1), np.concatenate([first, second])


def ring(x):
    return np.cos(TURN * x), np.sin(TURN * x)


def annulus(nx=24, ny=5, inner=0.4, wave=0.1, relief=0.2):
    """Between two wavy circles, not flat."""

    def place(x, y):
        c, s = ring(x)
        r = (inner + (1 - inner) * y) * (1 + wave * np.sin(3 * TURN * x + 1))
        return r * c, r * s, relief * np.sin(2 * TURN * x) * y

    return grid(nx, ny, lambda i, j: (i % nx, ny - j), place)


def cylinder(nx=18, ny=7, height=1.5):
    return grid(nx, ny, lambda i, j: (i % nx, j), lambda x, y: (*ring(x), height * y))


def moebius_band(nx=30, ny=5, width=0.8, twists=1):
    """`twists` is odd."""

    def glue(i, j):
        return i % nx, np.where(i == nx, ny - j, j)

    def place(x, y):
        across, up = ring(twists * x / 2)
        r = 1 + width * (y - 0.5) * across
        return r * ring(x)[0], r * ring(x)[1], width * (y - 0.5) * up

    return grid(nx, ny, glue, place)


def klein_figure_eight(nx=28, ny=14, radius=2.2):
    """A figure eight led once around while it makes half a turn; the rows avoid the curve where it crosses itself."""

    def glue(i, j):
        return i % nx, np.where(i == nx, -j - 1, j) % ny

    def place(x, y):
        v = TURN * (y + 0.5 / ny)
        c, s = ring(x / 2)
        r = radius + c * np.sin(v) - s * np.sin(2 * v)
        return r * ring(x)[0], r * ring(x)[1], s * np.sin(v) + c * np.sin(2 * v)

    return grid(nx, ny, glue, place)


def klein_bottle(nx=36, ny=12):
    """The bottle whose neck enters its side."""

    def glue(i, j):
        return i % nx, np.where(i == nx, ny // 2 - j, j) % ny

    def place(x, y):
        u, v = TURN * x, TURN * y
        r = 4 - 2 * np.cos(u)
        first = u < np.pi + 1e-9
        across = np.where(first, 6 * np.cos(u) * (1 + np.sin(u)) + r * np.cos(u) * np.cos(v),
                          6 * np.cos(u) * (1 + np.sin(u)) - r * np.cos(v))
        up = np.where(first, 16 * np.sin(u) + r * np.sin(u) * np.cos(v), 16 * np.sin(u))
        return across / 10, r * np.sin(v) / 10, up / 10

    return grid(nx, 2 * (ny // 2), glue, place)


def torus(nx=20, ny=10, tube=0.45):
    def place(x, y):
        r = 1 + tube * np.cos(TURN * y)
        return r * ring(x)[0], r * ring(x)[1], tube * np.sin(TURN * y)

    return grid(nx, ny, lambda i, j: (i % nx, j % ny), place)


# ------------------------------------------------------------------------------------------------- disks, spheres


def disk(rings=9, wave=0.12, relief=0.3):
    """Concentric rings of 6, 12, 18 ... vertices within a wavy boundary; the middle is vertex 0."""
    vertices, triangles = [(0.0, 0.0, 0.0)], []

    def number(r, i):
        return 1 + 3 * r * (r - 1) + i % (6 * r) if r else 0

    for r in range(1, rings + 1):
        for i in range(6 * r):
            angle, rho = TURN * i / (6 * r), r / rings
            rho *= 1 + wave * np.sin(5 * angle) * rho
            vertices.append((rho * np.cos(angle), rho * np.sin(angle), relief * np.cos(2 * angle) * rho**2))
        for side in range(6):
            for i in range(r):
                inner, outer = number(r - 1, side * (r - 1) + i), side * r + i
                triangles.append((inner, number(r, outer), number(r, outer + 1)))
                if i < r - 1:
                    triangles.append((inner, number(r, outer + 1), number(r - 1, side * (r - 1) + i + 1)))
    return np.array(vertices), np.array(triangles)


def hemisphere(rings=8):
    """The rings of `disk` on the upper half of the unit sphere."""
    flat, triangles = disk(rings, 0, 0)
    angle, rho = np.arctan2(flat[:, 1], flat[:, 0]), np.hypot(flat[:, 0], flat[:, 1]) * np.pi / 2
    return np.stack([np.sin(rho) * np.cos(angle), np.sin(rho) * np.sin(angle), np.cos(rho)], 1), triangles


def antipodal_quotient(level=3):
    """The icosphere's quotient, antipodes being one vertex, each at one of its two places."""
    points, triangles = icosphere(level)
    opposite = np.argmin(np.abs(points[:, None] + points).sum(2), 1)
    lower = np.minimum(np.arange(len(points)), opposite)
    kept, number = np.unique(lower, return_inverse=True)
    quotient = number[triangles]
    _, first = np.unique(np.sort(quotient, 1), axis=0, return_index=True)
    return points[kept], quotient[np.sort(first)]


def boy_surface(level=3):
    """The projective plane immersed in space (Bryant 1987, Kusner): the quotient of the icosphere."""
    points, triangles = antipodal_quotient(level)
    turn, _ = np.linalg.qr(np.random.default_rng(7).normal(size=(3, 3)))
    x, y, z = (np.where(points @ turn[2] < 0, -1, 1)[:, None] * points @ turn.T).T
    w = (x + 1j * y) / (1 + z)
    below = w**6 + np.sqrt(5) * w**3 - 1
    g = np.stack([-1.5 * (w * (1 - w**4) / below).imag, -1.5 * (w * (1 + w**4) / below).real,
                  ((1 + w**6) / below).imag - 0.5], 1)
    return g / (g**2).sum(1)[:, None], triangles


# ------------------------------------------------------------------------------------------------- blocks


def block(filled, fineness):
    """The boundary of a solid of cubes, filled[x, y, z], each cut into fineness^3, smoothed."""
    solid = np.pad(np.asarray(filled, bool).repeat(fineness, 0).repeat(fineness, 1).repeat(fineness, 2), 1)
    shape = np.array(solid.shape) + 1
    quads = []
    for axis in range(3):
        across = np.eye(3, dtype=int)[[(axis + 1) % 3, (axis + 2) % 3]]
        step = np.diff(solid.astype(int), axis=axis)
        for sign in (1, -1):  # -1: the axis points out of the solid here
            at = np.argwhere(step == sign) + np.eye(3, dtype=int)[axis]
            around = [at, at + across[0], at + across[0] + across[1], at + across[1]]
            quads.append(np.stack(around[::-sign], 1))
    quads = np.concatenate(quads)
    keys, number = np.unique((quads * [shape[1] * shape[2], shape[2], 1]).sum(2).ravel(), return_inverse=True)
    a, b, c, d = number.reshape(-1, 4).T
    places = np.stack(np.unravel_index(keys, shape), 1) / fineness
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    return smoothed(places, triangles, 2 * fineness), triangles


def pretzel(genus, fineness=2):
    """The closed surface of this genus: a bar with holes."""
    filled = np.ones((3, 2 * genus + 1, 1), bool)
    filled[1, 1::2] = False
    return block(filled, fineness)


def plate(n_holes, fineness=3, relief=0.3):
    """A rectangle with square holes, bent; its corners are cut off by single triangles, or not, as the grid has it."""
    filled = np.ones((max(1, 2 * n_holes + 1), 3), bool)
    filled[1::2, 1] = n_holes == 0
    cells = np.argwhere(filled.repeat(fineness, 0).repeat(fineness, 1))
    width = filled.shape[1] * fineness + 1
    corner = cells[:, 0] * width + cells[:, 1]
    a, b, c, d = corner, corner + width, corner + width + 1, corner + 1
    other = (cells.sum(1) % 2 == 1)[:, None]
    first = np.where(other, np.stack([a, b, d], 1), np.stack([a, b, c], 1))
    second = np.where(other, np.stack([b, c, d], 1), np.stack([a, c, d], 1))
    keys, number = np.unique(np.concatenate([first, second]).ravel(), return_inverse=True)
    x, y = keys // width / fineness, keys % width / fineness
    return np.stack([x, y, relief * np.sin(x) * np.cos(y)], 1), number.reshape(-1, 3)


# ------------------------------------------------------------------------------------------------- surgery


def neighbours(triangles, vertices):
    """The vertices of all triangles on any of `vertices`, these too."""
    return np.unique(triangles[np.isin(triangles, vertices).any(1)])


def punctured(vertices, triangles, centres, rings=1):
    """Without the triangles within `rings` of each centre; unused vertices are dropped."""
    gone = np.asarray(centres)
    for _ in range(rings - 1):
        gone = neighbours(triangles, gone)
    return compact(vertices, triangles[~np.isin(triangles, gone).any(1)])


def compact(vertices, triangles):
    used, number = np.unique(triangles, return_inverse=True)
    return vertices[used], number.reshape(-1, 3)


def with_crosscaps(vertices, triangles, centres):
    """At each centre two rings of triangles are taken out and opposite points of the hole's rim are made one."""
    for centre in centres:
        gone = neighbours(triangles, centre)
        before = {tuple(loop) for loop in map(sorted, boundary_loops(triangles))}
        rest = triangles[~np.isin(triangles, gone).any(1)]
        (rim,) = [loop for loop in boundary_loops(rest) if tuple(sorted(loop)) not in before]
        half = len(rim) // 2
        assert len(rim) == 2 * half
        number = np.arange(len(vertices))
        number[rim[half:]] = rim[:half]
        vertices = vertices.copy()
        vertices[rim[:half]] = 0.5 * (vertices[rim[:half]] + vertices[rim[half:]])
        vertices[rim[:half]] += 0.4 * (vertices[rim[0]] - vertices[centre]) * np.linspace(-1, 1, half)[:, None]
        triangles = number[rest]
    return compact(vertices, triangles)


# ------------------------------------------------------------------------------------------------- shape


def edges_of(triangles):
    """(E, 2) edges, lower vertex first."""
    return np.unique(np.sort(np.stack([triangles, np.roll(triangles, -1, 1)], 2).reshape(-1, 2), 1), axis=0)


def smoothed(vertices, triangles, rounds):
    """Each vertex half-way to the mean of its neighbours, again and again."""
    a, b = edges_of(triangles).T
    degree = np.bincount(np.concatenate([a, b]), minlength=len(vertices))[:, None]
    for _ in range(rounds):
        total = np.zeros_like(vertices)
        np.add.at(total, a, vertices[b])
        np.add.at(total, b, vertices[a])
        vertices = 0.5 * vertices + 0.5 * total / degree
    return vertices


def roughened(surface, seed=1, amount=0.15, flips=0.2):
    """Every vertex moved by up to `amount` of its shortest edge; a share `flips` of all edges flipped, where the other
    diagonal is no edge yet and not much longer."""
    vertices, triangles = surface
    random = np.random.default_rng(seed)
    edges = edges_of(triangles)
    length = np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1)
    shortest = np.full(len(vertices), np.inf)
    np.minimum.at(shortest, edges.ravel(), length.repeat(2))
    shortest[np.isinf(shortest)] = 0
    move = random.normal(size=vertices.shape)
    move *= (random.random(len(vertices)) * amount * shortest / np.linalg.norm(move, axis=1))[:, None]
    vertices = vertices + move
    wanted = edges[random.permutation(len(edges))[: int(flips * len(edges))]]
    return vertices, _flipped(vertices, triangles, wanted)


def _flipped(vertices, triangles, wanted):
    triangles = triangles.copy()
    edges = {tuple(edge) for edge in edges_of(triangles).tolist()}
    around = {}
    for t, triangle in enumerate(triangles.tolist()):
        for v in triangle:
            around.setdefault(v, set()).add(t)
    for p, q in wanted.tolist():
        both = around[p] & around[q]
        if len(both) != 2:
            continue
        s, t = sorted(both)
        (a,), (b,) = set(triangles[s].tolist()) - {p, q}, set(triangles[t].tolist()) - {p, q}
        new = tuple(sorted((a, b)))
        too_long = np.linalg.norm(vertices[a] - vertices[b]) > 1.3 * np.linalg.norm(vertices[p] - vertices[q])
        if a == b or new in edges or too_long or min(len(around[p]), len(around[q])) < 5:
            continue
        one, two = (np.where(triangles[s] == q, b, triangles[s]), np.where(triangles[t] == p, a, triangles[t]))
        triangles[s], triangles[t] = one, two
        edges -= {(p, q)}
        edges |= {new}
        around[q] -= {s}
        around[p] -= {t}
        around[a] |= {t}
        around[b] |= {s}
    return triangles
