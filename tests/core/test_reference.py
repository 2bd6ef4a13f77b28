# SPDX-License-Identifier: GPL-3.0-or-later
"""The sphere-like cases of ../shared/reference: an independent program's energies, and the papers' authors' results.

Everything is compared by lengths and areas on the tile, which do not depend on where a mesh was cut or on which
isometric copy of the tile was used."""

import json

import numpy as np
import pytest
from conftest import SHARED
from meshes import shared_file

import core

REFERENCE = SHARED / "reference"


def energies():
    path = REFERENCE / "energies.json"
    cases = json.loads(path.read_text()) if path.is_file() else []
    return [case for case in cases if "cones" in case and "*" not in case["signature"] and case["certified"]]


def case_name(case):
    return f"{case['mesh']}-{case['signature']}"


def corners_of(result):
    """(m, 3, 3) the triangles' corners in the model."""
    return (result.embedding + result.embedding_low)[result.cut_triangles]


def plane_area(corners):
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum()


def chord_lengths(corners):
    """(m, 3) lengths of the sides, as chords."""
    return np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)


def sphere_lengths(corners):
    return 2 * np.arcsin(np.minimum(chord_lengths(corners) / 2, 1))


@pytest.mark.parametrize("case", energies() or [None], ids=lambda case: case_name(case) if case else "none")
def test_energy_of_an_independent_program(case):
    shared_file("reference", "energies.json")
    vertices, triangles = core.read_mesh(shared_file("meshes", case["mesh"]))
    result = core.embed(vertices, triangles, case["signature"], case["cones"], clamp=case["clamp"])
    energy = result.report["solver"]["energy"]
    if result.geometry == "euclidean":
        # Theirs has the sides sin(pi / n_i) and so the circumdiameter 1 and the area sin sin sin / 2, twice.
        theirs = np.prod(np.sin(np.pi / result.orders))
        energy *= theirs / plane_area(corners_of(result))
    assert energy == pytest.approx(case["energy"], rel=1e-8)


def authors(name):
    """(description, arrays, mesh) of one of the authors' results; the mesh's triangles are in their sequence."""
    about = json.loads(shared_file("reference", f"{name}.json").read_text())
    with np.load(shared_file("reference", f"{name}.npz")) as file:
        arrays = {key: file[key] for key in file}
    vertices, triangles = core.read_mesh(shared_file("reference", about["mesh"]))
    assert np.array_equal(arrays["cut2orig"].ravel()[arrays["T"]], triangles)
    return about, arrays, vertices, triangles


@pytest.mark.parametrize("name, signature", [("t1", "442"), ("t2", "333"), ("t3", "623")])
def test_authors_euclidean_result_up_to_a_similarity(name, signature):
    """(The angles of their t3 are those of 6, 2, 3, in this sequence.)"""
    about, arrays, vertices, triangles = authors(f"e_sphere_{name}_cot")
    result = core.embed(vertices, triangles, signature, about["cones_0based"])
    ours, theirs = chord_lengths(corners_of(result)), chord_lengths(arrays["X"][arrays["T"]])
    scale = np.sqrt(plane_area(corners_of(result)) / about["signed_area"])
    assert np.abs(ours / theirs / scale - 1).max() < 1e-9
    energy = result.report["solver"]["energy"] / scale**2
    assert energy == pytest.approx(about["energy_clamped"], rel=1e-9)


def test_authors_mean_values_up_to_a_similarity():
    """Floater's weights as they stand, which are not symmetric."""
    about, arrays, vertices, triangles = authors("e_sphere_t1_mvc")
    result = core.embed(vertices, triangles, "442", about["cones_0based"], weights="mean-value-exact")
    ours, theirs = chord_lengths(corners_of(result)), chord_lengths(arrays["X"][arrays["T"]])
    scale = np.sqrt(plane_area(corners_of(result)) / plane_area(np.pad(arrays["X"], ((0, 0), (0, 1)))[arrays["T"]]))
    assert np.abs(ours / theirs / scale - 1).max() < 1e-9
    assert result.weights is None
    symmetrised = core.embed(vertices, triangles, "442", about["cones_0based"], weights="mean-value")
    assert np.abs(chord_lengths(corners_of(symmetrised)) / theirs / scale - 1).max() > 1e-3


def test_authors_2222_up_to_an_affine_map():
    about, arrays, vertices, triangles = authors("e_sphere_t4_cot")
    result = core.embed(vertices, triangles, "2222", about["cones_0based"])
    theirs = arrays["X"][arrays["T"]]
    side = (theirs - np.roll(theirs, -1, axis=1)).reshape(-1, 2)
    ours = chord_lengths(corners_of(result)).ravel()
    # |A e|^2 = e' (A'A) e for all sides e: three unknowns
    x, y = side.T
    design = np.stack([x * x, 2 * x * y, y * y], 1) / ours[:, None] ** 2
    metric, *_ = np.linalg.lstsq(design, np.ones(len(design)), rcond=None)
    assert metric[0] > 0 and metric[0] * metric[2] > metric[1] ** 2
    assert np.abs(design @ metric - 1).max() < 1e-9


def test_authors_2222_of_least_conformal_energy():
    about, _, vertices, triangles = authors("e_sphere_t4_cot_minconf")
    result = core.embed(vertices, triangles, "2222", about["cones_0based"])
    ours = result.report["solver"]["energy"] / plane_area(corners_of(result))
    assert ours == pytest.approx(about["energy_clamped"] / about["signed_area"], rel=1e-3)


SPHERICAL = ["s_man_12_22", "s_man_233", "s_man_234", "s_man_422", "s_man_432", "s_man_532"]


def authors_weights(vertices, triangles, cut_triangles, cut_to_vertex, clamp=float(np.float32(0.001))):
    """Rows i, j, w: (cot a + cot b) / 2 summed on the cut mesh and clamped there, then both banks of the cut added."""
    corner = vertices[triangles]
    u, v = np.roll(corner, -1, 1) - corner, np.roll(corner, -2, 1) - corner
    cotangent = (u * v).sum(2) / np.linalg.norm(np.cross(u, v), axis=2)  # at corner c: of the side c+1, c+2
    ends = np.sort(np.stack([np.roll(cut_triangles, -1, 1), np.roll(cut_triangles, -2, 1)], 2).reshape(-1, 2), 1)
    edges, of = np.unique(ends, axis=0, return_inverse=True)
    weight = np.bincount(of.ravel(), cotangent.ravel() / 2)
    weight[weight < 0] = clamp
    glued, of = np.unique(np.sort(cut_to_vertex[edges], 1), axis=0, return_inverse=True)
    return np.column_stack([glued, np.bincount(of.ravel(), weight)])


@pytest.mark.parametrize("name", SPHERICAL)
def test_authors_spherical_result_with_their_weights(name):
    about, arrays, vertices, triangles = authors(name)
    rows = authors_weights(vertices, triangles, arrays["T"], arrays["cut2orig"].ravel())
    signature = core.format_signature(about["orders"])
    result = core.embed(vertices, triangles, signature, about["cones_0based"], weights=rows)
    assert 2 * result.report["solver"]["energy"] == pytest.approx(about["energy"], rel=1e-6)
    ours, theirs = sphere_lengths(corners_of(result)), sphere_lengths(arrays["X"][arrays["T"]])
    assert np.abs(ours - theirs).max() < 1e-6


@pytest.mark.parametrize("name", SPHERICAL)
def test_authors_spherical_result_with_our_clamp(name):
    about, arrays, vertices, triangles = authors(name)
    signature = core.format_signature(about["orders"])
    result = core.embed(vertices, triangles, signature, about["cones_0based"], clamp=0.001)
    assert 2 * result.report["solver"]["energy"] == pytest.approx(about["energy"], rel=1e-3)


@pytest.mark.parametrize("n", [2, 3, 5])
def test_authors_two_cones_with_their_weights(n):
    about, arrays, vertices, triangles = authors(f"s_man_kk{n}")
    rows = authors_weights(vertices, triangles, arrays["T"], arrays["cut2orig"].ravel())
    assert about["orders"] == n
    result = core.embed(vertices, triangles, f"{n}{n}", about["cones_0based"], weights=rows)
    assert 2 * result.report["solver"]["energy"] == pytest.approx(about["energy"], rel=1e-6)
    ours, theirs = sphere_lengths(corners_of(result)), sphere_lengths(arrays["X"][arrays["T"]])
    assert np.abs(ours - theirs).max() < 1e-5  # nearly free along the axis: theirs stopped at a gradient of 1e-7
