# SPDX-License-Identifier: GPL-3.0-or-later
"""What a target gets from a source (addon/correspondence.py): UV maps beside seams, displacements, orbifolds."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import pytest
from conftest import SHARED
from meshes import far_apart, icosphere, subdivided
from surfaces import bare

import core


@dataclass
class Arrays:
    """As Blender's meshes are read, all faces triangles."""

    vertices: np.ndarray
    triangles: np.ndarray

    @property
    def loops(self):
        return np.arange(3 * len(self.triangles)).reshape(-1, 3)

    @property
    def polygons(self):
        return np.arange(len(self.triangles))

    @property
    def n_loops(self):
        return 3 * len(self.triangles)


def between(source, target, picked, landmarks, signature):
    results = [core.embed(*mesh, signature, places, weights="conformal", cut="path")
               for mesh, places in ((source, picked), (target, landmarks))]
    there, back = core.SurfaceMap(results[1], results[0]), core.SurfaceMap(results[0], results[1])
    return bare("correspondence").Correspondence(Arrays(*source), Arrays(*target), there, back)


@lru_cache
def spheres():
    """From a sphere to a finer one, about as it is, turned a little, so that no seam is along its edges."""
    coarse, fine = icosphere(3), icosphere(4)
    a = 0.1
    turn = np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])
    turn = turn @ [[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]]
    fine = fine[0] @ turn.T, fine[1]
    picked = far_apart(*coarse, 5)
    picked = picked[core.landmark_sequence(*coarse, picked)]
    landmarks = [int(((fine[0] - coarse[0][v]) ** 2).sum(1).argmin()) for v in picked]
    return between(coarse, fine, picked, landmarks, "22222"), coarse, fine


def islands(mesh, normal):
    """(loops, 2): two islands, one on each side of a plane through the middle, far from one another."""
    at = mesh[0][mesh[1]]
    below = at.mean(1) @ normal < 0
    return (at[:, :, :2] + 10 * below[:, None, None]).reshape(-1, 2)


def longitude(mesh):
    """(loops, 2): one island, both sides of whose seam are one line on the mesh."""
    at = mesh[0][mesh[1]]
    angle = np.arctan2(at[:, :, 1], at[:, :, 0])
    middle = np.arctan2(*at.mean(1)[:, 1::-1].T)[:, None]
    angle = middle + (angle - middle + np.pi) % (2 * np.pi) - np.pi
    return np.stack([angle, at[:, :, 2]], 2).reshape(-1, 2)


@pytest.mark.parametrize("kind", ["islands", "longitude"])
def test_no_face_is_drawn_from_one_side_of_a_seam_to_the_other(kind):
    work, source, target = spheres()
    normal = np.array([0.3, 0.2, 1.0])
    uv = islands(source, normal) if kind == "islands" else longitude(source)
    found, crossing = work.of_uv(uv)
    found = found.reshape(-1, 3, 2)
    middles = target[0][target[1]].mean(1)
    poles = np.linalg.norm(middles[:, :2], axis=1) < (0.35 if kind == "longitude" else 0)
    assert np.ptp(found[~poles], axis=1).max() < 0.8
    assert 0 < len(crossing) < 0.12 * len(target[1])
    off = np.abs(middles @ normal) if kind == "islands" else np.where(middles[:, 0] < 0, np.abs(middles[:, 1]), 1.0)
    assert off[crossing][~poles[crossing]].max() < 0.4, "only faces near the seam cross it"


def spot_with_uv():
    """Its mesh, and its UV map as a mesh in the plane with the same triangles."""
    rows = [line.split() for line in (SHARED / "meshes" / "spot.obj").read_text().splitlines()]
    points, places = (np.array([row[1:] for row in rows if row[:1] == [kind]], float) for kind in ("v", "vt"))
    corners = np.array([[corner.split("/")[:2] for corner in row[1:]] for row in rows if row[:1] == ["f"]], int) - 1
    return (points, corners[:, :, 0]), (places[:, :2], corners[:, :, 1])


@pytest.mark.skipif(not (SHARED / "meshes" / "spot.obj").is_file(), reason="../shared/meshes/spot.obj is not there")
@pytest.mark.parametrize("finer", [True, False])
def test_spot_s_uv_map_between_two_subdivisions(finer):
    """The surfaces are one, so the answer is known: interpolated, or what was interpolated. The UVs of a mesh's edges
    are 0.012 long, those of the subdivided one's half as long."""
    meshes, maps = ([one, subdivided(*one)] for one in spot_with_uv())
    order = slice(None) if finer else slice(None, None, -1)
    (source, target), uv = meshes[order], [points[places].reshape(-1, 2) for points, places in maps[order]]
    picked = far_apart(*meshes[0], 5)
    picked = picked[core.landmark_sequence(*meshes[0], picked)]
    found, crossing = between(source, target, picked, picked, "22222").of_uv(uv[0])
    off = np.linalg.norm(found - uv[1], axis=1).reshape(-1, 3)
    sound = np.ones(len(off), bool)
    sound[crossing] = False
    assert off[sound].max() < 0.01 and np.quantile(off[sound], 0.95) < 0.0025 and np.median(off[sound]) < 0.0005
    assert 0.03 < len(crossing) / len(off) < 0.13
    assert off.max() < 0.02, "also those that cross a seam continue an island"


def test_an_island_s_map_is_continuous_where_there_is_no_seam():
    work, source, target = spheres()
    points = source[0][source[1]].reshape(-1, 3)[:, :2]
    found, crossing = work.of_uv(points)
    assert not len(crossing)
    at_vertices = work.of_vertices(source[0][:, :2])
    assert np.abs(found - at_vertices[target[1]].reshape(-1, 2)).max() < 1e-5


def test_displacements_turn_with_the_surface_and_grow_with_it():
    vertices, triangles = icosphere(3)
    turn = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    picked = far_apart(vertices, triangles, 3)
    work = between((vertices, triangles), (2.5 * vertices @ turn.T, triangles), picked, picked, "333")
    moved = np.random.default_rng(6).normal(size=vertices.shape)
    assert np.abs(work.of_displacements(moved) - 2.5 * moved @ turn.T).max() < 1e-6


def test_values_of_the_nearest_corner():
    vertices, triangles = icosphere(2)
    fine = subdivided(vertices, triangles)
    picked = far_apart(vertices, triangles, 3)
    work = between((vertices, triangles), fine, picked, picked, "333")
    numbers = np.arange(len(vertices))[:, None]
    near = work.nearest_of_vertices(numbers)
    assert np.array_equal(near[picked, 0], picked) and set(near[:, 0].tolist()) <= set(range(len(vertices)))
    assert np.linalg.norm(vertices[near[:, 0]] - fine[0], axis=1).max() < 0.5


def test_the_orbifold_for_so_many_landmarks():
    chosen, written = bare("correspondence").orbifold_for, core.format_signature

    def sphere(count):
        return chosen(lambda order: written([order] * count, []))

    def disk(inside, corners):
        return chosen(lambda order: written([order] * inside, [[order] * corners]))

    assert [sphere(count) for count in (0, 1, 2, 3, 4, 5)] == [None, None, None, "333", "2222", "22222"]
    assert [disk(*pair) for pair in ((0, 3), (0, 4), (1, 1), (2, 0), (1, 2), (3, 1))] == [
        "*333", "*2222", "3*3", "22*", "2*22", "222*2"
    ]
    assert disk(0, 2) is None and disk(1, 0) is None
