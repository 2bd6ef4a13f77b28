# SPDX-License-Identifier: GPL-3.0-or-later
"""The surfaces that the tests make are what their names say."""

import numpy as np
import pytest
import shapes
from meshes import far_apart, icosphere
from picks import along, boundary_loops, inside
from topology import topology_of


def crosscaps(n, holes=0):
    vertices, triangles = icosphere(3)
    places = far_apart(vertices, triangles, n + holes)
    surface = shapes.with_crosscaps(vertices, triangles, places[:n])
    return shapes.punctured(*surface, inside(*surface, holes)) if holes else surface


MADE = {  # name: (mesh, Euler characteristic, boundary loops, orientable)
    "annulus": (shapes.annulus, 0, 2, True),
    "cylinder": (shapes.cylinder, 0, 2, True),
    "moebius": (shapes.moebius_band, 0, 1, False),
    "moebius of three": (lambda: shapes.moebius_band(twists=3), 0, 1, False),
    "figure eight": (shapes.klein_figure_eight, 0, 0, False),
    "bottle": (shapes.klein_bottle, 0, 0, False),
    "torus": (shapes.torus, 0, 0, True),
    "disk": (shapes.disk, 1, 1, True),
    "hemisphere": (shapes.hemisphere, 1, 1, True),
    "boy": (shapes.boy_surface, 1, 0, False),
    "boy, coarse": (lambda: shapes.boy_surface(1), 1, 0, False),
    "pretzel 1": (lambda: shapes.pretzel(1), 0, 0, True),
    "pretzel 2": (lambda: shapes.pretzel(2), -2, 0, True),
    "pretzel 3": (lambda: shapes.pretzel(3), -4, 0, True),
    "plate": (lambda: shapes.plate(0), 1, 1, True),
    "plate 1": (lambda: shapes.plate(1), 0, 2, True),
    "plate 2": (lambda: shapes.plate(2), -1, 3, True),
    "crosscap": (lambda: crosscaps(1), 1, 0, False),
    "crosscaps": (lambda: crosscaps(3), -1, 0, False),
    "crosscaps, hole": (lambda: crosscaps(2, 1), -1, 1, False),
    "torus, holes": (lambda: shapes.punctured(*shapes.torus(), [0, 95], 2), -2, 2, True),
}


@pytest.mark.parametrize("rough", [False, True], ids=["smooth", "rough"])
@pytest.mark.parametrize("name", MADE)
def test_surface_is_what_it_should_be(name, rough):
    make, euler, loops, orientable = MADE[name]
    vertices, triangles = shapes.roughened(make()) if rough else make()
    found = topology_of(triangles)
    assert (found.euler, found.loops, found.orientable, found.oriented) == (euler, loops, orientable, orientable)
    corners = vertices[triangles]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    assert area.min() > 1e-4 * np.median(area)
    assert len(np.unique(triangles)) == len(vertices)


def test_solids_are_oriented_outwards():
    for genus in (1, 2):
        a, b, c = np.moveaxis(np.array(shapes.pretzel(genus)[0])[shapes.pretzel(genus)[1]], 1, 0)
        assert np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6 > genus


@pytest.mark.parametrize("name", MADE)
def test_picks_are_distinct_and_where_they_should_be(name):
    vertices, triangles = MADE[name][0]()
    loops = boundary_loops(triangles)
    border = {v for loop in loops for v in loop}
    for loop in loops:
        corners = along(vertices, loop, 5, 0.93)
        places = [loop.index(v) for v in corners]
        assert len(set(corners)) == 5 and sum(np.diff(places + places[:1]) < 0) == 1  # once round
    cones = inside(vertices, triangles, 6)
    assert len(set(cones)) == 6 and not border & set(cones)
