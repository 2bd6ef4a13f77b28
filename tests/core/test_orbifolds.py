# SPDX-License-Identifier: GPL-3.0-or-later
"""embed() on every kind of surface and orbifold: mirrors, handles, cross-caps, holes, fixed boundaries."""

import json

import numpy as np
import pytest
import families
import shapes
import surfaces
from meshes import agrees, uv_area

import core

SPHERICAL = ["532", "332", "22(6)", "44", "*532", "*432", "*332", "*225", "*44", "3*2", "2*5", "5*", "2*", "3x"]
EUCLIDEAN = ["442", "2222", "*442", "*333", "*632", "*2222", "4*2", "3*3", "2*22", "22*", "22x", "**", "*x", "xx", "o"]
HYPERBOLIC = ["237", "22222", "*237", "*22222", "5*3", "3*22", "222*", "222x", "2**", "**2", "o2", "o22", "o*", "oo",
              "ooo", "3xx", "***", "2*x", "*2*3"]
WEIGHTS = ["cotan", "mean-value", "uniform", "conformal", "delaunay"]


def embedded(signature, mesh=None, **options):
    mesh = mesh or surfaces.surface_for(signature)
    return core.embed(*mesh, signature, surfaces.picks_for(mesh, signature), **options)


@pytest.mark.parametrize("signature", [*SPHERICAL, *EUCLIDEAN, *HYPERBOLIC])
def test_signature_is_embedded_and_certified(signature, tmp_path):
    mesh = surfaces.surface_for(signature)
    result = embedded(signature, mesh)
    agrees(result, tmp_path)
    read, seen = core.parse_signature(signature), core.topology_of(mesh[1])
    report = json.loads(json.dumps(result.report))
    assert report == result.report and report["orbifold"]["geometry"] == read.geometry == result.geometry
    assert (report["mesh"]["boundary_loops"], report["mesh"]["genus"]) == (len(seen.loops), seen.genus)
    assert report["mesh"]["orientable"] is seen.orientable
    border = np.isin(result.cones, np.concatenate(seen.loops)) if seen.loops else np.zeros(len(result.cones), bool)
    assert np.array_equal(result.mirrors, border)
    assert [cone["mirror"] for cone in report["orbifold"]["cones"]] == border.tolist()
    modulus = report["orbifold"]["modulus"]
    assert (modulus is None) == (read.geometry != "euclidean")
    assert modulus is None or modulus[1] > 0
    assert result.uv.shape == (len(mesh[1]), 3, 2) and result.corner_copies.shape == mesh[1].shape
    assert np.array_equal(result.vertices[: len(mesh[0])], mesh[0])
    assert np.array_equal(result.cut_to_vertex[result.corner_copies], mesh[1])
    if seen.orientable and result.refined_from is None:
        assert np.array_equal(result.triangles, mesh[1])


@pytest.mark.parametrize("signature", [*SPHERICAL, *EUCLIDEAN, *HYPERBOLIC])
def test_generators_are_isometries_that_glue_the_seams(signature):
    """Each seam edge's one side is carried to the other by an element near the identity of the group, and no mirror
    leaves its reflection out."""
    result, group = embedded(signature), surfaces.bare("group")
    curvature = {"spherical": 1, "euclidean": 0, "hyperbolic": -1}[result.geometry]
    form = np.diag([1.0, 1.0, curvature])
    for matrix in result.generators:
        if curvature:
            assert np.allclose(matrix.T @ form @ matrix, form, atol=1e-8 * np.abs(matrix).max() ** 2)
        else:
            assert np.allclose(matrix[:2, :2].T @ matrix[:2, :2], np.eye(2), atol=1e-12)
    moves = np.concatenate([np.eye(3)[None], group.with_inverses(result.generators, curvature)])
    sides = {}
    for copies, vertices in zip(result.cut_triangles.tolist(), result.triangles.tolist()):
        for k in range(3):
            edge = sorted([(vertices[k], copies[k]), (vertices[(k + 1) % 3], copies[(k + 1) % 3])])
            sides.setdefault((edge[0][0], edge[1][0]), []).append([edge[0][1], edge[1][1]])
    for a, b in result.seams.tolist():
        one, other = (result.embedding[side] for side in sides[min(a, b), max(a, b)])
        gaps = np.abs(one @ moves.transpose(0, 2, 1) - other).max((1, 2))
        assert gaps.min() < 1e-6 * max(1, np.abs(other).max()), (a, b, gaps.min())
    assert (np.linalg.det(result.generators) < 0).any() == ("*" in signature or "x" in signature)
    elements = group.Group(result.generators, curvature, result.embedding[np.unique(result.cut_triangles)]).nearest(200)
    assert len(elements) == (round(2 / core.parse_signature(signature).euler) if curvature > 0 else 200)


@pytest.mark.parametrize("signature", ["*442", "2*5", "o", "22x", "*237", "3*22"])
@pytest.mark.parametrize("weights", WEIGHTS)
def test_weights(signature, weights, tmp_path):
    result = embedded(signature, weights=weights)
    agrees(result, tmp_path)
    with np.load(tmp_path / "mesh.npz") as saved:
        assert ("weights" in saved) == (result.weights is not None and "x" not in signature)
        assert ("refined_from" in saved) == (result.refined_from is not None)


def test_exact_mean_value_weights_are_for_the_plane(tmp_path):
    agrees(embedded("*442", weights="mean-value-exact"), tmp_path)
    with pytest.raises(core.OrbifoldError) as caught:
        embedded("*432", weights="mean-value-exact")
    assert caught.value.status == "ORB_BAD_ARGUMENT"


def test_corners_may_be_given_in_another_sequence():
    mesh = shapes.disk()
    a, b, c = surfaces.picks_for(mesh, "*632")
    plain = core.embed(*mesh, "*632", [a, b, c])
    other = core.embed(*mesh, "*632", [c, a, b], orders=[2, 6, 3])
    assert other.cones.tolist() == [c, a, b] and other.orders.tolist() == [2, 6, 3]
    shares = [np.abs(uv_area(r.uv_chart("conformal"))) for r in (plain, other)]
    assert np.abs(shares[0] / shares[0].sum() - shares[1] / shares[1].sum()).max() < 1e-9


def test_a_mesh_that_is_not_orientable_may_have_any_orientation():
    vertices, triangles = shapes.klein_figure_eight()
    turned = triangles.copy()
    turned[::2] = turned[::2, ::-1]
    result = core.embed(vertices, turned, "xx")
    assert np.array_equal(result.cut_to_vertex[result.corner_copies], turned)
    assert (uv_area(result.tile_uv("conformal")) > 0).all()


@pytest.mark.parametrize("holes, signature, expected", [("fill", "442", "442"), ("mirror", "442", "442**"),
                                                        ("fill", "*222", "*222"), ("mirror", "*222", "*222*")])
def test_holes(holes, signature, expected, tmp_path):
    mesh = families.holed(families.ellipsoid(), 2)
    picks = surfaces.picks_for(mesh, signature)
    with pytest.raises(core.OrbifoldError) as caught:
        core.embed(*mesh, signature, picks)
    assert caught.value.status == "ORB_BOUNDARY" and caught.value.element == "edge"
    result = core.embed(*mesh, signature, picks, holes=holes)
    agrees(result, tmp_path)
    assert sorted(result.signature) == sorted(expected)
    assert result.filled_holes == (2 - signature.count("*") if holes == "fill" else 0)
    assert result.uv.shape == (len(mesh[1]), 3, 2)
    if holes == "fill":
        assert (result.refined_from < 0).any() and len(result.triangles) > len(mesh[1])
        assert result.report["mesh"]["boundary_loops"] == 2


def test_chords_between_mirrors_are_halved(tmp_path):
    """A strip of triangles: every vertex lies on the border, so inner edges join points of one mirror."""
    x = np.arange(12.0)
    vertices = np.stack([np.repeat(x, 2), np.tile([0.0, 1.0], 12), np.zeros(24)], 1)
    triangles = np.array([t for i in range(0, 22, 2) for t in ([i, i + 2, i + 3], [i, i + 3, i + 1])])
    result = core.embed(vertices, triangles, "*333", [0, 23, 10])
    agrees(result, tmp_path)
    assert result.refined_from is not None and result.refined_edges > 0 and result.filled_holes == 0
    assert len(result.vertices) > 24 and result.uv.shape == (len(triangles), 3, 2)
    assert np.array_equal(result.cut_to_vertex[result.corner_copies], triangles)
    assert set(result.refined_from.tolist()) == set(range(len(triangles)))


@pytest.mark.parametrize("geometry", ["euclidean", "spherical", "hyperbolic"])
@pytest.mark.parametrize("n", [0, 3, 5])
def test_fixed_boundary(geometry, n):
    mesh = shapes.disk()
    result = core.embed(*mesh, polygon=core.Polygon(geometry, n=n))
    assert result.geometry == geometry and not len(result.seams) and result.uv.shape == (len(mesh[1]), 3, 2)
    assert (uv_area(result.tile_uv(result.chart)) > 0).all()
    loop = core.topology_of(mesh[1]).loops[0]
    picks = loop[:: len(loop) // 4][:4]
    picked = core.embed(*mesh, cones=picks, polygon=core.Polygon(geometry))
    corners = picked.embedding[picks]
    sides = np.linalg.norm(corners - np.roll(corners, 1, 0), axis=1)
    assert np.ptp(sides) < 1e-9


def test_fixed_boundary_with_corners_of_its_own():
    mesh = shapes.disk()
    corners = np.array([[0, 0], [3, 0], [3, 1], [0, 1.0]])
    result = core.embed(*mesh, polygon=core.Polygon(corners=corners))
    assert np.allclose(result.embedding[:, :2].min(0), 0) and np.allclose(result.embedding[:, :2].max(0), [3, 1])


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"signature": "442", "polygon": core.Polygon()},
        {"polygon": "square"},
        {"polygon": core.Polygon("flat")},
        {"polygon": core.Polygon(corners=[[0, 0], [1, 0], [1]])},
        {"polygon": core.Polygon("spherical", corners=[[0, 0], [1, 0], [1, 1]])},
        {"polygon": core.Polygon(corners=[[0, 0], [1, 0], [1, 1]], n=4)},
        {"polygon": core.Polygon(n="many")},
        {"polygon": core.Polygon(n=2)},
        {"signature": "*442", "holes": "close"},
        {"signature": "*442", "holes": None},
        {"signature": "*442", "holes": "mirror", "chart": "mercator"},
    ],
    ids=str,
)
def test_bad_arguments(options):
    with pytest.raises(core.OrbifoldError) as caught:
        core.embed(*shapes.disk(4), cones=[0, 4, 24], **options)
    assert caught.value.status == "ORB_BAD_ARGUMENT" and "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "signature, mesh, status",
    [
        ("442", shapes.disk, "ORB_BOUNDARY"),
        ("**", shapes.disk, "ORB_BOUNDARY"),
        ("o", shapes.klein_figure_eight, "ORB_WRONG_GENUS"),
        ("oo", shapes.torus, "ORB_WRONG_GENUS"),
        ("*442", families.ellipsoid, "ORB_BOUNDARY"),
    ],
)
def test_a_signature_of_another_surface(signature, mesh, status):
    vertices, triangles = mesh()
    with pytest.raises(core.OrbifoldError) as caught:
        core.embed(vertices, triangles, signature, list(range(len(core.parse_signature(signature).orders))))
    assert caught.value.status == status


def test_corners_lie_on_the_border_and_cones_do_not():
    mesh = shapes.disk()
    corner, inside = int(core.topology_of(mesh[1]).loops[0][0]), surfaces.picks_for(mesh, "5*")[0]
    for cones in ([inside, inside + 1], [corner, corner + 1]):
        with pytest.raises(core.OrbifoldError) as caught:
            core.embed(*mesh, "4*2", cones)
        assert caught.value.status == "ORB_BAD_CONE" and caught.value.element == "vertex"
