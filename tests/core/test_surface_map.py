# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps from mesh to mesh: identities and inverses on every family, pairs with known answers, refusals that help."""

import numpy as np
import picks
import pytest
import shapes
from families import EUCLIDEAN, HYPERBOLIC, SPHERICAL, cases, mesh_named
from conway import features
from mapping import corresponding, embedded, there_and_back
from meshes import far_apart, icosphere, shared_file, subdivided
from surfaces import picks_for

import core

MIDDLE = np.full((1, 3), 1 / 3)
# Surfaces without handles and cross-caps, and tori, are cut alike on every mesh.
ALIKE = [name for name in [*SPHERICAL, *EUCLIDEAN, *HYPERBOLIC] if features(name).topology[:2] == (0, 0)]
ALIKE.append("o")


@pytest.mark.parametrize("signature, name", cases([*SPHERICAL, *EUCLIDEAN, *HYPERBOLIC]))
def test_a_mesh_onto_itself_is_the_identity(signature, name):
    mesh = mesh_named(features(signature).topology, name)
    result = embedded(mesh, signature, picks_for(mesh, signature))
    itself = core.SurfaceMap(result, result)
    size = np.ptp(mesh[0])
    assert np.abs(itself.points() - mesh[0])[np.unique(mesh[1])].max() < 1e-12 * size
    middles = np.arange(len(mesh[1]))
    triangles, barycentric = itself.evaluate(middles, MIDDLE.repeat(len(middles), 0))
    assert (triangles == middles).all() and np.abs(barycentric - MIDDLE).max() < 1e-9
    distortion = itself.distortion
    assert distortion.flipped == 0 and distortion.quasi_conformal_max < 1 + 1e-6 and distortion.log_area_std < 1e-6
    assert itself.landmark_residual == 0


@pytest.mark.parametrize("signature", ALIKE)
def test_maps_between_two_surfaces_are_inverse(signature):
    topology = features(signature).topology
    (_, name), (_, other) = cases([signature])
    mesh, second = mesh_named(topology, name), mesh_named(topology, other)
    picked = picks_for(mesh, signature)
    wanted = picks.picks_for(*second, features(signature), start=0.6)  # the boundary's first vertex is elsewhere
    a, b = embedded(mesh, signature, picked), embedded(second, signature, wanted)
    assert there_and_back(a, b) < 1e-9 and there_and_back(b, a) < 1e-9
    a_to_b = core.SurfaceMap(a, b)
    triangles, barycentric = core.surface_map(a, b)
    assert triangles.dtype == np.int32 and triangles.shape == (len(mesh[0]),)
    assert barycentric.shape == (len(mesh[0]), 3)
    assert (barycentric >= 0).all() and np.abs(barycentric.sum(1) - 1).max() < 1e-14
    assert np.array_equal(a_to_b.points()[picked], second[0][wanted])  # to the last digit
    assert a_to_b.distortion.flipped == 0


@pytest.mark.parametrize("signature", ["442", "432", "237", "2222", "222222"])
def test_nearly_the_same_surface_is_mapped_nearly_isometrically(signature):
    mesh = mesh_named((0, 0, 0), "ellipsoid")
    random = np.random.default_rng(3)
    shuffled = random.permutation(len(mesh[0]))
    fine, triangles = subdivided(*shapes.roughened(mesh, seed=77, amount=0.1))
    number = np.concatenate([shuffled, np.arange(len(mesh[0]), len(fine))])  # of each vertex in the new sequence
    other = np.empty_like(fine)
    other[number] = fine
    picked = np.array(picks_for(mesh, signature))
    a = embedded(mesh, signature, picked, weights="conformal")
    b = embedded((other, number[triangles]), signature, number[picked], weights="conformal")
    a_to_b = core.SurfaceMap(a, b)
    assert 1 <= a_to_b.distortion.quasi_conformal_mean < 1.12
    assert abs(a_to_b.distortion.log_area_mean) < 0.05 and a_to_b.distortion.log_area_std < 0.25
    moved = np.linalg.norm(a_to_b.points() - mesh[0], axis=1)
    assert moved.max() < 0.15 and moved.mean() < 0.05  # edges are 0.15 long


@pytest.mark.parametrize("signature", ["442", "632", "432", "237"])
def test_mirror_image_remeshed_has_a_nearly_conformal_map(signature):
    """It is no isometry, as that turns orientation over; with three landmarks there is a conformal map all the same."""
    vertices, triangles = mesh_named((0, 0, 0), "ellipsoid")
    picked = picks_for((vertices, triangles), signature)
    a = embedded((vertices, triangles), signature, picked, weights="conformal")
    mirrored = subdivided(vertices * [-1, 1, 1], triangles[:, ::-1])  # the same surface by other triangles
    b = embedded(mirrored, signature, picked, weights="conformal")
    assert there_and_back(a, b) < 1e-9
    assert 1 <= core.SurfaceMap(a, b).distortion.quasi_conformal_mean < 1.12


@pytest.mark.parametrize("weights", ["cotan", "uniform"])
def test_random_landmarks(weights):
    """Any number in the walk of the first mesh, on meshes that have nothing else in common."""
    random = np.random.default_rng(2016)
    meshes = [mesh_named((0, 0, 0), "ellipsoid"), icosphere(3), shapes.roughened(icosphere(2), amount=0.3)]
    for count in (3, 4, 5, 6, 8, 12, 20, 50):
        mesh, other = (meshes[k] for k in random.choice(3, 2, replace=False))
        picked = random.choice(len(mesh[0]), count, replace=False)
        picked = picked[core.landmark_sequence(*mesh, picked)]
        signature = "442" if count == 3 else "2" * count
        a = embedded(mesh, signature, picked, weights=weights)
        b = embedded(other, signature, corresponding(mesh, other, picked), weights=weights)
        assert there_and_back(a, b) < 1e-8, count
        assert core.SurfaceMap(a, b).distortion.flipped == 0


def test_three_meshes_agree():
    sphere = [mesh_named((0, 0, 0), "ellipsoid"), icosphere(3), shapes.roughened(icosphere(4))]
    tori = [mesh_named((1, 0, 0), "torus"), mesh_named((1, 0, 0), "block"), shapes.torus(11, 17)]
    disks = [mesh_named((0, 0, 1), name) for name in ("disk", "plate", "cap")]
    for meshes, signatures in (
        (sphere, ["442", "432", "33", "2222", "22222", "2" * 12]),
        (tori, ["o"]),
        (disks, ["*442", "4*2", "22*", "23*4", "*22222"]),
    ):
        for signature in signatures:
            results = [embedded(mesh, signature, picks_for(mesh, signature)) for mesh in meshes]
            ab, bc, ac = (core.SurfaceMap(results[i], results[j]) for i, j in ((0, 1), (1, 2), (0, 2)))
            by_way_of_b = core.interpolated(results[2], meshes[2][0], *bc.evaluate(*ab.spots))
            assert np.abs(by_way_of_b - ac.points()).max() < 1e-9, signature


def test_attributes_are_transferred():
    mesh, other = icosphere(2), icosphere(3)
    picked = far_apart(*mesh, 3)
    a, b = embedded(mesh, "442", picked), embedded(other, "442", picked)
    a_to_b = core.SurfaceMap(a, b)
    points = a_to_b.points()
    assert np.allclose(a_to_b.transfer(other[0][:, 0]), points[:, 0])
    both = a_to_b.transfer(np.stack([other[0], 2 * other[0]], 1))
    assert both.shape == (len(mesh[0]), 2, 3) and np.allclose(both[:, 1], 2 * points)
    assert np.abs(np.linalg.norm(points, axis=1) - 1).max() < 0.02
    assert np.allclose(a_to_b.transfer(other[0][other[1]], corners=True), points)
    none = a_to_b.evaluate(np.zeros(0, int), np.zeros((0, 3)))
    assert none[0].shape == (0,) and none[1].shape == (0, 3)
    with pytest.raises(core.OrbifoldError, match="one row for each of"):
        a_to_b.transfer(mesh[0])
    with pytest.raises(core.OrbifoldError, match="rows of barycentric"):
        a_to_b.evaluate([0, 1], MIDDLE)
    with pytest.raises(core.OrbifoldError, match="add up to 1"):
        a_to_b.evaluate([0], 2 * MIDDLE)
    with pytest.raises(core.OrbifoldError, match="does not have"):
        a_to_b.evaluate([len(mesh[1])], MIDDLE)


def test_holes_and_loose_vertices_have_no_image():
    mesh, open_mesh = icosphere(2), (icosphere(2)[0], icosphere(2)[1][1:])
    picked = [v for v in far_apart(*mesh, 5) if v not in mesh[1][0]][:3]
    loose = (np.concatenate([mesh[0], [[0, 0, 0]]]), mesh[1])
    a, b = embedded(loose, "442", picked), embedded(open_mesh, "442", picked, holes="fill")
    a_to_b = core.SurfaceMap(a, b)
    nowhere = np.isnan(a_to_b.points()).all(1)
    assert a_to_b.spots[0][-1] == -1 and nowhere[-1] and nowhere.sum() < 5
    triangles, barycentric = a_to_b.evaluate([0, 5], MIDDLE.repeat(2, 0))
    assert triangles[0] == -1 and (barycentric[0] == 0).all() and triangles[1] >= 0
    assert core.SurfaceMap(b, a).evaluate(triangles, barycentric)[0][0] == -1
    assert a_to_b.distortion.left_out == 1 and a_to_b.distortion.quasi_conformal[0] == 0


def test_a_short_walk_is_found():
    mesh = icosphere(3)
    circle = np.flatnonzero(np.abs(mesh[0][:, 2]) < 0.05)
    circle = circle[np.argsort(np.arctan2(mesh[0][circle, 1], mesh[0][circle, 0]))][:12]
    shuffled = np.random.default_rng(0).permutation(circle)
    sequence = core.landmark_sequence(*mesh, shuffled)
    walk = shuffled[sequence].tolist()
    assert sorted(sequence) == list(range(12)) and walk in (circle.tolist(), circle[::-1].tolist())
    kept = core.landmark_sequence(*mesh, shuffled, [2] * 6 + [3] * 6)
    assert set(kept[:6]) == set(range(6))
    with pytest.raises(core.OrbifoldError, match="more than once"):
        core.landmark_sequence(*mesh, [1, 1])


def test_refusals_say_what_to_do():
    mesh = icosphere(3)
    picked = far_apart(*mesh, 5)
    erratic = picks.inside(*mesh, 14)
    random = np.random.default_rng(1).permutation(erratic)

    def refusal(a, b):
        with pytest.raises(core.OrbifoldError) as caught:
            core.surface_map(a, b)
        assert caught.value.status == "ORB_NO_CORRESPONDENCE"
        return caught.value

    a = embedded(mesh, "442", picked[:3])
    assert "one orbifold" in str(refusal(a, embedded(mesh, "333", picked[:3])))
    error = refusal(a, embedded(mesh, "442", picked[:3], orders=[4, 2, 4]))
    assert "order 4" in str(error) and error.element == "vertex" and error.elements == [picked[1]]
    graph = core.embed(*mesh, "2" * 14, random)
    path = embedded(mesh, "2" * 14, erratic)
    assert "the cut 'path'" in str(refusal(graph, path))
    disk = mesh_named((0, 0, 1), "disk")
    corners = picks_for(disk, "*2222")
    turned = embedded(disk, "*2222", corners[::-1])
    assert "counter-clockwise" in str(refusal(embedded(disk, "*2222", corners), turned))
    pair = [mesh_named((2, 0, 0), name) for name in ("block", "fine block")]
    assert "graphs that do not correspond" in str(refusal(*(core.embed(*mesh, "oo") for mesh in pair)))
    with pytest.raises(core.OrbifoldError, match="way to cut"):
        core.embed(*mesh, "442", picked[:3], cut="tree")


@pytest.mark.parametrize("count, signature, most", [(3, "442", 1.06), (4, "2222", 1.2), (7, "2222222", 1.3)])
def test_the_heads_of_2015(count, signature, most):
    mesh, other = (core.read_mesh(shared_file("meshes", name)) for name in ("head_max.off", "head_julius.off"))
    picked = far_apart(*mesh, count)
    picked = picked[core.landmark_sequence(*mesh, picked)]
    a = embedded(mesh, signature, picked, weights="conformal")
    b = embedded(other, signature, corresponding(mesh, other, picked), weights="conformal")
    assert there_and_back(a, b) < 1e-9
    a_to_b = core.SurfaceMap(a, b)
    assert a_to_b.steps < 4 * len(mesh[0]) and a_to_b.distortion.flipped == 0
    assert 1 < a_to_b.distortion.quasi_conformal_mean < most


def test_david_to_armadillo_with_twenty_landmarks():
    mesh, other = (core.read_mesh(shared_file("meshes", name)) for name in ("david.obj", "armadillo.obj"))
    picked = far_apart(*mesh, 20)
    picked = picked[core.landmark_sequence(*mesh, picked)]
    wanted = corresponding(mesh, other, picked)
    a, b = embedded(mesh, "2" * 20, picked), embedded(other, "2" * 20, wanted)
    assert there_and_back(a, b) < 1e-9 and core.SurfaceMap(a, b).distortion.flipped == 0
    assert np.array_equal(core.SurfaceMap(a, b).points()[picked], other[0][wanted])
