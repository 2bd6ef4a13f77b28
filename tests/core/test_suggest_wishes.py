# SPDX-License-Identifier: GPL-3.0-or-later
"""What a person may wish of suggestions: symmetry, cones that are there already, places without cones."""

import folded
import numpy as np
import pytest
import shapes
from conway import features
from creatures import creature, is_its_own_image, mirror_images, parted
from meshes import cube, far_apart, icosphere, octahedron, shared_file, subdivided
from picks import boundary_loops

import core

# ------------------------------------------------------------------------------------------------- symmetry

TURN, _ = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))
SHIFT = np.array([3.0, -7.0, 11.0])
PLANE = (1.0, 0.0, 0.0, 0.0)


def place(how, vertices):
    """(vertices, the mirror plane x = 0 moved with them)"""
    if how == "at the origin":
        return vertices, PLANE
    if how == "off the origin":
        return vertices + SHIFT, (1, 0, 0, SHIFT[0])
    if how == "y is up":
        return vertices[:, [1, 0, 2]] * 100 - SHIFT, (0, 1, 0, -SHIFT[1])
    return vertices @ TURN + SHIFT, (*TURN[0], TURN[0] @ SHIFT)


HOWS = ["at the origin", "off the origin", "y is up", "turned"]


def check_symmetric(suggestions, vertices, plane):
    image = mirror_images(vertices, plane)
    assert (image >= 0).all()
    for made in suggestions:
        assert made.symmetric and is_its_own_image(made, image), made


@pytest.mark.parametrize("how", HOWS)
def test_a_symmetric_mesh_gets_symmetric_cones(how):
    vertices, triangles = creature(4)
    vertices, plane = place(how, vertices)
    suggestions = core.suggest_cones(vertices, triangles)
    assert len(suggestions) > 15
    check_symmetric(suggestions, vertices, plane)


@pytest.mark.parametrize("how", ["at the origin", "turned"])
def test_numbering_hides_no_symmetry(how):
    vertices, triangles = creature(3)
    vertices, triangles, _ = folded.renumbered(vertices, triangles, 3)
    vertices, plane = place(how, vertices)
    check_symmetric(core.suggest_cones(vertices, triangles, ["442", "2222", "432", "237"]), vertices, plane)


@pytest.mark.parametrize("how", HOWS)
def test_a_given_plane_is_kept_to(how):
    """In any length of its normal, either way round."""
    vertices, triangles = creature(3)
    vertices, plane = place(how, vertices)
    for factor in (1.0, -250.0):
        given = [factor * number for number in plane]
        check_symmetric(
            core.suggest_cones(vertices, triangles, ["442", "2222", "432"], symmetry=given), vertices, plane
        )


def test_the_given_one_of_three_planes_is_kept_to():
    vertices, triangles = icosphere(3)
    vertices = vertices * [1, 1.3, 1.7]
    for axis in range(3):
        plane = [0.0, 0.0, 0.0, 0.0]
        plane[axis] = 1.0
        check_symmetric(
            core.suggest_cones(vertices, triangles, ["442", "432", "2222"], symmetry=plane), vertices, plane
        )


def test_symmetric_cones_cost_little_here():
    """Symmetry narrows the choice: no better than the best, and on this mesh hardly worse."""
    mesh = creature(4)
    for signature in ("442", "432", "237", "2222"):
        (with_it,) = core.suggest_cones(*mesh, [signature])
        (without,) = core.suggest_cones(*mesh, [signature], symmetry="ignore")
        assert without.predicted <= 1.01 * with_it.predicted, signature
        assert with_it.predicted <= 1.5 * without.predicted, signature


@pytest.mark.parametrize("amount", [1e-9, 0.003])
def test_a_nearly_symmetric_mesh(amount):
    """By a plane that is given: as near as the vertices allow. Symmetry ignored: no claim of any."""
    vertices, triangles = creature(3)
    vertices = vertices + amount * np.random.default_rng(0).normal(size=vertices.shape)
    for made in core.suggest_cones(vertices, triangles, ["442", "432"], symmetry="ignore"):
        assert not made.symmetric
    suggestions = core.suggest_cones(vertices, triangles, ["442", "432"], symmetry=PLANE)
    image = mirror_images(creature(3)[0], PLANE)
    for made in suggestions:
        reflected = {(int(image[v]), n) for v, n in zip(made.cones, made.orders)}
        gaps = [min(np.linalg.norm(vertices[v] - vertices[w]) for w, n in zip(made.cones, made.orders) if n == order)
                for v, order in reflected]  # fmt: skip
        assert max(gaps) < 0.15, made


def test_a_lopsided_mesh_has_no_plane():
    vertices, triangles = shapes.roughened(creature(3, 0.4), 1)
    assert not any(made.symmetric for made in core.suggest_cones(vertices, triangles, ["442", "432", "2222"]))


@pytest.mark.parametrize("signature", ["*442", "*333", "*2222", "4*2", "22*", "2*22"])
def test_symmetric_disks(signature):
    """A creature without its lower side: corners on its rim."""
    vertices, triangles = parted(*creature(4), lambda middle: middle[:, 2] > -0.1)
    rim = boundary_loops(triangles)[0]
    assert np.count_nonzero(vertices[rim, 0] == 0) == 2  # where a corner that has no partner can be
    for how in ("at the origin", "turned"):
        placed, plane = place(how, vertices)
        check_symmetric(core.suggest_cones(placed, triangles, [signature]), placed, plane)


def test_symmetry_survives_a_fixed_cone_on_the_plane_and_gives_way_to_one_beside_it():
    vertices, triangles = creature(3)
    image = mirror_images(vertices, PLANE)
    on_plane = int(np.flatnonzero(image == np.arange(len(vertices)))[7])
    check_symmetric(core.suggest_cones(vertices, triangles, ["442", "432"], [on_plane]), vertices, PLANE)
    beside = int(np.argmax(vertices[:, 0]))
    for made in core.suggest_cones(vertices, triangles, ["442", "432", "2222"], [beside]):
        assert beside in made.cones
        assert made.symmetric == is_its_own_image(made, image)
        if made.signature == "432":
            assert not made.symmetric  # no other cone has the order of the one that is fixed
    (pair,) = core.suggest_cones(vertices, triangles, ["442"], [beside, int(image[beside])])
    assert {beside, int(image[beside])} <= set(pair.cones) and pair.symmetric == is_its_own_image(pair, image)


@pytest.mark.parametrize("make", [cube, octahedron, lambda: subdivided(*subdivided(*cube())), lambda: icosphere(2)],
                         ids=["cube", "octahedron", "fine cube", "icosphere"])  # fmt: skip
def test_meshes_with_many_planes(make):
    """Whichever is taken, the claim is true for one of the coordinate planes or of the diagonal ones."""
    mesh = make()
    middle = (mesh[0].min(0) + mesh[0].max(0)) / 2
    normals = [np.eye(3)[i] for i in range(3)]
    normals += [np.eye(3)[i] + sign * np.eye(3)[j] for i in range(3) for j in range(i) for sign in (1, -1)]
    images = [mirror_images(mesh[0], (*n, n @ middle)) for n in normals]
    for made in core.suggest_cones(*mesh, ["442", "432", "222"]):
        if made.symmetric and make in (cube, octahedron):
            assert any((i >= 0).all() and is_its_own_image(made, i) for i in images), made


def test_a_plane_that_mirrors_nothing_is_no_crash():
    vertices, triangles = creature(3)
    for plane in ((0, 0, 1, 0), (1, 0, 0, 100.0), (0.3, -2, 0.5, 0.1), (1e-200, 0, 0, 0), (1e200, 0, 0, 0)):
        try:
            suggestions = core.suggest_cones(vertices, triangles, ["442", "432"], symmetry=plane)
        except core.OrbifoldError as error:  # a square that under- or overflows
            assert error.status == "ORB_BAD_ARGUMENT" and abs(np.log10(np.abs(plane[0]))) == 200
            continue
        for made in suggestions:
            assert len(set(made.cones)) == 3
            core.embed(vertices, triangles, made.signature, made.cones)


@pytest.mark.parametrize("name", ["spot.obj"])
def test_the_shared_cow_is_symmetric(name):
    vertices, triangles = core.read_mesh(shared_file("meshes", name))
    check_symmetric(core.suggest_cones(vertices, triangles, ["442", "2222", "432", "237"]), vertices, PLANE)


# ------------------------------------------------------------------------------------------------- fixed cones


@pytest.mark.parametrize("count", [0, 1, 2, 3])
def test_fixed_cones_are_in_every_suggestion(count):
    mesh = creature(3, 0.1)
    fixed = [5, 400, 77][:count]
    suggestions = core.suggest_cones(*mesh, None, fixed)
    lengths = {len(made.cones) for made in suggestions}
    assert lengths >= ({2, 3, 4} if count < 3 else {3, 4}) and min(lengths) >= count
    for made in suggestions:
        assert set(fixed) <= set(made.cones), made
        assert list(made.orders) == features(made.signature).orders and len(set(made.cones)) == len(made.cones)


def test_more_fixed_cones_cost_more():
    """Each takes a choice away: compared where both searches see the same vertices."""
    mesh = creature(3, 0.1)
    spread = []
    for count in range(4):
        (made,) = core.suggest_cones(*mesh, ["432"], [5, 400, 77][:count])
        spread.append(made.predicted)
    assert all(a <= 1.02 * b for a, b in zip(spread, spread[1:]))


def test_all_cones_fixed_leaves_the_best_sequence():
    mesh = creature(3, 0.1)
    fixed = [5, 400, 77]
    (made,) = core.suggest_cones(*mesh, ["432"], fixed)
    assert sorted(made.cones) == sorted(fixed)
    for orders in ((4, 3, 2), (4, 2, 3), (3, 4, 2), (3, 2, 4), (2, 3, 4), (2, 4, 3)):
        assert made.predicted <= 1.01 * core.predict(*mesh, "432", fixed, orders=orders).spread
    (best,) = core.suggest_cones(*mesh, ["432"])
    (again,) = core.suggest_cones(*mesh, ["432"], best.cones)
    assert set(again.cones) == set(best.cones) and again.predicted == pytest.approx(best.predicted, rel=1e-3)


def test_signatures_with_fewer_cones_than_are_fixed():
    mesh = creature(3, 0.1)
    fixed = [5, 400, 77, 300]
    assert {s.signature for s in core.suggest_cones(*mesh, ["442", "2222", "432"], fixed)} == {"2222"}
    for signatures in (["442", "432"], ["33"]):
        with pytest.raises(core.OrbifoldError) as caught:
            core.suggest_cones(*mesh, signatures, fixed)
        assert caught.value.status == "ORB_CONE_COUNT"
    many = list(range(12))
    try:
        assert all(set(many) <= set(s.cones) for s in core.suggest_cones(*mesh, None, many))
    except core.OrbifoldError as error:
        assert error.status == "ORB_CONE_COUNT"


def test_fixed_cones_of_disks_are_corners_on_the_boundary():
    vertices, triangles = shapes.roughened(shapes.disk(9), 1)
    (loop,) = boundary_loops(triangles)
    inside = [v for v in range(len(vertices)) if v not in loop][40]
    for made in core.suggest_cones(vertices, triangles, ["*442", "*2222", "4*2", "3*3", "2*22"], [loop[3]]):
        assert loop[3] in made.cones[len(features(made.signature).cones) :], made
    for made in core.suggest_cones(vertices, triangles, ["4*2", "3*3", "2*22", "22*"], [inside]):
        assert inside in made.cones[: len(features(made.signature).cones)], made
    both = core.suggest_cones(vertices, triangles, ["4*2", "2*22"], [inside, loop[3]])
    assert len(both) == 2 and all({inside, loop[3]} <= set(made.cones) for made in both)
    with pytest.raises(core.OrbifoldError) as caught:
        core.suggest_cones(vertices, triangles, ["*442"], [inside])
    assert caught.value.status in ("ORB_BAD_CONE", "ORB_CONE_COUNT")
    with pytest.raises(core.OrbifoldError) as caught:
        core.suggest_cones(vertices, triangles, ["22*"], [loop[0]])
    assert caught.value.status in ("ORB_BAD_CONE", "ORB_CONE_COUNT")


@pytest.mark.parametrize(
    "fixed, named", [([3, 3], [3]), ([0, 10**6], [10**6]), ([-1], [-1]), ([0, 2**40], [2**40]), ([162], [162])]
)
def test_bad_fixed_cones_are_named(fixed, named):
    vertices, triangles = icosphere(2)
    vertices = np.vstack([vertices, [[5.0, 5, 5]]])  # vertex 162 is isolated
    for signatures in (None, ["442"], ["442", "33"]):
        with pytest.raises(core.OrbifoldError) as caught:
            core.suggest_cones(vertices, triangles, signatures, fixed)
        error = caught.value
        assert (error.status, error.element, error.elements) == ("ORB_BAD_CONE", "vertex", named)


# ------------------------------------------------------------------------------------------------- keep away


def test_infinite_weights_are_never_chosen():
    vertices, triangles = creature(3)
    for allowed in (vertices[:, 1] < -0.2, vertices[:, 2] > 0.3, np.abs(vertices[:, 0]) > 0.1):
        away = np.where(allowed, 0.0, np.inf)
        for made in core.suggest_cones(vertices, triangles, None, (), away):
            assert allowed[list(made.cones)].all(), made
    vertices, triangles = shapes.roughened(shapes.disk(9), 1)
    allowed = vertices[:, 0] > 0
    for made in core.suggest_cones(vertices, triangles, None, (), np.where(allowed, 0.0, np.inf)):
        assert allowed[list(made.cones)].all(), made


def test_infinite_weights_all_over_but_for_a_few():
    vertices, triangles = creature(2)
    away = np.full(len(vertices), np.inf)
    few = [3, 50, 100, 140]
    away[few] = 0
    for made in core.suggest_cones(vertices, triangles, ["442", "2222", "33"], (), away):
        assert set(made.cones) <= set(few), made
    away[few[:2]] = np.inf
    assert {s.signature for s in core.suggest_cones(vertices, triangles, ["442", "33"], (), away)} == {"33"}
    with pytest.raises(core.OrbifoldError) as caught:
        core.suggest_cones(vertices, triangles, ["442"], (), away)
    assert caught.value.status in ("ORB_CONE_COUNT", "ORB_BAD_WEIGHT", "ORB_BAD_CONE")
    with pytest.raises(core.OrbifoldError):
        core.suggest_cones(vertices, triangles, None, (), np.full(len(vertices), np.inf))


@pytest.mark.parametrize("signature", ["442", "432", "2222", "237"])
def test_a_heavier_weight_never_raises_what_the_cones_pay(signature):
    """The best for spread + weight * p pays the less p the heavier the weight: on a mesh of 162 vertices."""
    vertices, triangles = shapes.roughened(creature(2, 0.2), 1)
    p = np.clip(vertices[:, 1] + 1, 0, None)
    paid, spread = [], []
    for weight in (0, 0.03, 0.1, 0.3, 1, 3, 10, 100, 1e6):
        (made,) = core.suggest_cones(vertices, triangles, [signature], (), weight * p, symmetry="ignore")
        paid.append(p[list(made.cones)].sum())
        spread.append(made.predicted)
        said = core.predict(vertices, triangles, signature, made.cones).spread
        assert made.predicted == pytest.approx(said, rel=1e-4)  # without what the weights cost
    assert all(a >= b - 1e-9 for a, b in zip(paid, paid[1:])), paid
    assert all(a <= 1.02 * b for a, b in zip(spread, spread[1:])), spread
    assert paid[0] > 0 and paid[-1] == pytest.approx(np.sort(p)[: len(made.cones)].sum(), abs=1e-3)


def test_a_weight_acts_as_squared_log_area():
    """It moves a cone exactly when the place without it costs less: two of the three are fixed."""
    vertices, triangles = shapes.roughened(creature(2, 0.2), 1)
    fixed = far_apart(vertices, triangles, 2).tolist()

    def ask(weights):
        (made,) = core.suggest_cones(vertices, triangles, ["442"], fixed, weights, symmetry="ignore")
        return made, next(v for v in made.cones if v not in fixed)

    first, there = ask(None)
    never = np.zeros(len(vertices))
    never[there] = np.inf
    second, elsewhere = ask(never)
    assert elsewhere != there
    price = second.predicted**2 - first.predicted**2
    assert price > 0
    for factor, chosen in ((0.5, there), (2.0, elsewhere)):
        weights = np.zeros(len(vertices))
        weights[there] = factor * price
        assert ask(weights)[1] == chosen, factor


def test_zero_weights_are_no_weights():
    mesh = creature(3, 0.1)
    assert core.suggest_cones(*mesh, ["442", "2222"]) == core.suggest_cones(
        *mesh, ["442", "2222"], (), np.zeros(len(mesh[0]))
    )


def test_bad_weights_are_named():
    mesh = icosphere(2)
    for bad, status in ((-1e-9, "ORB_BAD_WEIGHT"), (np.nan, "ORB_BAD_WEIGHT"), (-np.inf, "ORB_BAD_WEIGHT")):
        away = np.zeros(len(mesh[0]))
        away[[7, 30]] = bad
        with pytest.raises(core.OrbifoldError) as caught:
            core.suggest_cones(*mesh, None, (), away)
        assert (caught.value.status, caught.value.element, caught.value.elements) == (status, "vertex", [7, 30])
    for shape in (3, len(mesh[0]) - 1, (len(mesh[0]), 1)):
        with pytest.raises(core.OrbifoldError) as caught:
            core.suggest_cones(*mesh, None, (), np.zeros(shape))
        assert caught.value.status in ("ORB_BAD_ARGUMENT", "ORB_BAD_WEIGHT")


def test_a_fixed_cone_where_none_may_be():
    """The person's own pick counts, or is refused by name."""
    mesh = creature(2, 0.1)
    away = np.zeros(len(mesh[0]))
    away[20] = np.inf
    try:
        (made,) = core.suggest_cones(*mesh, ["442"], [20], away)
        assert 20 in made.cones and np.isfinite(made.predicted)
    except core.OrbifoldError as error:
        assert (error.status, error.elements) == ("ORB_BAD_CONE", [20])


def test_weights_of_isolated_vertices_do_not_matter():
    vertices, triangles = creature(2, 0.1)
    more = np.vstack([vertices, [[9.0, 9, 9]]])
    away = np.zeros(len(more))
    away[-1] = 5
    (one,) = core.suggest_cones(more, triangles, ["442"], (), away)
    (other,) = core.suggest_cones(vertices, triangles, ["442"])
    assert one.cones == other.cones
