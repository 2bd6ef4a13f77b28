# SPDX-License-Identifier: GPL-3.0-or-later
"""A generated zoo: surfaces of all topologies, as they are or spoilt in one way, each with a random orbifold and picks.
What came of each is an outcome: certified, or an error that names something that is there.

    python3 tests/core/zoo.py         the table of outcomes for docs/zoo.md, on stdout"""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path

import numpy as np

if __name__ == "__main__":
    sys.path[:0] = [str(Path(__file__).resolve().parents[2] / "addon"), str(Path(__file__).resolve().parent)]

import core  # noqa: E402
import shapes  # noqa: E402
from meshes import icosphere  # noqa: E402
from picks import boundary_loops  # noqa: E402

SURFACES = {
    "sphere": lambda: icosphere(2), "fine sphere": lambda: icosphere(3), "disk": lambda: shapes.disk(5),
    "annulus": lambda: shapes.annulus(12, 3), "plate with two holes": lambda: shapes.plate(2, 3),
    "torus": lambda: shapes.torus(12, 7), "pretzel": lambda: shapes.pretzel(2, 2), "genus 3": lambda: shapes.pretzel(3),
    "Moebius band": lambda: shapes.moebius_band(16, 3), "Klein bottle": lambda: shapes.klein_figure_eight(14, 9),
    "projective plane": lambda: shapes.boy_surface(2),
}
ORDERS = (2, 2, 3, 4, 5, 7, 11)
BOUNDS = {"vertex": 1, "edge": 2, "triangle": 1}


# ----------------------------------------------------------------------------------------------------- what spoils


def slivers(vertices, triangles, random):
    """Vertices nearly on a neighbour."""
    for face in random.choice(len(triangles), 5, replace=False):
        a, b = triangles[face][:2]
        vertices[a] = vertices[b] + 1e-9 * random.normal(size=3)
    return vertices, triangles


def caps(vertices, triangles, random):
    """Vertices nearly on the opposite edge."""
    for face in random.choice(len(triangles), 5, replace=False):
        a, b, c = triangles[face]
        vertices[a] = (vertices[b] + vertices[c]) / 2 + 1e-9 * random.normal(size=3)
    return vertices, triangles


def coincident(vertices, triangles, random):
    for face in random.choice(len(triangles), 3, replace=False):
        a, b = triangles[face][:2]
        vertices[a] = vertices[b]
    return vertices, triangles


def collapsed(vertices, triangles, random):
    """All in one plane, or on a line, or in a point."""
    return vertices * [[1, 1, 0], [1, 0, 0], [0, 0, 0]][random.integers(3)], triangles


def needles(vertices, triangles, random):
    return vertices * [1, 10.0 ** random.uniform(-8, -3), 1], triangles


def scaled(vertices, triangles, random):
    return vertices * 10.0 ** random.uniform(-12, 12), triangles


def far_away(vertices, triangles, random):
    return vertices + 10.0 ** random.uniform(2, 7) * random.normal(size=3), triangles


def three_edges(vertices, triangles, random):
    """Vertices of valence 3: triangles cut in three, one after the other."""
    for _ in range(12):
        face = random.integers(len(triangles))
        a, b, c = triangles[face]
        new = len(vertices)
        vertices = np.concatenate([vertices, vertices[[a, b, c]].mean(0, keepdims=True)])
        triangles = np.concatenate([np.delete(triangles, face, 0), [[a, b, new], [b, c, new], [c, a, new]]])
    return vertices, triangles


def many_edges(vertices, triangles, random):
    """A vertex of valence 1,000: in the middle of an edge's triangle a fan."""
    face = random.integers(len(triangles))
    corners = triangles[face]
    steps = np.linspace(0, 1, 335)[1:-1, None]
    rows, rim = [vertices, vertices[corners].mean(0, keepdims=True)], []
    count = len(vertices) + 1
    for k in range(3):  # a ring inside the triangle
        p, q = 0.8 * vertices[corners[k]], 0.8 * vertices[corners[(k + 1) % 3]]
        rows.append((1 - steps) * p + steps * q + 0.2 * rows[1])
        rim.append(np.arange(count, count + len(steps)))
        count += len(steps)
    ring = np.concatenate(rim)
    fan = np.stack([np.full(len(ring), len(vertices)), ring, np.roll(ring, -1)], 1)
    between = [[corners[k], b, a] for k in range(3) for a, b in zip(rim[k][:-1], rim[k][1:])]
    for k in range(3):
        last, first = rim[k][-1], rim[(k + 1) % 3][0]
        between += [[corners[k], corners[(k + 1) % 3], last], [corners[(k + 1) % 3], first, last]]
    return np.concatenate(rows), np.concatenate([np.delete(triangles, face, 0), fan, between])


def third_triangle(vertices, triangles, random):
    a, b = triangles[random.integers(len(triangles))][:2]
    vertices = np.concatenate([vertices, random.normal(size=(1, 3))])
    return vertices, np.concatenate([triangles, [[a, b, len(vertices) - 1]]])


def bowtie(vertices, triangles, random):
    """Two vertices made one."""
    a, b = random.choice(np.unique(triangles), 2, replace=False)
    return vertices, np.where(triangles == a, b, triangles)


def turned_over(vertices, triangles, random):
    chosen = random.choice(len(triangles), random.integers(1, 4), replace=False)
    triangles[chosen] = triangles[chosen][:, ::-1]
    return vertices, triangles


def several(vertices, triangles, random):
    more, faces = icosphere(1)
    return np.concatenate([vertices, more + 5]), np.concatenate([triangles, faces + len(vertices)])


def isolated(vertices, triangles, random):
    return np.concatenate([vertices, random.normal(size=(3, 3))]), triangles


def not_finite(vertices, triangles, random):
    vertices[random.choice(np.unique(triangles), 2)] = [np.nan, np.inf, -np.inf]
    return vertices, triangles


def beyond(vertices, triangles, random):
    triangles[random.integers(len(triangles)), 1] = random.choice([-1, len(vertices), 2**31 - 1])
    return vertices, triangles


def degenerate(vertices, triangles, random):
    face = random.integers(len(triangles))
    triangles[face, 0] = triangles[face, 1]
    return vertices, triangles


def repeated(vertices, triangles, random):
    return vertices, np.concatenate([triangles, triangles[random.integers(len(triangles))][None, [1, 2, 0]]])


def holed(vertices, triangles, random):
    return vertices, np.delete(triangles, random.choice(len(triangles), 4, replace=False), 0)


def crumpled(vertices, triangles, random):
    """Through itself many times."""
    return random.normal(size=vertices.shape), triangles


def shuffled(vertices, triangles, random):
    """Any vertices: no surface at all."""
    return vertices, random.permuted(triangles.ravel()).reshape(-1, 3)


def unspoilt(vertices, triangles, random):
    return vertices, triangles


SPOILT = {
    "as it is": unspoilt, "slivers": slivers, "caps": caps, "coincident points": coincident, "collapsed": collapsed,
    "needles": needles, "huge or tiny": scaled, "far from the origin": far_away, "valence 3": three_edges,
    "valence 1,000": many_edges, "a third triangle on an edge": third_triangle, "two vertices made one": bowtie,
    "triangles turned over": turned_over, "a second component": several, "isolated vertices": isolated,
    "NaN and infinity": not_finite, "an index beyond": beyond, "a vertex twice": degenerate,
    "a triangle twice": repeated, "four holes": holed, "crumpled": crumpled, "shuffled": shuffled,
}


# ------------------------------------------------------------------------------------------------------- the cases


def cases(number, seed=0):
    """(kind, mesh, signature, picks, settings), every way of spoiling in turn; the same for the same arguments."""
    random = np.random.default_rng(seed)
    kinds, surfaces = list(SPOILT), list(SURFACES)
    for case in range(number):
        kind = kinds[case % len(kinds)]
        surface = surfaces[int(random.integers(len(surfaces)))]
        vertices, triangles = shapes.roughened(SURFACES[surface](), int(random.integers(1000)), flips=0.3)
        signature, picks = orbifold(surface, triangles, random)
        mesh = SPOILT[kind](vertices.copy(), triangles.copy(), random)
        settings = {
            "weights": str(random.choice(["cotan", "conformal", "uniform", "mean-value"])),
            "holes": str(random.choice(["refuse", "fill", "mirror"])),
        }
        yield kind, mesh, signature, picks, settings


def written(orders):
    return core.format_signature([int(order) for order in orders])


def orbifold(surface, triangles, random):
    """A signature of the surface's topology before it is spoilt, and picks for it."""
    loops = boundary_loops(triangles)
    euler = len(np.unique(triangles)) - len(np.unique(np.sort(_sides(triangles), 1), axis=0)) + len(triangles)
    missing = 2 - euler - len(loops)
    turned = surface in ("Moebius band", "Klein bottle", "projective plane")
    inside = np.setdiff1d(triangles, [v for loop in loops for v in loop])
    picks = random.choice(inside, min(len(inside), int(random.integers(2, 6))), replace=False).tolist()
    signature = "" if turned else "o" * (missing // 2)
    signature += written(random.choice(ORDERS, len(picks)))
    for loop in loops:
        corners = [loop[at] for at in np.sort(random.choice(len(loop), int(random.integers(4)), replace=False))]
        signature += "*" + written(random.choice(ORDERS, len(corners)))
        picks += corners
    return signature + "x" * missing * turned, picks


def _sides(triangles):
    return np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])


def outcome(mesh, signature, picks, settings):
    """(status, result or error)"""
    vertices, triangles = mesh
    try:
        result = core.embed(vertices, triangles, signature, picks, **settings)
    except core.OrbifoldError as error:
        return error.status, error
    return "ok", result


def complaint(error, mesh):
    """What is unclear about an error; None where it says what is wrong and names what is there."""
    if len(str(error)) < 20:
        return "it says nothing"
    if error.element not in BOUNDS:
        return None if not error.elements else f"elements of the kind {error.element}"
    if not error.elements:
        return "it names none"
    entries = np.asarray(error.elements)
    most = len(mesh[1]) if error.element == "triangle" else len(mesh[0])
    if entries.ndim > 2 or entries.size % BOUNDS[error.element]:
        return f"no {error.element}s: {error.elements}"
    there = (entries >= 0) & (entries < most)
    return None if there.all() or error.status == "ORB_INDEX_OUT_OF_RANGE" else f"not there: {error.elements}"


PAGE = """# The zoo

What becomes of bad meshes. {number} surfaces of all topologies with 90 to 2,400 triangles, as they are or spoilt in one way, each with a random
orbifold of its topology, random picks, weights and treatment of holes (`tests/core/zoo.py`, which writes this page with `./build.sh docs zoo`).
Each run ends certified, which an independent judge confirms, or with an error that names a vertex, edge or triangle that is there
(`tests/core/test_zoo.py`): none crashes, hangs, or calls a bad result good. What the errors mean is in [troubleshooting.md](troubleshooting.md).

| mesh | runs | certified | refused |
|---|---|---|---|
{rows}

`ORB_BAD_ORBIFOLD`: random orders are not always those of an orbifold (3 7 on a sphere is none). `ORB_CERTIFICATE_FAILED`: slivers 1e-9 high
lose the digits of their angles; with uniform weights the rim of a fan of 1,000 triangles is closer together than doubles can tell. The message says which other weights
embed the mesh.
"""


def main(number=1100):
    table = {}
    for kind, mesh, signature, picks, settings in cases(number):
        status, _ = outcome(mesh, signature, picks, settings)
        table.setdefault(kind, Counter())[status] += 1
    rows = []
    for kind, counts in table.items():
        others = ", ".join(f"{n} `{status}`" for status, n in sorted(counts.items()) if status != "ok")
        rows.append(f"| {kind} | {counts.total()} | {counts['ok']} | {others or 'none'} |")
    print(PAGE.format(number=number, rows="\n".join(rows)), end="")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:2]))
