# SPDX-License-Identifier: GPL-3.0-or-later
"""Check Mesh: each kind of defect is counted, selected in edit mode and mended, in one undo step."""

import os
import sys

import bmesh
import bpy
import numpy as np

sys.path.insert(0, os.path.dirname(__file__))
from harness import (  # noqa: E402
    blob, digest, edit_mode, enable, far_vertices, mesh_object, object_mode, part, quad_blob, raises, run_checks,
    set_cones, user,
)

enable()


def arrays_of(obj):
    return [list(v.co) for v in obj.data.vertices], [list(p.vertices) for p in obj.data.polygons]


def rows(obj):
    return {row.kind: row.count for row in obj.data.orbifold.check.rows}


def selected(obj):
    """Vertices, edges (pairs), faces that edit mode shows as selected."""
    edit_mode()
    bm = bmesh.from_edit_mesh(obj.data)
    found = (
        {v.index for v in bm.verts if v.select},
        {tuple(sorted(v.index for v in e.verts)) for e in bm.edges if e.select},
        {f.index for f in bm.faces if f.select},
    )
    object_mode()
    return found


def found_and_mended(obj, kind, count, left=()):
    """The only kind beside those in `left` is found in both modes; shown; mended, and the mend undone in one step."""
    for enter in (edit_mode, object_mode):
        enter()
        assert bpy.ops.mesh.orbifold_check() == {"FINISHED"}
        assert (obj.mode == "EDIT") == (enter is edit_mode)
        assert rows(obj) == {kind: count, **dict(left)}, rows(obj)
    name = obj.name
    assert bpy.ops.mesh.orbifold_show_defect(kind=kind) == {"FINISHED"} and obj.mode == "EDIT"
    shown = selected(obj)
    before = digest(obj)
    bpy.ops.ed.undo_push(message="before")
    assert user(bpy.ops.mesh.orbifold_mend, kind=kind) == {"FINISHED"}
    obj = bpy.data.objects[name]
    assert kind not in rows(obj), rows(obj)
    after = rows(obj)
    bpy.ops.ed.undo()
    obj = bpy.data.objects[name]
    assert digest(obj) == before
    edit_mode()  # the same from edit mode
    assert bpy.ops.mesh.orbifold_mend(kind=kind) == {"FINISHED"} and obj.mode == "EDIT"
    object_mode()
    assert rows(obj) == after
    return shown, after, obj


def check_a_good_mesh():
    for make in (blob, quad_blob):
        obj = make()
        bpy.ops.mesh.orbifold_check()
        assert obj.data.orbifold.check.done and rows(obj) == {}
        assert selected(obj) == (set(), set(), set())


def check_non_manifold_edge():
    vertices, faces = arrays_of(blob())
    a, b = faces[0][:2]
    obj = mesh_object(vertices + [[3, 3, 3]], faces + [[a, b, len(vertices)]])
    (_, edges, _), after, _ = found_and_mended(obj, "edge", 1, {"boundary": 1})
    assert edges == {tuple(sorted((a, b)))}, edges
    assert set(after) <= {"boundary", "pieces", "double"}, after


def check_non_manifold_vertex():
    vertices, faces = arrays_of(blob())
    n = len(vertices)
    other = [[5 - x, y, z] for x, y, z in vertices[1:]]
    shifted = [[0 if v == 0 else v + n - 1 for v in face][::-1] for face in faces]
    shown, after, obj = found_and_mended(mesh_object(vertices + other, faces + shifted), "vertex", 1)
    assert shown[0] == {0} and after == {"pieces": 2}, (shown[0], after)
    assert len(obj.data.vertices) == 2 * n


def check_flipped_faces():
    vertices, faces = arrays_of(quad_blob())
    for face in (3, 30, 31):
        faces[face] = faces[face][::-1]
    (_, _, found), after, _ = found_and_mended(mesh_object(vertices, faces), "flipped", 3)
    assert found == {3, 30, 31} and after == {}, (found, after)


def check_isolated_vertices():
    obj = blob()
    obj.data.vertices.add(2)
    obj.data.update()
    n = len(obj.data.vertices)
    (found, _, _), after, obj = found_and_mended(obj, "isolated", 2)
    assert found == {n - 2, n - 1} and after == {} and len(obj.data.vertices) == n - 2


def check_several_components():
    vertices, faces = arrays_of(blob())
    n, far = len(vertices), [[x + 5, y, z] for x, y, z in vertices]
    obj = mesh_object(vertices + far[:4], faces + [[n, n + 1, n + 2], [n, n + 3, n + 1]], "Two")
    bpy.ops.mesh.orbifold_check()
    assert rows(obj) == {"pieces": 2, "boundary": 1}
    bpy.ops.mesh.orbifold_show_defect(kind="pieces")
    assert selected(obj)[2] == {len(faces), len(faces) + 1}
    bpy.ops.ed.undo_push(message="before")
    user(bpy.ops.mesh.orbifold_mend, kind="pieces")
    assert sorted(len(o.data.polygons) for o in bpy.data.objects) == [2, len(faces)]
    bpy.ops.ed.undo()
    assert len(bpy.data.objects) == 1 and len(bpy.data.objects["Two"].data.polygons) == len(faces) + 2


def check_borders_are_filled():
    vertices, faces = arrays_of(quad_blob())
    hole, other = faces[40], faces[90]
    left = [face for number, face in enumerate(faces) if number not in (40, 90)]
    (_, edges, _), after, obj = found_and_mended(mesh_object(vertices, left), "boundary", 2)
    around = {tuple(sorted((face[s - 1], face[s]))) for face in (hole, other) for s in range(len(face))}
    assert edges == around and after == {} and len(obj.data.polygons) == len(faces)


def check_doubles_on_a_border_are_merged():
    """As after an import that keeps no shared vertices."""
    vertices, faces = arrays_of(blob())
    vertices = [vertices[v] for face in faces for v in face]
    obj = mesh_object(vertices, [[3 * k, 3 * k + 1, 3 * k + 2] for k in range(len(faces))])
    left = {"boundary": len(faces), "pieces": len(faces)}
    _, after, obj = found_and_mended(obj, "double", len(vertices), left)
    assert after == {} and len(obj.data.vertices) == len(faces) // 2 + 2


def check_zero_area_faces():
    vertices, faces = arrays_of(blob())
    a, b = faces[10][0], faces[10][1]
    near = [number for number, face in enumerate(faces) if a in face and b in face]
    vertices[b] = list(vertices[a])
    (_, _, found), after, _ = found_and_mended(mesh_object(vertices, faces), "zero_area", 2)
    assert found >= set(near) and after == {}, (found, near, after)


def check_faces_that_name_a_vertex_twice():
    vertices, faces = arrays_of(blob())
    a, b, c = faces[0]
    obj = mesh_object(vertices, faces + [[a, b, a, c]])
    (_, _, found), after, _ = found_and_mended(obj, "repeated_corner", 1)
    assert len(faces) in found and after == {}, (found, after)


def check_an_edge_from_a_vertex_to_itself_stays_out_of_edit_mode():
    """Where Blender 5.2 hangs. Blender 4 makes no such edge for the face by itself."""
    vertices, faces = arrays_of(blob())
    a, b, _ = faces[0]
    obj = mesh_object(vertices, faces + [[a, b, b]])
    obj.data.edges.add(1)
    obj.data.edges[-1].vertices = (b, b)
    assert "Check Mesh lists it" in raises(bpy.ops.uv.orbifold_unwrap, signature="442")
    assert bpy.ops.mesh.orbifold_check() == {"FINISHED"} and rows(obj) == {"repeated_corner": 1}
    assert bpy.ops.mesh.orbifold_show_defect(kind="repeated_corner") == {"FINISHED"} and obj.mode == "OBJECT"
    assert [face.index for face in obj.data.polygons if face.select] == [len(faces)]
    name, before = obj.name, digest(obj)
    bpy.ops.ed.undo_push(message="before")
    assert user(bpy.ops.mesh.orbifold_mend, kind="repeated_corner") == {"FINISHED"}
    assert rows(bpy.data.objects[name]) == {}
    edit_mode()
    object_mode()
    bpy.ops.ed.undo()
    assert digest(bpy.data.objects[name]) == before


def check_repeated_faces():
    vertices, faces = arrays_of(blob())
    a, b, c = faces[12]
    obj = mesh_object(vertices, faces + [[b, c, a]])
    (_, _, found), after, obj = found_and_mended(obj, "repeated_face", 1)
    assert len(faces) in found and after == {} and len(obj.data.polygons) == len(faces)


def check_coordinates_that_are_no_numbers():
    obj = blob()
    obj.data.vertices[33].co.x = float("nan")
    obj.data.vertices[33].hide = True
    (found, _, _), after, _ = found_and_mended(obj, "not_finite", 1)
    assert found == {33} and after == {"boundary": 1}, (found, after)


def check_what_the_library_alone_sees():
    """Three quads between two poles: each edge has two faces, but the quads' diagonals are one and the same."""
    vertices = [(0, 0, 1), (1, 0, 0), (0, 0, -1), (-1, 1, 0), (-1, -1, 0)]
    obj = mesh_object(vertices, [(0, 1, 2, 3), (0, 3, 2, 4), (0, 4, 2, 1)])
    bpy.ops.mesh.orbifold_check()
    assert set(rows(obj)) == {"other"}, rows(obj)
    assert {0, 2} <= selected(obj)[0] and obj.data.orbifold.check.rows[0].blocks


def check_it_selects_all_of_it_and_a_mended_mesh_unwraps():
    vertices, faces = arrays_of(blob())
    faces[30] = faces[30][::-1]
    obj = mesh_object(vertices + [[9, 9, 9]], faces + [faces[50]])
    bpy.ops.mesh.orbifold_check()
    assert rows(obj) == {"flipped": 1, "repeated_face": 1, "isolated": 1}
    found, _, shown = selected(obj)
    assert len(vertices) in found and {30, len(faces)} <= shown
    for kind in list(rows(obj)):
        bpy.ops.mesh.orbifold_mend(kind=kind)
    assert rows(obj) == {}
    set_cones(obj, "442", far_vertices(obj, 3))
    assert bpy.ops.uv.orbifold_unwrap() == {"FINISHED"}


def check_shape_keys_and_cones_survive_a_mend():
    vertices, faces = arrays_of(blob())
    faces[30] = faces[30][::-1]
    obj = mesh_object(vertices, faces)
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Puffed")
    for point in key.data:
        point.co = point.co * 1.5
    cones = set_cones(obj, "442")
    bpy.ops.mesh.orbifold_check()
    bpy.ops.mesh.orbifold_mend(kind="flipped")
    assert rows(obj) == {}
    key = obj.data.shape_keys.key_blocks["Puffed"]
    assert np.allclose([p.co[:] for p in key.data], 1.5 * np.array(vertices), atol=1e-6)
    assert [cone.vertex for cone in part("cones").read_cones(obj.data)] == cones


def check_poll_messages():
    blob()
    assert "use Check Mesh first" in raises(bpy.ops.mesh.orbifold_mend)
    bpy.ops.mesh.orbifold_check()
    assert "nothing in the list" in raises(bpy.ops.mesh.orbifold_show_defect)  # nothing was found
    bpy.context.view_layer.objects.active = None
    assert "Make a mesh object active" in raises(bpy.ops.mesh.orbifold_check)


def check_all_objects_in_edit_mode():
    one = blob()
    vertices, faces = arrays_of(one)
    mesh = bpy.data.meshes.new("Open")
    mesh.from_pydata(vertices, [], faces[1:])
    other, twin = bpy.data.objects.new("Open", mesh), bpy.data.objects.new("Twin", mesh)
    for obj in (other, twin):
        bpy.context.scene.collection.objects.link(obj)
        obj.select_set(True)
    bpy.ops.object.mode_set(mode="EDIT")
    modes = {obj.name: obj.mode for obj in bpy.data.objects}
    assert sorted(modes.values()) == ["EDIT", "EDIT", "OBJECT"], modes
    bpy.ops.mesh.orbifold_check()
    assert {obj.name: obj.mode for obj in bpy.data.objects} == modes
    assert rows(one) == {} and rows(other) == {"boundary": 1}
    bpy.ops.object.mode_set(mode="OBJECT")


def check_edit_mode_comes_back_as_it_was():
    """An object that is selected but not in edit mode stays out of it, and selected."""
    one = blob()
    edit_mode()
    other = bpy.data.objects.new("Other", bpy.data.meshes.new("Other"))
    bpy.context.scene.collection.objects.link(other)
    other.select_set(True)
    bpy.ops.mesh.orbifold_check()
    assert one.mode == "EDIT" and other.mode == "OBJECT" and other.select_get()
    object_mode()


run_checks(globals())
