# SPDX-License-Identifier: GPL-3.0-or-later
"""The disks of ../shared/reference: an independent program's energies with mirror corners, and the papers' authors'
disks in the plane and on the sphere."""

import json

import numpy as np
import pytest
from conftest import SHARED
from meshes import shared_file
from test_reference import authors, authors_weights, case_name, sphere_lengths

import core

REFERENCE = SHARED / "reference"


def disk_energies():
    path = REFERENCE / "energies.json"
    cases = json.loads(path.read_text()) if path.is_file() else []
    return [case for case in cases if "corners_ccw" in case and case["certified"]]


def corners_of(result):
    """(m, 3, 3) the given triangles' corners in the model."""
    return (result.embedding + result.embedding_low)[result.corner_copies]


def plane_area(corners):
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return 0.5 * np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum()


@pytest.mark.parametrize("case", disk_energies() or [None], ids=lambda case: case_name(case) if case else "none")
def test_energy_of_an_independent_program(case):
    shared_file("reference", "energies.json")
    vertices, triangles = core.read_mesh(shared_file("meshes", case["mesh"]))
    corners, clamp = case["corners_ccw"], case["clamp"]
    result = core.embed(vertices, triangles, case["signature"], corners, weights="cotan", clamp=clamp)
    energy = result.report["solver"]["energy"]
    if result.geometry == "euclidean":  # theirs has the sides sin(pi / n_i)
        energy *= np.prod(np.sin(np.pi / result.orders)) / 2 / plane_area(corners_of(result))
    assert energy == pytest.approx(case["energy"], rel=1e-8)


def placed(result, n):
    """(n, 2) where each given vertex lies in the plane; a disk with mirrors alone is not cut."""
    where = np.empty((n, 2))
    where[result.cut_to_vertex[result.corner_copies]] = corners_of(result)[..., :2]
    return where


def fitted(ours, theirs, columns):
    """Ours moved onto theirs, by least squares over the maps that `columns` of ours span."""
    design = columns(ours)
    return design @ np.linalg.lstsq(design, theirs.ravel(), rcond=None)[0]


def similarity(points):
    x, y = points.T
    one, zero = np.ones_like(x), np.zeros_like(x)
    rows = np.stack([np.stack([x, -y, one, zero], 1), np.stack([y, x, zero, one], 1)], 1)
    return rows.reshape(-1, 4)


def affine(points):
    rows = np.zeros((len(points), 2, 6))
    rows[:, 0, :2] = rows[:, 1, 2:4] = points
    rows[:, 0, 4] = rows[:, 1, 5] = 1
    return rows.reshape(-1, 6)


@pytest.mark.parametrize("name, signature, motion", [("tri", "*244", similarity), ("sq", "*2222", affine)])
def test_authors_disks_in_the_plane(name, signature, motion):
    """Interior vertices to a thousandth of the tile: three of their triangles have no area, where an edge joins two
    vertices of one mirror. Their rectangle is a square, ours the one of least conformal energy."""
    about, arrays, vertices, triangles = authors(f"e_scriptdisk_{name}_cot")
    rows = authors_weights(vertices, triangles, arrays["T"], arrays["cut2orig"].ravel(), clamp=0.01)
    rows[:, 2] = np.maximum(rows[:, 2], 1e-14)  # they leave the zeros of right angles as they are
    result = core.embed(vertices, triangles, signature, about["cones_0based"], weights=rows)
    ours, theirs = placed(result, len(vertices)), arrays["X"]
    error = min(
        np.abs(fitted(side * ours, theirs, motion).reshape(-1, 2) - theirs).max(1).max() for side in ([1, 1], [1, -1])
    )
    assert error < 1e-3 * np.ptp(theirs)
    if name == "tri":
        scale = about["signed_area"] / plane_area(corners_of(result))
        assert result.report["solver"]["energy"] * scale == pytest.approx(about["energy_clamped"], rel=1e-3)


# Their disk code swaps the angles of cones 2 and 3: these are the orders that their layout has at its cones.
SWAPPED = {"s_fandisk_disk_234": [2, 4, 3], "s_fandisk_disk_235": [2, 5, 3]}


@pytest.mark.parametrize("name", SWAPPED)
@pytest.mark.parametrize("their_weights", [True, False], ids=["their weights", "our clamp"])
def test_authors_disks_on_the_sphere(name, their_weights):
    about, arrays, vertices, triangles = authors(name)
    rows = authors_weights(vertices, triangles, arrays["T"], arrays["cut2orig"].ravel())
    rows[:, 2] = np.maximum(rows[:, 2], 1e-14)
    signature = "*" + "".join(map(str, SWAPPED[name]))
    weights = rows if their_weights else "cotan"
    result = core.embed(vertices, triangles, signature, about["cones_0based"], weights=weights, clamp=0.001)
    assert 2 * result.report["solver"]["energy"] == pytest.approx(about["energy"], rel=1e-6 if their_weights else 1e-3)
    ours, theirs = sphere_lengths(corners_of(result)), sphere_lengths(arrays["X"][triangles])
    assert np.abs(ours - theirs).max() < (1e-6 if their_weights else 2e-3)
