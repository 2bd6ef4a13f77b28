# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces that are orbifolds already: flat ones come back unchanged to the last digits, triangles and cones of the
sphere and of the hyperbolic plane in the limit of fine meshes."""

import numpy as np
import pytest
from conway import features
from flat import HEIGHT, flat_surface, subdivided_triangle, weights_of
from meshes import icosphere
from shapes import antipodal_quotient, hemisphere

import core


def corners_of(result):
    """(m, 3, 3) the given triangles' corners in the model."""
    return (result.embedding + result.embedding_low)[result.corner_copies]


def sides(corners):
    return np.linalg.norm(corners - np.roll(corners, -1, 1), axis=2)


def check_similar(result, corners, tolerance=1e-10):
    """All sides of all triangles in one proportion."""
    ratio = sides(corners_of(result)) / sides(corners)
    assert np.abs(ratio / ratio.mean() - 1).max() < tolerance
    distance = result.report["solver"]["energy"] * ratio.mean() ** -2
    area = 0.5 * np.abs(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])).sum()
    assert distance == pytest.approx(area, rel=1e-10)  # Dirichlet's energy of the identity


FLAT = ["o", "xx", "**", "*x", "*2222"]


@pytest.mark.parametrize("signature", FLAT)
@pytest.mark.parametrize("nx, ny, shift", [(9, 8, 0), (6, 14, 3), (12, 4, 6)])
def test_flat_surfaces_reproduce_themselves(signature, nx, ny, shift):
    flat = flat_surface(signature, nx, ny, shift, roughness=0.08 * (signature == "*2222"))
    result = core.embed(flat.vertices, flat.triangles, signature, flat.cones, weights="cotan")
    assert result.report["orbifold"]["moduli"] == (2 if signature == "o" else 1)
    assert result.report["distortion"]["quasi_conformal_max"] == pytest.approx(1, abs=1e-10)
    check_similar(result, flat.corners)


@pytest.mark.parametrize("signature", FLAT)
@pytest.mark.parametrize("nx, ny, shift", [(9, 8, 0), (5, 14, 2), (12, 4, 5)])
def test_any_flat_weights_give_an_affine_image(signature, nx, ny, shift):
    """The modulus suits the mesh as it is in space, which here is another one than that of the weights."""
    flat = flat_surface(signature, nx, ny, shift)
    result = core.embed(flat.vertices, flat.triangles, signature, flat.cones, weights=flat.weights)
    x, y = (flat.corners - np.roll(flat.corners, -1, 1)).reshape(-1, 2).T
    ours = sides(corners_of(result)).ravel()
    # |A e|^2 = e' (A'A) e for all sides e: three unknowns
    design = np.stack([x * x, 2 * x * y, y * y], 1) / ours[:, None] ** 2
    metric, *_ = np.linalg.lstsq(design, np.ones(len(design)), rcond=None)
    assert np.abs(design @ metric - 1).max() < 1e-10
    if signature != "o":
        assert abs(metric[1]) < 1e-10 * metric[0]  # no shear along or across an axis of reflection


def test_the_modulus_of_a_torus_is_reported():
    flat = flat_surface("o", 9, 8, 3, roughness=0)
    result = core.embed(flat.vertices, flat.triangles, "o", [], weights="cotan")
    tau = complex(-3, 8 * HEIGHT) / 9
    found = complex(*result.report["orbifold"]["modulus"])
    alike = [s * z for z in (tau, -tau.conjugate(), -1 / tau, 1 / tau.conjugate()) for s in (1, -1)]
    assert min(abs(found - z - shift) for z in alike for shift in (-1, 0, 1)) < 1e-10


def plane_triangle(orders):
    a, b, _ = np.pi / np.array(orders)
    c = np.sin(b) / np.sin(a + b)
    return np.array([[0, 0], [1, 0], [c * np.cos(a), c * np.sin(a)]])


@pytest.mark.parametrize("signature", ["*442", "*333", "*632", "*244", "*326"])
@pytest.mark.parametrize("n", [2, 7])
def test_plane_triangles_reproduce_themselves(signature, n):
    """Right triangles have weights of 0 along the hypotenuse; the clamp takes their place."""
    (orders,) = features(signature).mirrors
    points, triangles = subdivided_triangle(plane_triangle(orders), n)
    turn, _ = np.linalg.qr(np.arange(9).reshape(3, 3) + np.eye(3))
    vertices = np.column_stack([points, np.zeros(len(points))]) @ turn
    result = core.embed(vertices, triangles, signature, [0, 1, 2], weights="cotan", clamp=1e-13)
    check_similar(result, points[triangles])


# ------------------------------------------------------------------------------------------------- in the limit


def curved_triangle(orders):
    """(3, 3) corners in the model, with the angles pi / n."""
    a, b, c = np.pi / np.array(orders)
    sign = 1 if a + b + c > np.pi else -1

    def side(opposite, left, right):
        return (np.cos(opposite) + np.cos(left) * np.cos(right)) / (np.sin(left) * np.sin(right))

    def away(cosine, angle):
        sine = np.sqrt(sign * (1 - cosine**2))
        return sine * np.cos(angle), sine * np.sin(angle), cosine

    return sign, np.array([(0, 0, 1), away(side(c, a, b), 0), away(side(b, a, c), a)])


def onto_model(points, sign):
    return points / np.sqrt(sign * (points[:, 0] ** 2 + points[:, 1] ** 2 + sign * points[:, 2] ** 2))[:, None]


def error_of_triangle(signature, n):
    """The greatest distance of a vertex, in the model, from where it was before."""
    (orders,) = features(signature).mirrors
    sign, corners = curved_triangle(orders)
    flat, triangles = subdivided_triangle(corners, n)
    points = onto_model(flat, sign)
    vertices = points if sign > 0 else np.column_stack([points[:, :2] / (1 + points[:, 2:]), np.zeros(len(points))])
    result = core.embed(vertices, triangles, signature, [0, 1, 2], weights="cotan", clamp=1e-6)
    found = np.empty_like(points)
    found[triangles] = corners_of(result)
    motion = np.linalg.solve(found[:3], points[:3])  # the isometry, perhaps a reflection, of the corners
    assert np.abs(motion @ np.diag([1, 1, sign]) @ motion.T - np.diag([1, 1, sign])).max() < 1e-9
    return np.abs(found @ motion - points).max()


@pytest.mark.parametrize("signature", ["*222", "*332", "*432", "*532", "*225", "*223", "*334", "*345", "*555"])
def test_curved_triangles_reproduce_themselves_in_the_limit(signature):
    """(The hyperbolic ones have no right angle: there the meshes would have negative weights.)"""
    coarse, fine = (error_of_triangle(signature, n) for n in (6, 18))
    assert fine < coarse / 4 or fine < 1e-9
    assert fine < 3e-3


def error_of_cone(order, surface, signature, cones, where, weights="cotan"):
    """Root mean square, over the vertices, of the distance from a cone less what z -> z^(1/n) makes of it."""
    vertices, triangles = surface
    result = core.embed(vertices, triangles, signature, cones, weights=weights)
    pole = result.embedding[np.flatnonzero(result.cut_to_vertex == cones[0])[0]]
    found = np.arccos(np.clip(corners_of(result) @ pole, -1, 1))
    found = np.minimum(found, np.pi - found) if signature.endswith("x") else found
    expected = 2 * np.arctan(np.tan(where[triangles] / 2) ** (1 / order))
    return np.sqrt(np.mean((found - expected) ** 2))


@pytest.mark.parametrize("order", [2, 3])
@pytest.mark.parametrize("family", ["nn", "n*", "nx"])
def test_a_rotational_quotient_of_the_sphere_is_a_root(family, order):
    def error(level):
        if family == "n*":
            vertices, triangles = surface = hemisphere(2 * 2**level)
            where = np.arccos(np.clip(vertices[:, 2], 0, 1))
            return error_of_cone(order, surface, f"{order}*", [0], where)
        if family == "nn":
            vertices, triangles = surface = icosphere(level)
            where = np.arccos(np.clip(vertices @ vertices[0], -1, 1))
            return error_of_cone(order, surface, f"{order}{order}", [0, int(np.argmax(where))], where)
        vertices, triangles = surface = antipodal_quotient(level)
        height = np.abs(vertices @ vertices[0])
        corners = vertices[triangles]
        for c in (1, 2):  # of the two places of each corner the one near the first
            corners[:, c] *= np.sign((corners[:, c] * corners[:, 0]).sum(1))[:, None]
        weights = weights_of(triangles, corners)
        return error_of_cone(order, surface, f"{order}x", [0], np.arccos(np.clip(height, 0, 1)), weights)

    errors = [error(level) for level in (2, 3)]
    assert errors[1] < errors[0] * (0.65 if order == 2 else 0.75)
    assert errors[1] < (0.04 if order == 2 else 0.1)
