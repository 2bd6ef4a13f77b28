# SPDX-License-Identifier: GPL-3.0-or-later
"""Courses of edges over another mesh (orb_surface_map_trace): where `evaluate` has their points, without gaps."""

import numpy as np
import picks
import pytest
import shapes
from conway import features
from families import EUCLIDEAN, HYPERBOLIC, SPHERICAL, cases, mesh_named
from meshes import far_apart, icosphere, subdivided
from surfaces import picks_for
from test_surface_map import ALIKE, corresponding, embedded

import core


def once(triangles):
    """(k,) of each edge a corner that it begins with."""
    ends = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], 2).reshape(-1, 2), axis=1)
    return np.unique(ends, axis=0, return_index=True)[1]


def traced(a_to_b):
    """The courses of all edges, which are checked: in turn, and without gaps."""
    corners = once(given(a_to_b.source))
    trace = a_to_b.trace(corners)
    ends = points_of(a_to_b.target, trace.triangles[:, None].repeat(2, 1), trace.barycentric)
    first = np.flatnonzero(np.diff(trace.edges, prepend=-1))
    last = np.append(first[1:], len(trace.edges)) - 1
    size = np.ptp(a_to_b.target.vertices)
    assert np.array_equal(trace.edges[first], np.arange(len(corners)))
    assert (trace.at[first, 0] == 0).all() and (trace.at[last, 1] == 1).all()
    assert (trace.at[:, 1] >= trace.at[:, 0]).all() and (trace.barycentric >= 0).all()
    within = np.setdiff1d(np.arange(1, len(trace.edges)), first)
    assert (trace.at[within, 0] == trace.at[within - 1, 1]).all()
    assert np.nanmax(np.abs(ends[within, 0] - ends[within - 1, 1]), initial=0.0) < 1e-12 * size
    return corners, trace


def given(result):
    return result.triangles.ravel()[result.input_corners]


def points_of(result, triangles, barycentric):
    at = result.vertices[given(result)[triangles]]
    return np.where((triangles >= 0)[..., None], np.einsum("...c,...cd->...d", barycentric, at), np.nan)


def agrees(a_to_b, most=1e-9):
    """Both ends and the middle of each stretch are where `evaluate` has them, and the middle in the same triangle."""
    corners, trace = traced(a_to_b)
    size = np.ptp(a_to_b.target.vertices)
    for where in (trace.at[:, 0], trace.at[:, 1]):
        weights = np.zeros((len(where), 3))
        rows, corner = np.arange(len(where)), corners[trace.edges]
        weights[rows, corner % 3], weights[rows, (corner + 1) % 3] = 1 - where, where
        found = points_of(a_to_b.target, *a_to_b.evaluate(corner // 3, weights))
        k = 0 if where is trace.at[:, 0] or (where == trace.at[:, 0]).all() else 1
        drawn = points_of(a_to_b.target, trace.triangles, trace.barycentric[:, k])
        both = np.isfinite(found).all(1) & np.isfinite(drawn).all(1)
        assert np.abs(found - drawn)[both].max(initial=0.0) < most * size
    middle = trace.at.mean(1)
    weights[rows, corner % 3], weights[rows, (corner + 1) % 3] = 1 - middle, middle
    at, where = a_to_b.evaluate(corner // 3, weights)
    long = np.ptp(trace.at, axis=1) > 1e-6
    beside = np.cross(*np.moveaxis(trace.barycentric, 1, 0))
    off = np.abs((beside * where).sum(1)) / np.maximum(np.linalg.norm(beside, axis=1), 1e-12)
    same = long & (at == trace.triangles) & (at >= 0)
    assert off[same].max(initial=0.0) < 1e-6 and same.sum() > 0.3 * long.sum()
    return trace


@pytest.mark.parametrize("signature, name", cases([*SPHERICAL, *EUCLIDEAN, *HYPERBOLIC]))
def test_a_mesh_onto_itself_has_its_own_edges(signature, name):
    mesh = mesh_named(features(signature).topology, name)
    result = embedded(mesh, signature, picks_for(mesh, signature))
    corners, trace = traced(core.SurfaceMap(result, result))
    ends = mesh[0][np.stack([mesh[1].ravel()[corners], np.roll(mesh[1], -1, 1).ravel()[corners]], 1)][trace.edges]
    on_it = ends[:, :1] + trace.at[:, :, None] * (ends[:, 1:] - ends[:, :1])
    drawn = points_of(result, trace.triangles[:, None].repeat(2, 1), trace.barycentric)
    assert np.abs(drawn - on_it).max() < 1e-12 * np.ptp(mesh[0])
    assert (trace.barycentric == 0).any(2).all(), "along sides"
    halved = len(result.vertices) > len(mesh[0])
    assert set(trace.at.ravel()) == ({0, 0.5, 1} if halved else {0, 1})


@pytest.mark.parametrize("signature", ALIKE)
def test_courses_are_where_points_of_the_edges_go(signature):
    topology = features(signature).topology
    (_, name), (_, other) = cases([signature])
    mesh, second = mesh_named(topology, name), mesh_named(topology, other)
    a = embedded(mesh, signature, picks_for(mesh, signature))
    b = embedded(second, signature, picks.picks_for(*second, features(signature), start=0.6))
    agrees(core.SurfaceMap(a, b))
    agrees(core.SurfaceMap(b, a))


@pytest.mark.parametrize("signature", ["442", "432", "22222"])
def test_meshes_that_are_finer_or_coarser(signature):
    """The middles of the coarse edges are vertices of the finer mesh, or nearly so."""
    mesh = icosphere(2)
    fine = subdivided(*mesh)
    picked = far_apart(*mesh, len(features(signature).cones))
    a, b = embedded(mesh, signature, picked), embedded(fine, signature, picked)
    agrees(core.SurfaceMap(a, b))
    agrees(core.SurfaceMap(b, a))


def test_landmarks_at_random():
    random = np.random.default_rng(7)
    mesh, other = icosphere(3), shapes.roughened(icosphere(2), amount=0.3)
    for count in (3, 4, 6, 12):
        picked = random.choice(len(mesh[0]), count, replace=False)
        picked = picked[core.landmark_sequence(*mesh, picked)]
        signature = "442" if count == 3 else "2" * count
        a = embedded(mesh, signature, picked)
        b = embedded(other, signature, corresponding(mesh, other, picked))
        agrees(core.SurfaceMap(a, b))
        agrees(core.SurfaceMap(b, a))


def test_what_goes_over_a_filled_hole_is_nowhere():
    mesh, open_mesh = icosphere(2), (icosphere(2)[0], icosphere(2)[1][1:])
    picked = [v for v in far_apart(*mesh, 5) if v not in mesh[1][0]][:3]
    a, b = embedded(mesh, "442", picked), embedded(open_mesh, "442", picked, holes="fill")
    trace = agrees(core.SurfaceMap(a, b))
    gone = trace.triangles < 0
    assert 0 < gone.sum() < 20 and (trace.barycentric[gone] == 0).all()
    agrees(core.SurfaceMap(b, a))


def test_edges_that_are_none():
    mesh = icosphere(2)
    itself = core.SurfaceMap(*[embedded(mesh, "442", far_apart(*mesh, 3))] * 2)
    assert len(itself.trace(np.zeros(0, int)).edges) == 0
    for corner in (-1, 3 * len(mesh[1])):
        with pytest.raises(core.OrbifoldError, match="does not have"):
            itself.trace([corner])
