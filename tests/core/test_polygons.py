# SPDX-License-Identifier: GPL-3.0-or-later
"""Theorem 1 of 2016 and 2017, and Tutte's and Floater's: the boundary on a convex polygon of the sphere, the plane or
the hyperbolic plane, and any positive weights inside: no triangle is flipped."""

import numpy as np
import pytest
import shapes
from judged import harmonic_residual, judge_module, model_points
from meshes import CHECK_LAYOUT, shared_file
from picks import along, boundary_loops

import core

GEOMETRIES = ["spherical", "euclidean", "hyperbolic"]
CURVATURE = {"spherical": 1, "euclidean": 0, "hyperbolic": -1}
MESHES = {
    "disk": lambda: shapes.roughened(shapes.disk(), flips=0),
    "cap": lambda: shapes.roughened(shapes.hemisphere(), seed=5, flips=0),
    "with chords": lambda: shapes.roughened(shapes.plate(0, 5), seed=4, flips=0.3),
}
pytestmark = pytest.mark.skipif(not CHECK_LAYOUT.is_file(), reason="../shared/tools/check_layout.py is not there")


def random_weights(triangles, seed):
    """From a thousandth to a thousand."""
    edges = shapes.edges_of(triangles)
    return np.column_stack([edges, 10.0 ** np.random.default_rng(seed).uniform(-3, 3, len(edges))])


def raised(plane, geometry):
    """Points (k, 2) of the unit disk as points of the model; straight lines stay straight (gnomonic, Klein)."""
    if geometry == "euclidean":
        return np.column_stack([plane, np.ones(len(plane))])
    plane = plane * (0.9 if geometry == "hyperbolic" else 1.5)
    height = 1 / np.sqrt(1 + CURVATURE[geometry] * (plane**2).sum(1))
    return np.column_stack([plane, np.ones(len(plane))]) * height[:, None]


def distance(p, q, geometry):
    judge = judge_module()
    return judge["length"](judge["log_map"](p, q, CURVATURE[geometry]), CURVATURE[geometry])


def check(result, geometry, tolerance=1e-7):
    """No flips, harmonic inside, and one piece without seams."""
    points = model_points(result)
    sign = judge_module()["orientation"](points[result.cut_triangles])
    assert (sign > 0).all() or (sign < 0).all()
    assert result.geometry == geometry and len(points) == len(result.vertices) and len(result.seams) == 0
    assert result.report["certificate"]["flipped"] == 0
    assert fixed_boundary_residual(result) < tolerance


def fixed_boundary_residual(result):
    """The harmonic residual of the vertices inside: those on the boundary are called cones for once."""
    border = np.array([v for loop in boundary_loops(result.triangles) for v in loop])

    class Inside:
        cones = border

        def __getattr__(self, name):
            return getattr(result, name)

    return harmonic_residual(Inside())


def check_boundary(result, corners, picked):
    """Corners go to corners; between them arc length on the mesh is in proportion to length along the side."""
    points, geometry = model_points(result), result.geometry
    where = np.empty_like(points)
    where[result.cut_to_vertex] = points
    (loop,) = boundary_loops(result.triangles)
    at = [loop.index(v) for v in picked]
    loop = loop[at[0] :] + loop[: at[0]]
    at = [loop.index(v) for v in picked]
    if at[1] > at[-1]:
        loop = loop[:1] + loop[:0:-1]
        at = [loop.index(v) for v in picked]
    loop, at = [*loop, loop[0]], [*at, len(loop)]
    for k, (first, last) in enumerate(zip(at, at[1:])):
        side = loop[first : last + 1]
        ends = corners[k], corners[(k + 1) % len(corners)]
        assert distance(where[side[0]], ends[0], geometry) < 1e-9 > distance(where[side[-1]], ends[1], geometry)
        length = np.linalg.norm(np.diff(result.vertices[side], axis=0), axis=1)
        share = np.cumsum(length)[:-1] / length.sum()
        whole = distance(*ends, geometry)
        for v, part in zip(side[1:-1], share):
            assert abs(distance(ends[0], where[v], geometry) - part * whole) < 1e-9
            assert abs(distance(ends[1], where[v], geometry) - (1 - part) * whole) < 1e-9


@pytest.mark.parametrize("n", [3, 4, 7, 20])
@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_regular_polygons(geometry, n):
    for name in MESHES:
        vertices, triangles = MESHES[name]()
        result = core.embed(vertices, triangles, None, [], polygon=core.Polygon(geometry, n=n), weights="cotan")
        check(result, geometry)
        picked = along(vertices, boundary_loops(triangles)[0], n)
        result = core.embed(vertices, triangles, None, picked, polygon=core.Polygon(geometry), weights="cotan")
        check(result, geometry)


@pytest.mark.parametrize("radius", [0.01, 0.7, 1.3])
@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_radius_of_a_regular_polygon(geometry, radius):
    vertices, triangles = MESHES["disk"]()
    picked = along(vertices, boundary_loops(triangles)[0], 5)
    polygon = core.Polygon(geometry, radius=radius)
    result = core.embed(vertices, triangles, None, picked, weights="cotan", polygon=polygon)
    check(result, geometry)
    corners = np.empty((5, 3))
    for copy, v in enumerate(result.cut_to_vertex):
        if v in picked:
            corners[picked.index(v)] = model_points(result)[copy]
    check_boundary(result, corners, picked)
    middle = corners.sum(0) / np.sqrt(abs(judge_module()["form"](corners.sum(0), corners.sum(0), CURVATURE[geometry])))
    if geometry == "euclidean":
        middle = corners.mean(0)
    assert np.abs(distance(corners, np.broadcast_to(middle, (5, 3)), geometry) - radius).max() < 1e-9


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("geometry", GEOMETRIES)
@pytest.mark.parametrize("name", MESHES)
def test_random_weights_on_a_random_convex_polygon(name, geometry, seed):
    vertices, triangles = MESHES[name]()
    random = np.random.default_rng(seed)
    angles = np.sort((np.arange(6) + random.uniform(0.1, 0.9, 6)) * 2 * np.pi / 6)
    corners = raised(np.stack([np.cos(angles), np.sin(angles)], 1), geometry)
    loop = boundary_loops(triangles)[0]
    picked = along(vertices, loop, 6, random.random())
    weights, polygon = random_weights(triangles, seed), core.Polygon(geometry, corners=corners)
    result = core.embed(vertices, triangles, None, picked, weights=weights, polygon=polygon)
    check(result, geometry, 1e-6)
    check_boundary(result, corners, picked)


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_corners_against_the_triangles_turn_the_mesh_over(geometry):
    vertices, triangles = MESHES["disk"]()
    corners = raised(np.array([[0.9, 0.1], [0, 1], [-0.8, 0.3], [-0.3, -0.6]]), geometry)
    picked = along(vertices, boundary_loops(triangles)[0], 4)[::-1]
    polygon = core.Polygon(geometry, corners=corners)
    result = core.embed(vertices, triangles, None, picked, weights="cotan", polygon=polygon)
    check(result, geometry)
    check_boundary(result, corners, picked)


@pytest.mark.parametrize("geometry", GEOMETRIES)
@pytest.mark.parametrize("weights", ["cotan", "mean-value", "uniform"])
def test_a_real_mesh(geometry, weights):
    mesh = core.read_mesh(shared_file("meshes", "hemisphere.obj"))
    check(core.embed(*mesh, None, [], weights=weights, polygon=core.Polygon(geometry, n=60)), geometry)


def failure(mesh, cones, polygon):
    with pytest.raises(core.OrbifoldError) as caught:
        core.embed(*mesh, None, cones, polygon=polygon)
    return caught.value


def test_refusals():
    disk = MESHES["disk"]()
    dented = np.array([[1, 0], [0, 1], [-1, 0], [0, 0.5], [0, -1]])
    square = np.array([[1, 0], [0, 1], [-1, 0], [0, -1]])
    for geometry in GEOMETRIES:
        assert failure(disk, [], core.Polygon(geometry, corners=raised(dented, geometry))).status == "ORB_BAD_ARGUMENT"
        assert failure(disk, [], core.Polygon(geometry, n=2)).status == "ORB_BAD_ARGUMENT"
    clockwise = core.Polygon("euclidean", corners=square[::-1])
    assert failure(disk, [], clockwise).status == "ORB_BAD_ARGUMENT"
    assert failure(disk, [], core.Polygon("spherical", n=5, radius=1.6)).status == "ORB_BAD_ARGUMENT"
    off = core.Polygon("spherical", corners=raised(square, "spherical") * 1.1)
    assert failure(disk, [], off).status == "ORB_BAD_ARGUMENT"
    error = failure(disk, [0, *along(disk[0], boundary_loops(disk[1])[0], 2)], core.Polygon("euclidean"))
    assert (error.status, error.element, error.elements) == ("ORB_BAD_CONE", "vertex", [0])
    assert failure(shapes.annulus(), [], core.Polygon("euclidean")).status == "ORB_BOUNDARY"
    assert failure(shapes.moebius_band(), [], core.Polygon("euclidean")).status == "ORB_WRONG_GENUS"
    assert failure(shapes.torus(), [], core.Polygon("euclidean")).status in ("ORB_BOUNDARY", "ORB_WRONG_GENUS")
