# SPDX-License-Identifier: GPL-3.0-or-later
"""Every row of the tables of orbifolds (docs/mathematics.md, section 4), and meshes of each topology to try them on."""

import functools

import numpy as np
import shapes
from conway import features
from meshes import far_apart, icosphere, shared_file
from picks import inside

import core

NS = (2, 3, 5)
SPHERICAL = [
    *["532", "432", "332", *(f"22{n}" for n in NS), *(f"{n}{n}" for n in NS)],
    *["*532", "*432", "*332", *(f"*22{n}" for n in NS), *(f"*{n}{n}" for n in NS)],
    *["3*2", *(f"2*{n}" for n in NS), *(f"{n}*" for n in NS), *(f"{n}x" for n in NS)],
]
EUCLIDEAN = [
    *["442", "333", "632", "2222", "*442", "*333", "*632", "*2222", "4*2", "3*3", "2*22", "22*", "22x"],
    *["**", "*x", "xx", "o"],
]
HYPERBOLIC = [
    *["237", "22222", "3(11)2", "2" * 20],  # spheres
    *["*237", "*334", "*22222", "*2345", "*" + "2" * 12],  # disks
    *["5*3", "2*23", "22*2", "3*22", "3*33", "23*", "222*", "23*4", "2*2222", "222*23", "34*5", "345*2"],
    *["2**", "**2", "*2*2", "*22*3", "23**2", "2*3*4"],  # annuli
    *["***", "***2", "2***", "*2*2*2"],  # with three holes and more
    *["23x", "222x", "(10)3x", "*2x", "*22x", "2*x", "3*2x"],  # projective planes, Moebius bands
    *["2xx", "33xx", "xxx", "2xxx", "*xx", "**x"],  # with more cross-caps
    *["o2", "o33", "o7", "o*", "o*2", "o**", "oo", "oo2", "oo*", "ooo", "ooo33"],  # with handles
]


def ellipsoid():
    vertices, triangles = icosphere(3)
    return vertices * [1.0, 0.7, 1.6] + 0.1 * np.sin(3 * vertices[:, [1, 2, 0]]), triangles


def sphere_with(crosscaps=0, holes=0):
    vertices, triangles = icosphere(3)
    surface = shapes.with_crosscaps(vertices, triangles, far_apart(vertices, triangles, 6)[:crosscaps])
    return shapes.punctured(*surface, inside(*surface, holes), 2) if holes else surface


def holed(surface, holes):
    return shapes.punctured(*surface, inside(*surface, holes), 2)


# (handles, cross-caps, boundaries): {name: how to make it}; a name with an ending is a file of ../shared/meshes
MESHES = {
    (0, 0, 0): {"ellipsoid": ellipsoid, "spot.obj": None},
    (0, 0, 1): {
        **{"disk": shapes.disk, "hemisphere.obj": None, "plate": lambda: shapes.plate(0, 5), "lion.off": None},
        **{"cap": shapes.hemisphere, "camelhead.off": None},
    },
    (0, 0, 2): {"annulus": shapes.annulus, "cylinder": shapes.cylinder, "plate": lambda: shapes.plate(1)},
    (0, 0, 3): {"plate": lambda: shapes.plate(2), "halftunnel.off": None},
    (0, 1, 0): {"boy": shapes.boy_surface, "crosscap": lambda: sphere_with(1)},
    (0, 1, 1): {
        **{"moebius": shapes.moebius_band, "three twists": lambda: shapes.moebius_band(40, 6, twists=3)},
        "crosscap": lambda: sphere_with(1, 1),
    },
    (0, 1, 2): {"moebius": lambda: holed(shapes.moebius_band(36, 12, 1.2), 1), "crosscap": lambda: sphere_with(1, 2)},
    (0, 2, 0): {"figure eight": shapes.klein_figure_eight, "bottle": shapes.klein_bottle},
    (0, 2, 1): {"bottle": lambda: holed(shapes.klein_bottle(), 1), "crosscaps": lambda: sphere_with(2, 1)},
    (0, 3, 0): {
        "crosscaps": lambda: sphere_with(3),
        "torus": lambda: shapes.with_crosscaps(*shapes.torus(30, 16), [0]),
    },
    (1, 0, 0): {"torus": shapes.torus, "block": lambda: shapes.pretzel(1), "kitten.obj": None},
    (1, 0, 1): {"torus": lambda: holed(shapes.torus(), 1), "block": lambda: holed(shapes.pretzel(1), 1)},
    (1, 0, 2): {"torus": lambda: holed(shapes.torus(), 2), "block": lambda: holed(shapes.pretzel(1, 3), 2)},
    (2, 0, 0): {"block": lambda: shapes.pretzel(2), "fine block": lambda: shapes.pretzel(2, 3)},
    (2, 0, 1): {"block": lambda: holed(shapes.pretzel(2, 3), 1), "long": lambda: holed(shapes.pretzel(2), 1)},
    (3, 0, 0): {"block": lambda: shapes.pretzel(3), "three_holes.off": None},
}


@functools.lru_cache(maxsize=64)
def mesh_named(topology, name):
    """(vertices, triangles); the test is skipped by name where the file is not there."""
    make = MESHES[topology][name]
    return shapes.roughened(make(), seed=len(name)) if make else core.read_mesh(shared_file("meshes", name))


def cases(signatures):
    """(signature, mesh name): each on two meshes of its topology, in turn of those that there are."""
    turn, chosen = {}, []
    for signature in signatures:
        topology = features(signature).topology
        names = [name for name in MESHES[topology] if name != "kitten.obj"]  # large: once only
        at = turn[topology] = turn.get(topology, -2) + 2
        chosen += [(signature, names[(at + k) % len(names)]) for k in range(2)]
    return chosen
