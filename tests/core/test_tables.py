# SPDX-License-Identifier: GPL-3.0-or-later
"""Every orbifold of both tables, and a wide choice of hyperbolic ones, on two meshes of its topology: certified by the
library and judged by check_layout.py."""

import numpy as np
import pytest
from conway import features
from families import EUCLIDEAN, HYPERBOLIC, SPHERICAL, cases, mesh_named
from judged import judge_without_weights, verdict
from picks import picks_for

import core


def embedded(signature, name, weights="cotan"):
    wanted = features(signature)
    mesh = mesh_named(wanted.topology, name)
    return core.embed(*mesh, signature, picks_for(*mesh, wanted), weights=weights)


def check_pieces(result):
    """The cut runs along given edges only: in all pieces of a given triangle each vertex is the same copy."""
    if result.refined_from is None:
        return
    inside = np.repeat(result.refined_from >= 0, 3)
    corner = np.stack([np.repeat(result.refined_from, 3), result.triangles.ravel()], 1)[inside]
    both = np.column_stack([corner, result.cut_triangles.ravel()[inside]])
    assert len(np.unique(both, axis=0)) == len(np.unique(corner, axis=0))


def check(signature, name, folder):
    result, wanted = embedded(signature, name), features(signature)
    report = result.report
    assert report["certificate"]["flipped"] == 0 and report["certificate"]["seam_residual"] < 1e-7
    assert report["orbifold"]["euler"] == pytest.approx(float(wanted.euler), abs=1e-12)
    assert result.geometry == report["orbifold"]["geometry"] == wanted.geometry
    mirrors = [False] * len(wanted.cones) + [True] * (len(wanted.orders) - len(wanted.cones))
    assert [(cone["order"], cone["mirror"]) for cone in report["orbifold"]["cones"]] == [*zip(wanted.orders, mirrors)]
    handles, crosscaps, boundaries = wanted.topology
    assert report["mesh"]["boundary_loops"] == boundaries and report["mesh"]["genus"] == handles + crosscaps
    check_pieces(result)
    said = verdict(result, folder)
    assert said["ok"], said["why"]
    assert said["harmonic_residual"] < 1e-6 and report["solver"]["relative_gradient"] < 1e-6


@pytest.mark.parametrize("signature, mesh", cases(SPHERICAL))
def test_spherical(signature, mesh, tmp_path):
    check(signature, mesh, tmp_path)


@pytest.mark.parametrize("signature, mesh", [*cases(EUCLIDEAN), ("o", "kitten.obj")])
def test_euclidean(signature, mesh, tmp_path):
    check(signature, mesh, tmp_path)


@pytest.mark.parametrize("signature, mesh", cases(HYPERBOLIC))
def test_hyperbolic(signature, mesh, tmp_path):
    check(signature, mesh, tmp_path)


@pytest.mark.parametrize("weights", ["conformal", "delaunay", "mean-value"])
@pytest.mark.parametrize("signature, mesh", cases(SPHERICAL + EUCLIDEAN + HYPERBOLIC)[::2])
def test_other_weights(signature, mesh, weights, tmp_path):
    """Some live on the edges of another triangulation: then there is no harmonic condition to judge."""
    result = embedded(signature, mesh, weights)
    if result.weights is None:
        said = judge_without_weights(result, tmp_path)
    else:
        said = verdict(result, tmp_path)
    assert said["ok"], said["why"]
    assert result.report["certificate"]["flipped"] == 0


def test_the_tables_are_complete():
    for signatures, geometry in ((SPHERICAL, "spherical"), (EUCLIDEAN, "euclidean"), (HYPERBOLIC, "hyperbolic")):
        assert len(set(signatures)) == len(signatures)
        assert {features(signature).geometry for signature in signatures} == {geometry}
    assert len(EUCLIDEAN) == 17 and len(SPHERICAL) == 3 * 7 + 7
