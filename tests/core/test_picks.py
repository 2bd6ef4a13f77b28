# SPDX-License-Identifier: GPL-3.0-or-later
"""Mirror corners may be picked from any starting point and in either direction; what cannot be meant is refused, and
the elements are named."""

import numpy as np
import pytest
import shapes
from conway import features
from families import mesh_named
from picks import along, boundary_loops, inside, picks_for

import core

DISK = shapes.roughened(shapes.disk())
RIM = boundary_loops(DISK[1])[0]
ANNULUS = shapes.roughened(shapes.annulus())


def energy(mesh, signature, cones, **options):
    return core.embed(*mesh, signature, cones, weights="cotan", **options).report["solver"]["energy"]


def signature_of(cones, corners):
    return "".join(map(str, cones)) + "*" + "".join(map(str, corners))


DISKS = ["*442", "*632", "*532", "*225", "*237", "*2345", "*2222", "2*22", "3*234", "34*56"]


@pytest.mark.parametrize("signature", DISKS)
def test_corners_from_any_start_in_either_direction(signature):
    wanted = features(signature)
    cones, (orders,) = inside(*DISK, len(wanted.cones)), wanted.mirrors
    corners = along(DISK[0], RIM, len(orders))
    plain = energy(DISK, signature, cones + corners)
    for step in (1, -1):
        for start in range(len(orders)):
            turn = [(start + step * i) % len(orders) for i in range(len(orders))]
            picked = cones + [corners[i] for i in turn]
            turned = [orders[i] for i in turn]
            same = energy(DISK, signature_of(wanted.cones, turned), picked)
            assert same == pytest.approx(plain, rel=1e-9), turned
            given = energy(DISK, signature, picked, orders=[*wanted.cones, *turned])
            assert given == pytest.approx(plain, rel=1e-9), turned


def test_interior_cones_in_any_sequence():
    picked = picks_for(*DISK, features("23*45"))
    plain = energy(DISK, "23*45", picked)
    assert energy(DISK, "32*45", [picked[1], picked[0], *picked[2:]]) == pytest.approx(plain, rel=1e-9)


def test_mirrors_in_any_sequence():
    """Which loop is which mirror follows from the corners picked on it."""
    outer, inner = (along(ANNULUS[0], loop, 3) for loop in boundary_loops(ANNULUS[1]))
    plain = energy(ANNULUS, "*234*56", [*outer, *inner[:2]])
    assert energy(ANNULUS, "*56*234", [*inner[:2], *outer]) == pytest.approx(plain, rel=1e-9)
    assert energy(ANNULUS, "*65*342", [*inner[1::-1], *outer[1:], outer[0]]) == pytest.approx(plain, rel=1e-9)
    bare = energy(ANNULUS, "**23", outer[:2])
    assert energy(ANNULUS, "*23*", outer[:2]) == pytest.approx(bare, rel=1e-9)
    assert energy(ANNULUS, "**23", inner[:2]) != pytest.approx(bare, rel=1e-3)


def test_a_moebius_band_has_no_direction():
    mesh = shapes.roughened(shapes.moebius_band())
    corners = along(mesh[0], boundary_loops(mesh[1])[0], 3)
    plain = energy(mesh, "*234x", corners)
    assert energy(mesh, "*432x", corners[::-1]) == pytest.approx(plain, rel=1e-9)


def test_triangles_may_run_the_other_way():
    """A mirrored orbifold is as good: the mesh turned inside out has the same energy."""
    for signature in ("*237", "3*22", "2*3"):
        picked = picks_for(*DISK, features(signature))
        inside_out = DISK[0], DISK[1][:, ::-1]
        assert energy(inside_out, signature, picked) == pytest.approx(energy(DISK, signature, picked), rel=1e-9)


# ------------------------------------------------------------------------------------------------- refusals


def failure(mesh, signature, cones, **options):
    with pytest.raises(core.OrbifoldError) as caught:
        core.embed(*mesh, signature, cones, **options)
    message = str(caught.value)
    assert len(message) > 10 and "\n" not in message
    return caught.value


def test_corners_in_the_wrong_cyclic_sequence():
    a, b, c, d = along(DISK[0], RIM, 4)
    error = failure(DISK, "*2345", [a, c, b, d])
    assert error.status == "ORB_BAD_ORDER" and error.element == "vertex"
    assert error.elements and set(error.elements) <= {a, b, c, d}


def test_corners_of_one_mirror_on_two_loops():
    outer, inner = (along(ANNULUS[0], loop, 3) for loop in boundary_loops(ANNULUS[1]))
    for signature, picked in [
        ("*234*56", [outer[0], inner[0], outer[1], inner[1], outer[2]]),
        ("*23*45", [*outer, inner[0]]),
        ("*2*33", outer),
    ]:
        error = failure(ANNULUS, signature, picked)
        assert error.status == "ORB_BAD_ORDER" and error.element == "vertex"
        assert error.elements and set(error.elements) <= {*outer, *inner}


@pytest.mark.parametrize("signature", ["*442", "3*22", "*2222"])
def test_corner_inside(signature):
    picked = picks_for(*DISK, features(signature))
    stray = inside(*DISK, 2)[1]
    error = failure(DISK, signature, [*picked[:-1], stray])  # the last of the picks that are inside
    assert (error.status, error.element, error.elements) == ("ORB_BAD_CONE", "vertex", [stray])


@pytest.mark.parametrize("signature", ["3*3", "2*22", "22*", "5*", "23*2"])
def test_cone_on_the_boundary(signature):
    picked = picks_for(*DISK, features(signature))
    stray = next(v for v in RIM if v not in picked)
    error = failure(DISK, signature, [stray, *picked[1:]])
    assert (error.status, error.element, error.elements) == ("ORB_BAD_CONE", "vertex", [stray])


def border_of(mesh):
    sides = [list(zip(loop, loop[1:] + loop[:1])) for loop in boundary_loops(mesh[1])]
    return {tuple(sorted(side)) for loop in sides for side in loop}


@pytest.mark.parametrize(
    "signature, topology, mesh",
    [
        *[("442", (0, 0, 1), "disk"), ("*442", (0, 0, 2), "annulus"), ("**", (0, 0, 1), "disk")],
        *[("**", (0, 0, 3), "halftunnel.off"), ("o", (1, 0, 1), "torus"), ("xx", (0, 1, 1), "moebius")],
        *[("22x", (0, 1, 1), "crosscap"), ("***", (0, 0, 2), "cylinder"), ("*442", (0, 0, 0), "ellipsoid")],
        *[("oo", (2, 0, 1), "block"), ("*x", (0, 1, 2), "moebius")],
    ],
)
def test_wrong_number_of_boundaries(signature, topology, mesh):
    mesh = mesh_named(topology, mesh)
    wanted = features(signature)
    loops = boundary_loops(mesh[1])
    corners = along(mesh[0], loops[0], 3) if loops else [0, 1, 2]
    picked = inside(*mesh, len(wanted.cones)) + corners[: len(wanted.orders) - len(wanted.cones)]
    error = failure(mesh, signature, picked)
    assert error.status == "ORB_BOUNDARY"
    if len(loops) > len(wanted.mirrors):
        assert error.element == "edge" and {tuple(sorted(edge)) for edge in error.elements} <= border_of(mesh)
        assert error.elements and error.found <= len(border_of(mesh))


@pytest.mark.parametrize(
    "signature, topology, mesh",
    [
        *[("442", (1, 0, 0), "torus"), ("o", (0, 0, 0), "ellipsoid"), ("o", (2, 0, 0), "block")],
        *[("o", (0, 2, 0), "bottle"), ("xx", (1, 0, 0), "torus"), ("**", (0, 2, 1), "bottle")],
        *[("*442", (0, 1, 1), "moebius"), ("*x", (0, 0, 1), "disk"), ("22x", (0, 0, 0), "ellipsoid")],
        *[("oo", (3, 0, 0), "block"), ("xxx", (0, 2, 0), "bottle"), ("*xx", (1, 0, 1), "torus")],
        ("2222", (0, 1, 0), "boy"),
    ],
)
def test_wrong_genus(signature, topology, mesh):
    mesh = mesh_named(topology, mesh)
    wanted = features(signature)
    loops = boundary_loops(mesh[1])
    corners = along(mesh[0], loops[0], 3) if loops else []
    picked = inside(*mesh, len(wanted.cones)) + corners[: len(wanted.orders) - len(wanted.cones)]
    assert failure(mesh, signature, picked).status in ("ORB_WRONG_GENUS", "ORB_BOUNDARY")
    if len(loops) == len(wanted.mirrors):
        assert failure(mesh, signature, picked).status == "ORB_WRONG_GENUS"


@pytest.mark.parametrize("signature", ["*23", "*45", "*3", "*(12)7", "23", "5"])
def test_orbifolds_that_no_surface_covers(signature):
    error = failure(DISK, signature, RIM[: len(features(signature).orders)])
    assert error.status == "ORB_BAD_ORBIFOLD"


@pytest.mark.parametrize("signature", ["*", "x"])
def test_the_sphere_by_one_reflection_or_by_antipodes(signature):
    """Good orbifolds, but every Moebius map of the sphere that keeps the group moves them freely."""
    assert failure(DISK, signature, []).status == "ORB_UNSUPPORTED_SIGNATURE"


@pytest.mark.parametrize("signature", ["1", "*1", "11", "3*1", "*221", "1x", "0*"])
def test_orders_below_two(signature):
    error = failure(DISK, signature, RIM[: len(features(signature).orders)])
    assert error.status == "ORB_BAD_ORDER" and error.element == "character"
    assert signature[error.elements[0]] in "10"


SCRAMBLED = [("2x2", 2), ("*x3", 2), ("xo", None), ("4*2o", None), ("x*", 1), ("o3x2", 3)]


@pytest.mark.parametrize("signature, position", SCRAMBLED)
def test_signatures_out_of_sequence(signature, position):
    """Handles come first, then cones, mirrors with their corners, and cross-caps: what is read otherwise is refused or
    means the same; the position is named."""
    try:
        read = core.parse_signature(signature)
        assert sorted(read.orders) == sorted(features(signature).orders)
    except core.OrbifoldError as error:
        assert error.status == "ORB_BAD_SIGNATURE" and error.element == "character"
        assert position is None or error.elements == [position]


def test_counts_and_repetitions():
    corners = along(DISK[0], RIM, 4)
    assert failure(DISK, "*442", corners).status == "ORB_CONE_COUNT"
    assert failure(DISK, "*442", corners[:2]).status == "ORB_CONE_COUNT"
    assert failure(DISK, "**", [], holes="refuse").status == "ORB_BOUNDARY"
    error = failure(DISK, "*442", [corners[0], corners[1], corners[0]])
    assert (error.status, error.element, error.elements) == ("ORB_BAD_CONE", "vertex", [corners[0]])


# ------------------------------------------------------------------------------------------------- holes


@pytest.mark.parametrize("signature", ["442", "432", "237"])
def test_holes_are_filled_for_the_computation(signature):
    mesh = mesh_named((0, 0, 3), "halftunnel.off")
    result = core.embed(*mesh, signature, inside(*mesh, 3), holes="fill")
    assert result.report["mesh"]["boundary_loops"] == 3 and result.filled_holes == 3
    assert result.uv.shape == (len(mesh[1]), 3, 2) and np.isfinite(result.uv).all()
    assert (result.refined_from >= -1).all() and (result.refined_from == -1).any()
    assert set(result.refined_from[result.refined_from >= 0]) == set(range(len(mesh[1])))


def test_the_mirror_stays_open_when_holes_are_filled():
    mesh = mesh_named((0, 0, 3), "halftunnel.off")
    corners = along(mesh[0], boundary_loops(mesh[1])[0], 3)
    result = core.embed(*mesh, "*442", corners, holes="fill")
    assert result.signature == "*442" and result.filled_holes == 2


def test_holes_become_mirrors():
    mesh = mesh_named((0, 0, 3), "halftunnel.off")
    corners = along(mesh[0], boundary_loops(mesh[1])[0], 3)
    result = core.embed(*mesh, "*442", corners, holes="mirror")
    assert features(result.signature).topology == (0, 0, 3)
    assert sorted(features(result.signature).mirrors) == [(), (), (4, 4, 2)]
