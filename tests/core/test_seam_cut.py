# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces cut along the seams of another mesh's UV maps (addon/seam_cut.py): still one surface, and no face across."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import picks
import pytest
from conway import features
from families import cases, mesh_named
from meshes import far_apart, icosphere
from surfaces import bare, picks_for
from test_correspondence import islands, longitude

import core


@dataclass
class Arrays:
    """As Blender's meshes are read: pairs of triangles may be quads, and more of them larger faces."""

    vertices: np.ndarray
    triangles: np.ndarray
    polygons: np.ndarray
    loops: np.ndarray
    n_loops: int


def arrays_of(mesh, together=1):
    """Of a mesh that was subdivided: 1: triangles, 2: quads beside triangles, 4: the faces before, with six corners."""
    vertices, triangles = mesh
    quarter = len(triangles) // 4
    polygons = np.arange(len(triangles))
    if together == 2:
        polygons[3 * quarter :] -= 3 * quarter
    elif together == 4:
        polygons %= quarter
    corners = polygons[:, None] * len(vertices) + triangles
    _, first, same = np.unique(corners, return_index=True, return_inverse=True)
    loops = np.argsort(np.argsort(first))[same]  # of triangles in their sequence
    return Arrays(vertices, triangles, polygons, loops.reshape(-1, 3), len(first))


def turned(mesh, angle):
    a, b = np.cos(angle), np.sin(angle)
    turn = np.array([[a, -b, 0], [b, a, 0], [0, 0, 1]]) @ [[1, 0, 0], [0, a, -b], [0, b, a]]
    return mesh[0] @ turn.T, mesh[1]


@lru_cache
def between(coarse, fine, together, angle=0.1):
    source, target = icosphere(coarse), turned(icosphere(fine), angle)
    picked = far_apart(*source, 5)
    picked = picked[core.landmark_sequence(*source, picked)]
    landmarks = [int(((target[0] - source[0][v]) ** 2).sum(1).argmin()) for v in picked]
    return work_of(source, target, "22222", picked, landmarks, together)


def work_of(source, target, signature, picked, landmarks, together=1):
    results = [core.embed(*mesh, signature, places, weights="conformal", cut="path")
               for mesh, places in ((source, picked), (target, landmarks))]
    there, back = core.SurfaceMap(results[1], results[0]), core.SurfaceMap(results[0], results[1])
    return bare("correspondence").Correspondence(arrays_of(source), arrays_of(target, together), there, back)


def cut(work, *uv_maps):
    return bare("steps").Steps(bare("seam_cut").cut_along(work, list(uv_maps))).finish()


def vertices_of(work, made):
    corners = work.target.vertices[work.target.triangles[made.triangles]]
    return np.concatenate([work.target.vertices, np.einsum("kc,kcd->kd", made.barycentric, corners)])


def faces_of(work, made):
    """All faces, as lists of vertices: pieces, and those that were left alone."""
    cut_polygons = {piece.polygon for piece in made.pieces}
    outlines = {}
    for polygon, corners in zip(work.target.polygons.tolist(), work.target.triangles.tolist()):
        if polygon not in cut_polygons:
            outlines.setdefault(polygon, []).append(corners)
    whole = []
    for triangles in outlines.values():
        after = {(a, b) for t in triangles for a, b in zip(t, t[1:] + t[:1])}
        after = dict(edge for edge in after if edge[::-1] not in after)
        loop = [next(iter(after))]
        while after[loop[-1]] != loop[0]:
            loop.append(after[loop[-1]])
        whole.append(loop)
    return [piece.vertices for piece in made.pieces], whole


def is_one_closed_surface(faces, characteristic=2):
    directed = [(a, b) for face in faces for a, b in zip(face, face[1:] + face[:1])]
    assert len(set(directed)) == len(directed), "each side of an edge has one face"
    assert {(b, a) for a, b in directed} == set(directed), "no edge is open"
    assert all(len(set(face)) == len(face) >= 3 for face in faces)
    used = {v for face in faces for v in face}
    assert len(used) - len(directed) // 2 + len(faces) == characteristic


def random_seams(mesh, seed):
    """(loops, 2): patches of a few triangles, each moved away from the others; seams branch, end and close up."""
    random = np.random.default_rng(seed)
    at = mesh[0][mesh[1]]
    nearest = (at.mean(1)[:, None] - random.normal(size=(12, 3))) ** 2
    patch = nearest.sum(2).argmin(1)
    return (at[:, :, :2] + 10 * patch[:, None, None]).reshape(-1, 2)


CASES = [(3, 4, 1), (3, 4, 2), (3, 3, 4), (4, 2, 1), (4, 2, 4), (3, 1, 2)]


def pieces_apart(mesh):
    """(loops, 2): each triangle an island."""
    at = mesh[0][mesh[1]]
    return (at[:, :, :2] + 10 * np.arange(len(at))[:, None, None]).reshape(-1, 2)


@pytest.mark.parametrize("coarse, fine, together", CASES)
def test_a_map_that_is_torn_everywhere(coarse, fine, together):
    work, source = between(coarse, fine, together), icosphere(coarse)
    uv = pieces_apart(source)
    made = cut(work, uv)
    pieces, whole = faces_of(work, made)
    is_one_closed_surface(pieces + whole)
    assert not len(made.crossing)
    found = made.corners.mixed(uv[work.source.loops])
    starts = np.cumsum([0, *map(len, pieces)])
    assert max(np.ptp(found[a:b, 0]) for a, b in zip(starts, starts[1:])) < 2.5


@pytest.mark.parametrize("signature", ["o", "*442", "22*", "**"])
def test_other_surfaces_keep_their_topology(signature):
    (_, name), (_, other) = cases([signature])
    topology = features(signature).topology
    source, target = mesh_named(topology, name), mesh_named(topology, other)
    landmarks = picks.picks_for(*target, features(signature), start=0.6)
    work = work_of(source, target, signature, picks_for(source, signature), landmarks)
    made = cut(work, pieces_apart(source))
    pieces, whole = faces_of(work, made)
    before, after = (core.topology_of(triangulated(faces)) for faces in (target[1].tolist(), pieces + whole))
    assert (after.genus, len(after.loops), after.orientable) == (before.genus, len(before.loops), before.orientable)
    assert not len(made.crossing) and after.components == 1


def triangulated(faces):
    return np.array([(face[0], *side) for face in faces for side in zip(face[1:], face[2:])])


def test_several_uv_maps_are_cut_together():
    work, source = between(3, 4, 2), icosphere(3)
    maps = [random_seams(source, seed) for seed in (7, 8)]
    made = cut(work, *maps)
    pieces, whole = faces_of(work, made)
    is_one_closed_surface(pieces + whole)
    starts = np.cumsum([0, *map(len, pieces)])
    for uv in maps:
        found = made.corners.mixed(uv[work.source.loops])
        assert max(np.ptp(found[a:b, 0]) for a, b in zip(starts, starts[1:])) < 2.5


def polygons_of(made):
    return [piece.polygon for piece in made.pieces]


@pytest.mark.parametrize("coarse, fine, together", CASES)
@pytest.mark.parametrize("kind", ["islands", 1, 2])
def test_no_face_is_across_a_seam(coarse, fine, together, kind):
    """Each face has its UVs from one island; islands are as large as the source, and lie 10 apart."""
    work, source = between(coarse, fine, together), icosphere(coarse)
    uv = islands(source, np.array([0.3, 0.2, 1.0])) if kind == "islands" else random_seams(source, kind)
    made = cut(work, uv)
    pieces, whole = faces_of(work, made)
    is_one_closed_surface(pieces + whole)
    assert not len(made.crossing) and made.cut_pieces >= 2 * made.cut_faces > 0
    found = made.corners.mixed(uv[work.source.loops])
    starts = np.cumsum([0, *map(len, pieces)])
    assert max(np.ptp(found[a:b, 0]) for a, b in zip(starts, starts[1:])) < 2.5
    left_alone = work.of_corners(uv)[work.target.loops[~np.isin(work.target.polygons, polygons_of(made))]]
    assert np.ptp(left_alone[:, :, 0], axis=1).max(initial=0.0) < 2.5


def area_by_island(corners, islands, triangles):
    """Signed UV areas of triangles of corners (c, 2)."""
    a, b, c = corners[triangles].swapaxes(0, 1)
    return np.bincount(islands[triangles[:, 0]], np.cross(b - a, c - a) / 2)


@pytest.mark.parametrize("coarse, fine, together", CASES)
def test_islands_have_the_area_that_they_had(coarse, fine, together):
    """They are bounded by the source's seams, to the last digits but for what is snapped, whatever is within."""
    work, source = between(coarse, fine, together), icosphere(coarse)
    uv = random_seams(source, 9)
    made = cut(work, uv)
    alone = ~np.isin(work.target.polygons, polygons_of(made))
    pieces = triangulated_places([piece.vertices for piece in made.pieces])
    corners = np.concatenate([made.corners.mixed(uv[work.source.loops]), work.of_corners(uv)])
    triangles = np.concatenate([pieces, len(made.corners.triangles) + work.target.loops[alone]])
    islands = np.rint(corners[:, 0] / 10).astype(int)
    own = area_by_island(uv, np.rint(uv[:, 0] / 10).astype(int), work.source.loops)
    assert np.abs(area_by_island(corners, islands, triangles) - own).max() < 2e-5 and (own != 0).sum() > 4


def triangulated_places(faces):
    """(t, 3) of the corners of faces, which are counted one face after the other."""
    starts = np.cumsum([0, *map(len, faces)])
    return triangulated([list(range(a, b)) for a, b in zip(starts, starts[1:])])


@pytest.mark.parametrize("fine, together", [(4, 1), (3, 4)])
def test_both_sides_of_a_seam_meet_where_it_is(fine, together):
    """One island, both sides of whose seam are one line on the sphere."""
    work, source = between(3, fine, together), icosphere(3)
    uv = longitude(source)
    made = cut(work, uv)
    pieces, whole = faces_of(work, made)
    is_one_closed_surface(pieces + whole)
    found, points = made.corners.mixed(uv[work.source.loops]), vertices_of(work, made)
    starts = np.cumsum([0, *map(len, pieces)])
    for face, a, b in zip(pieces, starts, starts[1:]):
        if np.linalg.norm(points[face][:, :2], axis=1).min() > 0.35:
            assert np.ptp(found[a:b], axis=0).max() < 4 * np.ptp(points[face], axis=0).max()


@pytest.mark.parametrize("coarse, fine, together", CASES)
def test_corners_are_where_their_vertices_go(coarse, fine, together):
    work, source = between(coarse, fine, together), icosphere(coarse)
    made = cut(work, random_seams(source, 3))
    corners = np.concatenate([piece.vertices for piece in made.pieces])
    spots = work.map.evaluate(made.triangles, made.barycentric)
    goes = np.concatenate([work.images, core.interpolated(work.back.source, source[0], *spots)])
    drawn = made.corners.mixed(source[0][source[1]])
    assert corners.max() >= len(work.target.vertices) and np.abs(drawn - goes[corners]).max() < 1e-5


def test_pieces_have_the_island_that_their_middle_has():
    work, source = between(3, 4, 1), icosphere(3)
    uv = random_seams(source, 4)
    made = cut(work, uv)
    found, points = made.corners.mixed(uv[work.source.loops]), vertices_of(work, made)
    starts = np.cumsum([0, *(len(piece.vertices) for piece in made.pieces)])[:-1]
    plain = [k for k, piece in enumerate(made.pieces) if len(piece.vertices) == 3]  # others may be bent
    polygons = np.array(polygons_of(made))[plain]
    corners = work.target.vertices[work.target.triangles[polygons]]
    middles = points[[made.pieces[k].vertices for k in plain]].mean(1)
    weights = np.linalg.solve(corners.swapaxes(1, 2), middles[:, :, None])[:, :, 0]
    there = bare("correspondence").Spots(*work.map.evaluate(polygons, weights))
    middle = there.mixed(uv[work.source.loops])
    assert len(plain) > 100 and np.array_equal(np.rint(middle[:, 0] / 10), np.rint(found[starts[plain], 0] / 10))


@pytest.mark.parametrize("together", [1, 2, 4])
def test_area_stays_where_it_was(together):
    """Seen from above, where the area of a face is that of its outline, bent or not."""
    work = between(3, 3, together)
    flat = work.target.vertices * [1, 1, 0]
    made = cut(work, random_seams(icosphere(3), 5))
    corners = flat[work.target.triangles]
    points = np.concatenate([flat, np.einsum("kc,kcd->kd", made.barycentric, corners[made.triangles])])
    areas = np.zeros((2, work.target.polygons.max() + 1))
    np.add.at(areas[0], work.target.polygons, np.cross(*np.diff(corners, axis=1).swapaxes(0, 1))[:, 2])
    for piece in made.pieces:
        at = points[piece.vertices]
        areas[1, piece.polygon] += np.cross(at, np.roll(at, -1, 0)).sum(0)[2]
    touched = np.unique(polygons_of(made))
    assert len(touched) > 50 and np.abs(areas[0] - areas[1])[touched].max() < 1e-12


def test_a_mesh_onto_itself_is_not_cut():
    mesh = icosphere(3)
    result = core.embed(*mesh, "442", far_apart(*mesh, 3), cut="path")
    itself = core.SurfaceMap(result, result)
    work = bare("correspondence").Correspondence(arrays_of(mesh), arrays_of(mesh), itself, itself)
    uv = random_seams(mesh, 6)
    made = cut(work, uv)
    assert len(made.triangles) == 0 and made.cut_faces == 0 and len(made.seams) > 100
    wanted = {(t, v): uv[loop] for t, row in enumerate(mesh[1].tolist()) for v, loop in zip(row, work.source.loops[t])}
    found = made.corners.mixed(uv[work.source.loops])
    corners = [(piece.polygon, vertex) for piece in made.pieces for vertex in piece.vertices]
    assert np.abs(found - [wanted[corner] for corner in corners]).max() < 1e-4


def test_no_seam_no_cut():
    work = between(3, 4, 2)
    made = cut(work, work.source.vertices[work.source.triangles].reshape(-1, 3)[:, :2])
    assert not made.pieces and len(made.triangles) == len(made.seams) == len(made.corners.triangles) == 0


def test_a_face_that_cannot_be_cut_is_left_and_said(monkeypatch):
    """Its neighbours' new vertices are on its edges all the same."""
    work = between(3, 3, 2)
    uv = random_seams(icosphere(3), 1)
    wanted = cut(work, uv)
    monkeypatch.setattr(bare("planar"), "faces_of", lambda *_: None)
    made = cut(work, uv)
    pieces, whole = faces_of(work, made)
    directed = {side for face in pieces + whole for side in zip(face, face[1:] + face[:1])}
    assert {side[::-1] for side in directed} == directed
    assert len(made.crossing) >= wanted.cut_faces and not set(made.crossing) - set(polygons_of(wanted))


def test_segments_that_cross_are_no_arrangement():
    planar = bare("planar")
    points = planar.whole(np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [0.5, 0.5, 0], [0, 0.5, 0.5], [0.5, 0, 0.5]]))
    border = [0, 3, 1, 4, 2, 5]
    assert planar.faces_of(points, border, [(0, 4), (1, 5)]) is None
    faces, added = planar.faces_of(points, border, [(3, 4), (4, 5)])
    assert sorted(map(sorted, faces)) == [[0, 3, 4, 5], [1, 3, 4], [2, 4, 5]] and not added
