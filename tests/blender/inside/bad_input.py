# SPDX-License-Identifier: GPL-3.0-or-later
"""What cannot be unwrapped: one sentence, the culprits selected in edit mode, the mesh as it was."""

import os
import sys

import bmesh
import bpy
import numpy as np

sys.path.insert(0, os.path.dirname(__file__))
from harness import (  # noqa: E402
    blob, digest, edit_mode, enable, far_vertices, mesh_object, object_mode, part, quad_blob, raises, run_checks,
    set_cones,
)

enable()


def arrays_of(obj):
    mesh = obj.data
    return [list(v.co) for v in mesh.vertices], [list(p.vertices) for p in mesh.polygons]


def selected(obj):
    """Selected vertices, edges (vertex pairs), faces as edit mode has them."""
    edit_mode()
    bm = bmesh.from_edit_mesh(obj.data)
    found = (
        {v.index for v in bm.verts if v.select},
        {tuple(sorted(v.index for v in e.verts)) for e in bm.edges if e.select},
        {f.index for f in bm.faces if f.select},
    )
    object_mode()
    return found


def refused(obj, *words, **settings):
    """Unwrap fails in both modes, says all the words in one line, and changes nothing. What it selects."""
    before = digest(obj)
    both = []
    for enter in (object_mode, edit_mode):
        object_mode()
        for elements in (obj.data.vertices, obj.data.edges, obj.data.polygons):
            elements.foreach_set("select", np.zeros(len(elements), bool))
        enter()
        message = raises(bpy.ops.uv.orbifold_unwrap, **settings).strip()
        assert (obj.mode == "EDIT") == (enter is edit_mode)
        sentence = message.removeprefix("Error: ")
        assert "\n" not in sentence and sentence.endswith("."), message
        for word in words:
            assert word.lower() in sentence.lower(), f"{word!r} is not in {message!r}"
        both.append(selected(obj))
        assert digest(obj) == before
    assert both[0] == both[1], both
    return both[0]


def with_cones(obj, signature="442", vertices=None):
    set_cones(obj, signature, vertices)
    return obj


def check_non_manifold_edge():
    vertices, faces = arrays_of(blob())
    a, b = faces[0][:2]
    obj = with_cones(mesh_object(vertices + [[3, 3, 3]], faces + [[a, b, len(vertices)]]), vertices=[5, 50, 100])
    _, edges, _ = refused(obj)
    assert tuple(sorted((a, b))) in edges, edges


def check_non_manifold_vertex():
    vertices, faces = arrays_of(blob())
    n = len(vertices)
    other = [[5 - x, y, z] for x, y, z in vertices[1:]]
    shifted = [[0 if v == 0 else v + n - 1 for v in face][::-1] for face in faces]
    obj = with_cones(mesh_object(vertices + other, faces + shifted), vertices=[5, 50, 100])
    found, _, _ = refused(obj, "vertex")
    assert found == {0}, found


def check_inconsistent_orientation():
    vertices, faces = arrays_of(blob())
    faces[30] = faces[30][::-1]
    _, edges, _ = refused(with_cones(mesh_object(vertices, faces)))
    around = {tuple(sorted((faces[30][s], faces[30][(s + 1) % 3]))) for s in range(3)}
    assert edges == around, (edges, around)


def check_several_components():
    vertices, faces = arrays_of(blob())
    n = len(vertices)
    far = [[x + 5, y, z] for x, y, z in vertices]
    faces += [[v + n for v in face] for face in faces]
    obj = mesh_object(vertices + far, faces)  # which of them is to be unwrapped?
    found, _, _ = refused(obj, "none of them has cones")
    assert len(found) == 2 and min(found) < n <= max(found), found


def check_boundary():
    vertices, faces = arrays_of(blob())
    hole = faces.pop(40)
    _, edges, _ = refused(with_cones(mesh_object(vertices, faces)), "hole")
    assert edges == {tuple(sorted((hole[s], hole[(s + 1) % 3]))) for s in range(3)}, edges


def check_wrong_genus():
    u, v = np.meshgrid(np.arange(16), np.arange(8), indexing="ij")
    a, b = u.ravel() * np.pi / 8, v.ravel() * np.pi / 4
    points = np.stack([(2 + np.cos(b)) * np.cos(a), (2 + np.cos(b)) * np.sin(a), np.sin(b)], 1)
    faces = [[i % 16 * 8 + j % 8 for i, j in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))]
             for i in range(16) for j in range(8)]
    refused(with_cones(mesh_object(points, faces), vertices=[0, 30, 70]), "handle", signature="442")


def check_repeated_triangle():
    vertices, faces = arrays_of(blob())
    obj = with_cones(mesh_object(vertices, faces + [faces[12]]))
    _, _, found = refused(obj)
    assert found and found <= {12, len(faces)}, found


def check_coordinate_that_is_no_number():
    obj = with_cones(blob())
    obj.data.vertices[33].co.x = float("nan")
    found, _, _ = refused(obj, "33")
    assert found == {33}, found


def check_zero_area():
    """Several triangles shrunk to one point."""
    obj = blob()
    centre = 33
    ring = {v for p in obj.data.polygons if centre in p.vertices for v in p.vertices}
    inside = {p.index for p in obj.data.polygons if set(p.vertices) <= ring}
    for vertex in ring:
        obj.data.vertices[vertex].co = obj.data.vertices[centre].co
    free = [v for v in far_vertices(obj, 12) if v not in ring][:3]
    set_cones(obj, "442", free)
    try:
        result = bpy.ops.uv.orbifold_unwrap()
    except RuntimeError:
        _, _, found = refused(obj)
        assert found and found <= inside, (found, inside)
    else:  # tolerated where the weights stay finite
        assert result == {"FINISHED"}
        arrays = part("blender_mesh").read_mesh(obj.data)
        uv = part("blender_mesh").read_uv(obj.data)[arrays.loops].astype(np.float64)
        p, q, r = uv.transpose(1, 0, 2)
        area = (q - p)[:, 0] * (r - p)[:, 1] - (q - p)[:, 1] * (r - p)[:, 0]
        assert np.isfinite(uv).all() and (area > 0).all()


def check_cone_on_a_vertex_without_a_face():
    obj = blob()
    obj.data.vertices.add(1)
    obj.data.update()
    last = len(obj.data.vertices) - 1
    found, _, _ = refused(with_cones(obj, vertices=[5, last, 50]), str(last))
    assert found == {last}, found


def check_signatures_that_are_refused():
    for signature, words in (
        ("44y", ("character 3",)),
        ("4(12", ()),
        ("441", ("1",)),
        ("*442", ()),
        ("4422", ("4", "3")),  # four orders, three cones
        ("44", ("3",)),
        ("o", ()),
    ):
        refused(with_cones(blob()), *words, signature=signature)


def check_no_such_orbifold():
    refused(with_cones(blob(), "22"), signature="23")


def check_quads_show_as_faces():
    obj = quad_blob()
    vertices, faces = arrays_of(obj)
    obj = with_cones(mesh_object(vertices, faces + [faces[12]]))
    _, _, found = refused(obj)
    assert found and found <= {12, len(faces)}, found


def check_hidden_culprits_are_uncovered():
    obj = with_cones(blob())
    obj.data.vertices[33].co.x = float("nan")
    obj.data.vertices[33].hide = True
    found, _, _ = refused(obj)
    assert found == {33}, found


def check_too_many_uv_maps():
    obj = with_cones(blob())
    for number in range(8):
        obj.data.uv_layers.new(name=f"Map {number}")
    refused(obj, "8 UV maps")


def check_a_name_that_is_taken():
    obj = with_cones(blob())
    obj.data.attributes.new("Orbifold", "FLOAT", "POINT")
    refused(obj, "attribute")


def check_sphere_of_a_flat_orbifold():
    obj = with_cones(blob(), "432")
    before = digest(obj)
    assert "not spherical" in raises(bpy.ops.object.orbifold_sphere, signature="442")
    assert digest(obj) == before


def check_errors_in_an_earlier_unwrap_leave_it():
    obj = with_cones(blob(), "432")
    bpy.ops.uv.orbifold_unwrap()
    refused(obj, signature="44y")
    assert "Orbifold" in obj.data.uv_layers


run_checks(globals())
