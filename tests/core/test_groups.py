# SPDX-License-Identifier: GPL-3.0-or-later
"""The generators of an embedding make its group: spherical ones have 2 / chi elements and tile the sphere, Euclidean
ones are the seventeen wallpaper groups, hyperbolic tiles have the area -2 pi chi and their images do not overlap."""

import numpy as np
import pytest
from conway import features
from families import EUCLIDEAN, HYPERBOLIC, MESHES, SPHERICAL, mesh_named
from isometries import generated, times_covered, wallpaper
from judged import judge_module, model_points
from meshes import CHECK_LAYOUT
from picks import picks_for
from shapes import boy_surface, disk, roughened

import core

needs_judge = pytest.mark.skipif(not CHECK_LAYOUT.is_file(), reason="../shared/tools/check_layout.py is not there")

WALLPAPER = {
    **{"o": "p1", "2222": "p2", "**": "pm", "xx": "pg", "*x": "cm", "*2222": "pmm", "22*": "pmg", "22x": "pgg"},
    **{"2*22": "cmm", "442": "p4", "*442": "p4m", "4*2": "p4g", "333": "p3", "*333": "p3m1", "3*3": "p31m"},
    **{"632": "p6", "*632": "p6m"},
}
CURVATURE = {"spherical": 1, "euclidean": 0, "hyperbolic": -1}


def embedded(signature):
    wanted = features(signature)
    small = {(0, 0, 1): lambda: roughened(disk(5)), (0, 1, 0): lambda: roughened(boy_surface(2))}
    if wanted.topology in small:
        mesh = small[wanted.topology]()
    else:
        mesh = mesh_named(wanted.topology, next(iter(MESHES[wanted.topology])))
    return core.embed(*mesh, signature, picks_for(*mesh, wanted))


def tile_triangles(result):
    return np.asarray(model_points(result), float)[result.cut_triangles]


def probes(curvature):
    plane = np.array([[0.11, 0.02], [-0.07, 0.13], [0.05, -0.17]])
    return np.column_stack([plane, np.sqrt(1 - curvature * (plane**2).sum(1))])


def check_isometries(generators, curvature):
    form = np.diag([1, 1, curvature])
    for g in generators:
        if curvature:
            size = np.abs(g).max() ** 2
            assert np.abs(g.T @ form @ g - form).max() < 1e-9 * size
        else:
            assert np.abs(g[:2, :2] @ g[:2, :2].T - np.eye(2)).max() < 1e-10 and np.abs(g[2] - [0, 0, 1]).max() < 1e-12


def orientation_preserving(signature):
    wanted = features(signature)
    return not wanted.mirrors and not wanted.crosscaps


@pytest.mark.parametrize("signature", SPHERICAL)
def test_copies_tile_the_sphere(signature):
    result = embedded(signature)
    check_isometries(result.generators, 1)
    order = int(2 / features(signature).euler)
    elements = generated(result.generators, order + 20, probes(1))
    assert len(elements) == order
    assert all(np.linalg.det(g) > 0 for g in result.generators) == orientation_preserving(signature)
    points = np.random.default_rng(1).normal(size=(150, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    assert (times_covered(points, elements, tile_triangles(result)) == 1).all()


@pytest.mark.parametrize("signature", EUCLIDEAN)
def test_wallpaper_group(signature):
    result = embedded(signature)
    check_isometries(result.generators, 0)
    triangles = tile_triangles(result)
    size = np.ptp(triangles[..., :2].reshape(-1, 2), axis=0).max()
    elements = generated(result.generators, 400, size * probes(0))
    name, basis, order = wallpaper(elements)
    assert name == WALLPAPER[signature]
    a, b = (triangles[:, k, :2] - triangles[:, 0, :2] for k in (1, 2))
    tile_area = np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum() / 2
    assert abs(np.linalg.det(basis)) == pytest.approx(order * tile_area, rel=1e-9)
    # around the tile the images of it cover every point once
    middle = triangles[..., :2].mean((0, 1))
    near = sorted(elements, key=lambda g: np.linalg.norm((g @ [*middle, 1])[:2] - middle))[:200]
    reach = np.linalg.norm(triangles[..., :2].reshape(-1, 2) - middle, axis=1).max()
    points = np.column_stack([middle + np.random.default_rng(1).uniform(-0.3, 0.3, (100, 2)) * reach, np.ones(100)])
    assert (times_covered(points, near, triangles) == 1).all()


@needs_judge
@pytest.mark.parametrize("signature", HYPERBOLIC)
def test_hyperbolic_tile(signature):
    """Its area, and that no point of it lies in another image of it near by."""
    result = embedded(signature)
    check_isometries(result.generators, -1)
    assert all(np.linalg.det(g) > 0 for g in result.generators) == orientation_preserving(signature)
    angles = judge_module()["corner_angles"](model_points(result)[result.cut_triangles], -1)
    area = float((np.pi - angles.sum(1)).sum())
    assert area == pytest.approx(float(-2 * np.pi * features(signature).euler), rel=1e-7)
    triangles = tile_triangles(result)
    if np.abs(triangles).max() > 100:
        return  # too far out for images in single precision of the model
    points = triangles[:: max(1, len(triangles) // 60)].mean(1)
    elements = generated(result.generators, 150, probes(-1))
    assert (times_covered(points, elements, triangles) == 1).all()


# ------------------------------------------------------------------------------------------------- the drawn tile


@pytest.mark.parametrize("signature", SPHERICAL + EUCLIDEAN + HYPERBOLIC + ["(40)(40)", "*(40)2(40)", "*" * 4, "oooo"])
def test_tile_of_a_signature(signature):
    """On its model, counter-clockwise, with mirrors where the signature has any, and the orbifold's area."""
    wanted = features(signature)
    curvature = CURVATURE[wanted.geometry]
    points, mirrors = core.binding.signature_tile(signature)
    assert len(points) == len(mirrors) >= 2 and mirrors.any() == bool(wanted.mirrors)
    if all(mirrors):
        assert len(wanted.mirrors) == 1 and not wanted.cones and len(points) >= len(wanted.orders)
    on_model = points[:, 2] - 1 if curvature == 0 else (points**2) @ [1, 1, curvature] - curvature
    assert np.abs(on_model).max() < 1e-9 * np.abs(points).max() ** 2
    opposite = np.linalg.norm(points[:, None] + points, axis=2) < 1e-9
    if not CHECK_LAYOUT.is_file() or opposite.any(1).all() or np.diag(np.roll(opposite, -1, 1)).any():
        return  # which way a side goes between antipodes its ends do not tell
    area = polygon_area(np.roll(points, -int(np.argmin(opposite.any(1))), 0), curvature)
    assert area > 0
    if curvature:
        assert area == pytest.approx(float(abs(2 * np.pi * wanted.euler)), rel=1e-7)


def polygon_area(points, curvature):
    """Signed, as a fan of triangles about a corner; the polygon may have straight or reflex angles."""
    fan = np.stack([np.broadcast_to(points[0], points[2:].shape), points[1:-1], points[2:]], 1)
    sign = np.sign(np.linalg.det(fan))
    if curvature == 0:
        return np.linalg.det(fan).sum() / 2
    angles = judge_module()["corner_angles"](fan, curvature)
    return float((sign * curvature * (angles.sum(1) - np.pi)).sum())
