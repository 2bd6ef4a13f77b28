# SPDX-License-Identifier: GPL-3.0-or-later
"""core.predict against closed forms: paper models, the round sphere, the doubled mesh, and the equation itself.
Against measured embeddings: test_predict_measured.py."""

import folded
import numpy as np
import pytest
import shapes
from conway import features
from creatures import creature, parted
from families import MESHES, mesh_named
from meshes import far_apart, icosphere, torus
from picks import picks_for
from predicted import Surface, random_cones
from roundness import KLEIN, flat_scale, flat_spread, klein_samples, octasphere, round_spread

import core

MODELS = {**{name: folded.model for name in folded.FOLDS}, "2222 tetrahedron": None}


def model(name):
    return folded.model(name) if MODELS[name] else folded.tetrahedron_model()


# ------------------------------------------------------------------------------------------------- exact


@pytest.mark.parametrize("name", MODELS)
def test_paper_models_are_not_stretched(name):
    made = model(name)
    said = core.predict(made.vertices, made.triangles, made.signature, made.cones)
    assert said.spread < 1e-9 and np.abs(said.scale).max() < 1e-9


@pytest.mark.parametrize("name", MODELS)
def test_paper_models_with_cones_elsewhere_are_stretched(name):
    made = model(name)
    random = np.random.default_rng(3)
    cones = random_cones(made.vertices, made.triangles, made.signature, random)
    assert core.predict(made.vertices, made.triangles, made.signature, cones).spread > 0.1


DOUBLES = {"*442": "442", "*632": "632", "*2222": "2222", "*432": "432", "*225": "225", "*237": "237", "4*2": "442",
           "3*3": "333", "2*22": "2222", "22*": "2222", "3*2": "332", "2*3": "223", "5*3": "553", "23*4": "22334",
           "*22222": "22222"}  # fmt: skip


@pytest.mark.parametrize("signature", DOUBLES)
def test_a_disk_is_half_of_its_double(signature):
    """Neumann's problem: the doubled surface has the disk's log scale on both sheets."""
    vertices, triangles = shapes.disk(7)
    whole, faces, other = folded.doubled(vertices, triangles)
    cones = random_cones(vertices, triangles, signature, np.random.default_rng(len(signature)))
    orders = dict(zip(cones, features(signature).orders))
    both = sorted({v for c in cones for v in (c, other[c])})
    numbers = {**orders, **{int(other[c]): n for c, n in orders.items()}}
    disk = core.predict(vertices, triangles, signature, cones)
    closed = core.predict(whole, faces, DOUBLES[signature], both, orders=[numbers[v] for v in both])
    assert disk.spread == pytest.approx(closed.spread, rel=1e-6)
    assert np.abs(closed.scale[: len(vertices)] - disk.scale).max() < 1e-6
    assert np.abs(closed.scale[other] - disk.scale).max() < 1e-6


def ellipsoid():
    vertices, triangles = icosphere(4)
    return vertices * [1.0, 0.85, 1.15] * (1 + 0.05 * np.sin(2 * vertices[:, [1]])), triangles


def bowl():
    vertices, triangles = octasphere(4)
    return parted(vertices * [1.0, 0.9, 1.2], triangles, lambda middle: middle[:, 2] > 0)


SIGNATURES = ["442", "333", "632", "2222", "432", "532", "332", "22(12)", "237", "334", "22222", "2" * 8]


@pytest.mark.parametrize("signature", [*SIGNATURES, "*442", "*432", "*237", "4*2", "22*", "3*2", "5*3"])
def test_the_scale_gives_the_orbifold_s_curvature(signature):
    """Without cones the curvature is spread as the stretched area is; at a cone the rest is 2 pi (1 - 1/n), at a
    corner half of it."""
    closed = features(signature).topology[2] == 0
    mesh = ellipsoid() if closed else bowl()
    surface = Surface(*mesh)
    assert surface.is_delaunay()  # so that no other Laplacian is better
    cones = random_cones(*mesh, signature, np.random.default_rng(8))
    said = core.predict(*mesh, signature, cones)
    scale, euler = said.scale, float(features(signature).euler)
    assert scale.shape == (len(mesh[0]),) and scale.dtype == np.float64
    assert abs(surface.areas @ scale) < 1e-9
    assert said.spread == pytest.approx(surface.spread_of(scale), rel=1e-6)
    wanted = np.zeros(len(scale))
    for v, n in zip(cones, features(signature).orders):
        wanted[v] = surface.whole_angle[v] * (1 - 1 / n)
    spread_out = surface.curvature_of(scale) - wanted
    assert spread_out.sum() == pytest.approx(2 * np.pi * euler, abs=1e-6)
    if euler == 0:
        assert np.abs(spread_out).max() < 1e-8
    else:
        stretched = surface.areas * np.exp(2 * (scale - scale.max()))
        stretched /= stretched.sum()
        assert np.abs(spread_out / (2 * np.pi * euler) - stretched).sum() < 0.02


# ------------------------------------------------------------------------------------------------- in the limit

OCTAHEDRON = {"right angles": [0, 2, 4], "on a great circle": [0, 1, 4], "another": [0, 3, 5]}


def off_by(said, exact):
    return abs(said / exact - 1)


@pytest.mark.parametrize("cones", OCTAHEDRON)
@pytest.mark.parametrize("signature", KLEIN)
def test_spherical_cones_on_a_round_sphere(signature, cones):
    """The share of the area that each part gets depends on the scale itself: this is the fixed point of it."""
    orders, _, _ = KLEIN[signature]
    picked, errors = OCTAHEDRON[cones], []
    for level in (3, 4, 5):
        vertices, triangles = octasphere(level)
        said = core.predict(vertices, triangles, signature, picked, orders=orders).spread
        errors.append(off_by(said, round_spread(signature, vertices[picked])))
    assert errors[0] > 1.5 * errors[1] > 1.5**2 * errors[2], errors
    assert errors[2] < 0.012, errors


@pytest.mark.parametrize("signature, picked", [("442", [0, 2, 4]), ("632", [0, 1, 4]), ("333", [0, 3, 5]),
                                               ("2222", [0, 1, 2, 4])])  # fmt: skip
def test_euclidean_cones_on_a_round_sphere(signature, picked):
    orders, errors = features(signature).orders, []
    for level in (3, 4, 5):
        vertices, triangles = octasphere(level)
        said = core.predict(vertices, triangles, signature, picked).spread
        errors.append(off_by(said, flat_spread(vertices[picked], orders)))
    assert errors[0] > 1.5 * errors[1] > 1.5**2 * errors[2], errors
    assert errors[2] < 0.006, errors


def test_scale_on_a_round_sphere_point_by_point():
    """Away from the cones, up to a constant."""
    vertices, triangles = octasphere(5)
    far = np.linalg.norm(vertices[:, None] - vertices[[0, 2, 4]], axis=2).min(1) > 0.3
    flat = core.predict(vertices, triangles, "442", [0, 2, 4]).scale - flat_scale(
        vertices + 1e-9, vertices[[0, 2, 4]], (4, 4, 2)
    )
    assert np.ptp(flat[far]) < 0.01
    orders, _, _ = KLEIN["432"]
    points, u, _ = klein_samples("432", vertices[[0, 2, 4]], 2000)
    points, u = points[(points @ vertices[[0, 2, 4]].T < 0.9).all(1)], u[(points @ vertices[[0, 2, 4]].T < 0.9).all(1)]
    nearest = np.argmax(points @ vertices.T, 1)
    near = (points * vertices[nearest]).sum(1) > np.cos(0.012)
    assert near.sum() > 50
    said = core.predict(vertices, triangles, "432", [0, 2, 4], orders=orders).scale[nearest]
    assert np.ptp((said - u)[near]) < 0.08


def test_hemisphere_is_half_of_a_sphere():
    """*222 with corners on its rim at right angles and opposite: the round sphere's 222."""
    vertices, triangles = shapes.hemisphere(24)
    rim = np.flatnonzero(vertices[:, 2] < 1e-9)
    angle = np.degrees(np.arctan2(vertices[rim, 1], vertices[rim, 0]))
    corners = [int(rim[np.argmin(np.abs(angle - wanted))]) for wanted in (0, 90, 180)]
    exact = round_spread("222", vertices[[corners[1], corners[0], corners[2]]])
    assert off_by(core.predict(vertices, triangles, "*222", corners).spread, exact) < 0.02


# ------------------------------------------------------------------------------------------------- invariance


@pytest.mark.parametrize("signature", ["442", "2222", "432", "22(7)", "237", "22222"])
def test_neither_scale_nor_motion_nor_numbering_matters(signature):
    vertices, triangles = shapes.roughened(creature(3, 0.2), 4)
    cones = random_cones(vertices, triangles, signature, np.random.default_rng(2))
    before = core.predict(vertices, triangles, signature, cones)
    for factor in (1e-6, 0.37, 1e9):
        after = core.predict(factor * folded.turned(vertices, 5), triangles, signature, cones)
        assert after.spread == pytest.approx(before.spread, rel=1e-7)
        assert np.abs(after.scale - before.scale).max() < 1e-6
    moved, faces, new = folded.renumbered(vertices, triangles, 6)
    after = core.predict(moved, faces, signature, new[cones])
    assert after.spread == pytest.approx(before.spread, rel=1e-9)
    assert np.abs(after.scale[new] - before.scale).max() < 1e-8
    mirrored = core.predict(vertices * [1, 1, -1], triangles[:, ::-1], signature, cones)
    assert mirrored.spread == pytest.approx(before.spread, rel=1e-9)


def test_only_the_cones_orders_matter_not_their_sequence():
    vertices, triangles = shapes.roughened(creature(3), 4)
    cones = far_apart(vertices, triangles, 3)
    plain = core.predict(vertices, triangles, "632", cones)
    turned = core.predict(vertices, triangles, "632", cones[[2, 0, 1]], orders=[2, 6, 3])
    assert turned.spread == pytest.approx(plain.spread, rel=1e-12)
    assert core.predict(vertices, triangles, "326", cones[[1, 2, 0]]).spread == pytest.approx(plain.spread, rel=1e-12)
    other = core.predict(vertices, triangles, "632", cones, orders=[2, 6, 3])
    assert other.spread != pytest.approx(plain.spread, rel=1e-3)


def test_isolated_vertices_have_no_scale():
    vertices, triangles = shapes.roughened(creature(2), 1)
    cones = far_apart(vertices, triangles, 3)
    before = core.predict(vertices, triangles, "432", cones)
    more = np.vstack([[[5.0, 5, 5]], vertices, [[1e3, 0, 0]]])
    after = core.predict(more, triangles + 1, "432", np.array(cones) + 1)
    assert after.spread == pytest.approx(before.spread, rel=1e-12) and after.scale[[0, -1]].tolist() == [0, 0]
    assert np.abs(after.scale[1:-1] - before.scale).max() < 1e-12


# ------------------------------------------------------------------------------------------------- all topologies


@pytest.mark.parametrize("signature", ["o", "**", "*x", "xx", "22x"])
def test_every_flat_surface(signature):
    """Those without a choice of cones too: their conformal map is as good as the mesh."""
    wanted = features(signature)
    for name in [name for name, make in MESHES[wanted.topology].items() if make]:
        mesh = mesh_named(wanted.topology, name)
        cones = picks_for(*mesh, wanted)
        said = core.predict(*mesh, signature, cones)
        measured = core.embed(*mesh, signature, cones, weights="conformal").report["distortion"]["log_area_std"]
        assert said.spread == pytest.approx(measured, rel=0.1, abs=0.06), name


def test_holes_are_filled_as_for_the_embedding():
    vertices, triangles = shapes.punctured(*icosphere(3), [0, 40], 1)
    with pytest.raises(core.OrbifoldError) as caught:
        core.predict(vertices, triangles, "442", [100, 200, 300])
    assert caught.value.status == "ORB_BOUNDARY"
    said = core.predict(vertices, triangles, "442", [100, 200, 300], holes="fill")
    whole = core.predict(*icosphere(3), "442", _numbers_before([100, 200, 300], vertices, icosphere(3)[0]))
    assert said.scale.shape == (len(vertices),) and said.spread == pytest.approx(whole.spread, rel=0.05)
    mirrored = core.predict(vertices, triangles, "442", [100, 200, 300], holes="mirror")
    by_name = core.predict(vertices, triangles, "442**", [100, 200, 300])
    assert mirrored.spread == pytest.approx(by_name.spread, rel=1e-9)


def _numbers_before(cones, vertices, before):
    return [int(np.argmin(np.linalg.norm(before - vertices[c], axis=1))) for c in cones]


# ------------------------------------------------------------------------------------------------- refusals


def refused(*arguments, **options):
    with pytest.raises(core.OrbifoldError) as caught:
        core.predict(*arguments, **options)
    assert len(str(caught.value)) > 10 and "\n" not in str(caught.value)
    return caught.value


def test_errors_are_those_of_the_embedding():
    vertices, triangles = icosphere(1)
    cones = [0, 1, 2]
    assert refused(vertices, triangles[1:], "442", cones).status == "ORB_BOUNDARY"
    assert refused(*torus(), "442", cones).status == "ORB_WRONG_GENUS"
    assert refused(vertices, triangles, "4?2", cones).status == "ORB_BAD_SIGNATURE"
    assert refused(vertices, triangles, "23", [0, 1]).status == "ORB_BAD_ORBIFOLD"
    assert refused(vertices, triangles, "442", [0, 1]).status == "ORB_CONE_COUNT"
    assert refused(vertices, triangles, "442", cones, orders=[4, 4, 4]).status == "ORB_BAD_ORDER"
    for picked, named in (([0, 1, 0], [0]), ([0, 1, 1000], [1000]), ([0, -3, 1], [-3])):
        error = refused(vertices, triangles, "442", picked)
        assert (error.status, error.element, error.elements) == ("ORB_BAD_CONE", "vertex", named)
    broken = vertices.copy()
    broken[11, 2] = np.nan
    error = refused(broken, triangles, "442", cones)
    assert (error.status, error.elements) == ("ORB_NON_FINITE", [11])
    twice = np.vstack([vertices, vertices + 3]), np.vstack([triangles, triangles + len(vertices)])
    assert refused(*twice, "442", cones).status == "ORB_SEVERAL_COMPONENTS"
    assert refused(np.zeros((0, 3)), np.zeros((0, 3), int), "442", cones).status.startswith("ORB_")


def test_triangles_without_area_are_no_disaster():
    """A sliver collapsed to a segment: predicted all the same, or refused by name."""
    vertices, triangles = icosphere(2)
    vertices = vertices.copy()
    a, b, c = triangles[30]
    vertices[a] = (vertices[b] + vertices[c]) / 2
    cones = far_apart(vertices, triangles, 3)
    try:
        said = core.predict(vertices, triangles, "442", cones)
        assert np.isfinite(said.spread) and np.isfinite(said.scale).all() and said.spread < 10
    except core.OrbifoldError as error:
        assert error.status == "ORB_ZERO_AREA_TRIANGLE" and 30 in error.elements


@pytest.mark.parametrize("size", [1e-300, 1e-150, 1e150, 1e300])
def test_coordinates_near_the_ends_of_double_precision(size):
    vertices, triangles = shapes.roughened(creature(2), 1)
    cones = far_apart(vertices, triangles, 3)
    before = core.predict(vertices, triangles, "442", cones).spread
    assert core.predict(vertices * size, triangles, "442", cones).spread == pytest.approx(before, rel=1e-6)
