# SPDX-License-Identifier: GPL-3.0-or-later
"""Which surface a mesh is."""

import numpy as np
import pytest
import families
import shapes
from meshes import icosphere, tetrahedron

import core

# mesh: Euler characteristic, boundary loops, orientable, genus
KNOWN = {
    "tetrahedron": (tetrahedron, 2, 0, True, 0),
    "sphere": (families.ellipsoid, 2, 0, True, 0),
    "disk": (shapes.disk, 1, 1, True, 0),
    "annulus": (shapes.annulus, 0, 2, True, 0),
    "Möbius band": (shapes.moebius_band, 0, 1, False, 1),
    "Klein bottle": (shapes.klein_figure_eight, 0, 0, False, 2),
    "torus": (shapes.torus, 0, 0, True, 1),
    "projective plane": (shapes.boy_surface, 1, 0, False, 1),
    "genus 2": (lambda: shapes.pretzel(2), -2, 0, True, 2),
    "genus 3": (lambda: shapes.pretzel(3), -4, 0, True, 3),
    "torus with two borders": (lambda: families.holed(shapes.torus(), 2), -2, 2, True, 1),
}


@pytest.mark.parametrize("name", KNOWN)
def test_known_surfaces(name):
    make, euler, loops, orientable, genus = KNOWN[name]
    vertices, triangles = make()
    assert len(np.unique(triangles)) == len(vertices) or "borders" in name
    seen = core.topology_of(triangles)
    assert (seen.euler, len(seen.loops), seen.orientable, seen.genus) == (euler, loops, orientable, genus)
    assert seen.components == 1


@pytest.mark.parametrize("name", ["sphere", "annulus", "torus"])
def test_turned_triangles_do_not_matter(name):
    _, triangles = KNOWN[name][0]()
    turned = triangles.copy()
    turned[::3] = turned[::3, ::-1]
    plain, other = core.topology_of(triangles), core.topology_of(turned)
    assert other.orientable and other.genus == plain.genus and other.euler == plain.euler


def test_loops_run_along_the_boundary_the_longest_first():
    vertices, triangles = families.holed(shapes.disk(), 2)
    loops = core.topology_of(triangles).loops
    halfedges = {(int(t[k]), int(t[(k + 1) % 3])) for t in triangles for k in range(3)}
    single = {edge for edge in halfedges if edge[::-1] not in halfedges}
    along = {tuple(sorted((int(a), int(b)))) for loop in loops for a, b in zip(loop, np.roll(loop, -1))}
    assert along == {tuple(sorted(edge)) for edge in single}
    assert [len(loop) for loop in loops] == sorted((len(loop) for loop in loops), reverse=True)


def test_polygons_components_and_isolated_vertices():
    corners = np.array([0, 1, 2, 3, 3, 2, 7, 10, 11, 12])
    seen = core.topology_of(corners, np.array([4, 3, 3]))
    assert (seen.components, seen.euler, len(seen.loops), seen.orientable) == (2, 2, 2, True)
    assert core.topology_of(np.zeros((0, 3), int)).components == 0


def test_large_meshes_take_no_time():
    _, triangles = icosphere(6)
    turned = triangles.copy()
    turned[::2] = turned[::2, ::-1]
    assert core.topology_of(turned).genus == 0
