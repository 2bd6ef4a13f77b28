# SPDX-License-Identifier: GPL-3.0-or-later
"""Orbifold Transfer with Cut Faces at Seams: what the pieces have, what stays, undo, what is refused."""

import importlib
import os
import sys

import bpy
import numpy as np

sys.path.insert(0, os.path.dirname(__file__))
from harness import (  # noqa: E402
    blob, digest, edit_mode, enable, far_vertices, module_name, object_mode, part, picked, quad_blob, raises,
    run_checks, set_cones, user,
)

enable()
api = importlib.import_module(module_name())
core, blender_mesh = part("core"), part("blender_mesh")
OFF = dict(groups=False, attributes=False, colours=False)
UV = "Islands"


def pair(count=5):
    """Triangles with two islands, active, and about the same surface of quads, selected; with landmarks."""
    other = quad_blob()
    outlines = [list(polygon.vertices) for polygon in other.data.polygons]
    points = blender_mesh.read_vertices(other.data)
    source = blob()
    mesh = bpy.data.meshes.new("Quads")
    mesh.from_pydata(points.tolist(), [], outlines)
    target = bpy.data.objects.new("Quads", mesh)
    bpy.context.scene.collection.objects.link(target)
    target.select_set(True)
    arrays = blender_mesh.read_mesh(source.data)
    vertices = far_vertices(source, count)
    vertices = [vertices[k] for k in core.landmark_sequence(arrays.vertices, arrays.triangles, vertices)]
    set_cones(source, "2" * count, vertices)
    set_cones(target, "2" * count, [int(((points - arrays.vertices[v]) ** 2).sum(1).argmin()) for v in vertices])
    at = arrays.vertices[blender_mesh.read_loop_vertices(source.data)]
    below = np.repeat(at.reshape(-1, 3, 3).mean(1) @ [0.3, 0.2, 1.0] < 0.1, 3)
    write_uv(source, at[:, :2] / 4 + 0.5 + 10 * below[:, None])
    return source, target


def write_uv(obj, uv, name=UV):
    blender_mesh.write_uv_of_loops(obj.data, uv, np.ones(len(uv), bool), name)


def rich(obj):
    """Everything that a mesh may have, as a function of places: it is linear where it can be."""
    mesh = obj.data
    points = blender_mesh.read_vertices(mesh)
    obj.shape_key_add(name="Basis")
    blender_mesh.write_shape_key(obj, 2 * points + 1, "Twice")
    group = obj.vertex_groups.new(name="Heights")
    for vertex, weight in enumerate(((points[:, 2] + 2) / 5).tolist()):
        group.add([vertex], weight, "REPLACE")
    everywhere = np.ones(len(points), bool)
    blender_mesh.write_attribute(mesh, "places", "POINT", "FLOAT_VECTOR", points, everywhere)
    at = points[blender_mesh.read_loop_vertices(mesh)]
    colours = np.column_stack([at / 4 + 0.5, np.ones(len(at))])
    blender_mesh.write_attribute(mesh, "colour", "CORNER", "FLOAT_COLOR", colours, np.ones(len(at), bool))
    write_uv(obj, at[:, :2], "Own")
    mesh.materials.append(bpy.data.materials.new("One"))
    mesh.materials.append(bpy.data.materials.new("Two"))
    for polygon in mesh.polygons:
        polygon.material_index = int(points[list(polygon.vertices)].mean(0)[0] > 0)
        polygon.use_smooth = polygon.index % 2 == 0
    for edge in mesh.edges:
        edge.use_edge_sharp = True


def outlines_of(obj):
    return [list(polygon.vertices) for polygon in obj.data.polygons]


def check_no_face_is_across_a_seam():
    source, target = pair()
    own = outlines_of(target)
    before = blender_mesh.read_vertices(target.data)
    landmarks = picked(target)
    said = api.transfer(source, target, cut_seams=True, **OFF)["targets"][0]
    assert said["crossing_faces"] == [] and said["cut_pieces"] >= 2 * said["cut_faces"] > 20, said
    uv, start = blender_mesh.read_uv(target.data, UV), 0
    for polygon in target.data.polygons:
        assert np.ptp(uv[start : start + polygon.loop_total], axis=0).max() < 1
        start += polygon.loop_total
    assert len(target.data.polygons) == len(own) + said["cut_pieces"] - said["cut_faces"]
    after = blender_mesh.read_vertices(target.data)
    assert np.array_equal(after[: len(before)], before) and len(after) > len(before)
    assert picked(target) == landmarks
    assert not target.data.validate(verbose=False)
    directed = [side for face in outlines_of(target) for side in zip(face, face[1:] + face[:1])]
    assert len(set(directed)) == len(directed) and {side[::-1] for side in directed} == set(directed), "closed"
    assert len(after) - len(directed) // 2 + len(target.data.polygons) == 2
    left_alone = {tuple(face) for face in own} & {tuple(face) for face in outlines_of(target)}
    assert len(left_alone) > 0.5 * len(own)


def check_islands_meet_at_the_cut_and_it_is_a_seam():
    source, target = pair()
    api.transfer(source, target, cut_seams=True, **OFF)
    uv, mesh = blender_mesh.read_uv(target.data, UV), target.data
    islands = {}
    for polygon in mesh.polygons:
        for loop in polygon.loop_indices:
            islands.setdefault(mesh.loops[loop].vertex_index, {})[bool(uv[loop, 1] > 5)] = uv[loop]
    both = {vertex: found for vertex, found in islands.items() if len(found) == 2}
    seams = {vertex for edge in mesh.edges if edge.use_seam for vertex in edge.vertices}
    assert set(both) == seams and len(both) > 30
    apart = np.array([found[True] - found[False] for found in both.values()])
    assert np.abs(apart - 10).max() < 1e-4, "both sides are at one place of the source"


def check_islands_have_the_area_that_they_had():
    source, target = pair()
    api.transfer(source, target, cut_seams=True, **OFF)
    areas = []
    for obj in (source, target):
        arrays, uv = blender_mesh.read_mesh(obj.data), blender_mesh.read_uv(obj.data, UV).astype(float)
        a, b, c = uv[arrays.loops].swapaxes(0, 1)
        areas.append(np.bincount((a[:, 1] > 5).astype(int), np.cross(b - a, c - a) / 2))
    assert np.abs(areas[0] - areas[1]).max() < 1e-5 and np.abs(areas[0]).min() > 0.1, areas


def check_everything_else_survives():
    source, target = pair()
    rich(target)
    areas = area_by_material(target)
    api.transfer(source, target, cut_seams=True, **OFF)
    mesh = target.data
    points = blender_mesh.read_vertices(mesh)
    assert np.abs(blender_mesh.read_shape_key(target, "Twice") - (2 * points + 1)).max() < 1e-5
    assert np.abs(blender_mesh.read_attribute(mesh, "places") - points).max() < 1e-5
    assert np.abs(blender_mesh.read_all_group_weights(mesh, 1)[:, 0] - (points[:, 2] + 2) / 5).max() < 1e-5
    coordinates = np.array([vertex.co[:] for vertex in mesh.vertices])
    assert np.abs(coordinates - points).max() < 1e-6
    at = points[blender_mesh.read_loop_vertices(mesh)]
    assert np.abs(blender_mesh.read_attribute(mesh, "colour")[:, :3] - (at / 4 + 0.5)).max() < 0.02, "faces are bent"
    assert np.abs(blender_mesh.read_uv(mesh, "Own") - at[:, :2]).max() < 0.03
    assert np.allclose(area_by_material(target), areas, rtol=0.02)
    assert [edge.use_edge_sharp for edge in mesh.edges].count(False) < 0.5 * len(mesh.edges)
    assert {polygon.use_smooth for polygon in mesh.polygons} == {True, False}


def area_by_material(obj):
    return [sum(p.area for p in obj.data.polygons if p.material_index == k and p.use_smooth) for k in range(2)]


def check_a_surface_that_is_the_same_has_the_same_islands():
    """The source itself, subdivided: all that is cut is where edges are."""
    source, target = pair()
    bpy.data.objects.remove(target)
    twin = bpy.data.objects.new("Twin", source.data.copy())
    bpy.context.scene.collection.objects.link(twin)
    count = len(twin.data.polygons)
    write_uv(twin, np.zeros((len(twin.data.loops), 2)))
    said = api.transfer(source, twin, cut_seams=True, **OFF)["targets"][0]
    assert said["cut_faces"] == 0 and said["crossing_faces"] == [] and len(twin.data.polygons) == count
    assert np.abs(blender_mesh.read_uv(twin.data, UV) - blender_mesh.read_uv(source.data, UV)).max() < 1e-4


def check_one_undo_step_also_in_edit_mode():
    bpy.context.preferences.edit.use_global_undo = True
    source, target = pair()
    names = source.name, target.name
    rich(target)
    bpy.ops.ed.undo_push(message="Before")
    before = digest(target)
    assert user(bpy.ops.object.orbifold_transfer, cut_seams=True, **OFF) == {"FINISHED"}
    assert digest(bpy.data.objects[names[1]]) != before
    bpy.ops.ed.undo()
    assert digest(bpy.data.objects[names[1]]) == before
    source, target = pair()
    edit_mode()
    api.transfer(source, target, cut_seams=True, **OFF)
    assert source.mode == "EDIT"
    object_mode()
    assert UV in target.data.uv_layers and len(picked(target)) == 5


def check_it_is_off_unless_it_is_ticked():
    source, target = pair()
    own = outlines_of(target)
    said = api.transfer(source, target, **OFF)["targets"][0]
    assert said["crossing_faces"] and said["cut_faces"] == said["cut_pieces"] == 0 and outlines_of(target) == own
    said = api.transfer(source, target, uv_maps=False, cut_seams=True, form=True, **OFF)["targets"][0]
    assert said["cut_faces"] == 0 and outlines_of(target) == own


def check_what_must_not_be_cut_is_refused_before_anything_is_computed():
    source, target = pair()
    before = digest(target)
    other = bpy.data.objects.new("Other", target.data)
    said = raises(bpy.ops.object.orbifold_transfer, cut_seams=True)
    assert "share the mesh of Quads: make it single-user" in said and digest(target) == before, said
    assert bpy.ops.object.orbifold_transfer(cut_seams=True, uv_maps=False) == {"FINISHED"}
    bpy.data.objects.remove(other)
    before = digest(target)
    target.modifiers.new("Levels", "MULTIRES")
    said = raises(bpy.ops.object.orbifold_transfer, cut_seams=True)
    assert "Quads has a Multiresolution modifier" in said and digest(target) == before, said


run_checks(globals())
