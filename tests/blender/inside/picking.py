# SPDX-License-Identifier: GPL-3.0-or-later
"""Cones: picking order, the list's buttons, orders and signature, and what they survive."""

import os
import sys
import tempfile

import bmesh
import bpy

sys.path.insert(0, os.path.dirname(__file__))
from harness import (  # noqa: E402
    blob, click, edit_mode, enable, object_mode, part, picked, raises, run_checks, set_cones, user,
)

enable()


def start(vertices=()):
    """A fresh mesh in edit mode with cones at these vertices, and an undo step."""
    obj = blob()
    edit_mode()
    if vertices:
        click(vertices)
        bpy.ops.mesh.orbifold_add_cones()
    bpy.ops.ed.undo_push(message="start")
    return obj


def vertices_of(obj):
    return [vertex for vertex, _ in picked(obj)]


def check_add_keeps_the_picking_order():
    obj = start([50, 7, 100])
    assert vertices_of(obj) == [50, 7, 100]
    assert obj.data.orbifold.signature == "222"


def check_add_appends_and_leaves_out_those_that_are_there():
    obj = start([50, 7])
    click([7, 3, 50, 90])
    bpy.ops.mesh.orbifold_add_cones()
    assert vertices_of(obj) == [50, 7, 3, 90]
    assert bpy.ops.mesh.orbifold_add_cones() == {"CANCELLED"}


def check_vertices_without_a_click_come_last_by_index():
    obj = start()
    click([50, 7])
    bm = bmesh.from_edit_mesh(obj.data)
    bm.verts.ensure_lookup_table()
    bm.verts[99].select = bm.verts[2].select = True
    bpy.ops.mesh.orbifold_add_cones()
    assert vertices_of(obj) == [50, 7, 2, 99]


def check_remove_move_and_clear():
    obj = start([50, 7, 100, 3])
    settings = obj.data.orbifold
    bpy.ops.mesh.orbifold_remove_cone(index=1)
    assert vertices_of(obj) == [50, 100, 3] and settings.signature == "222"
    settings.active_cone = 2
    bpy.ops.mesh.orbifold_move_cone(direction="UP")
    assert vertices_of(obj) == [50, 3, 100] and settings.active_cone == 1
    bpy.ops.mesh.orbifold_move_cone(direction="DOWN")
    assert vertices_of(obj) == [50, 100, 3] and settings.active_cone == 2
    assert bpy.ops.mesh.orbifold_move_cone(direction="DOWN") == {"CANCELLED"}
    bpy.ops.mesh.orbifold_clear_cones()
    assert vertices_of(obj) == []
    assert "add 3" in part("panels.sidebar").signature_state(settings.signature, 0).text


def check_an_order_in_the_list_rewrites_the_signature():
    obj = start([50, 7, 100])
    obj.data.orbifold.cones[1].order = 12
    assert picked(obj) == [(50, 2), (7, 12), (100, 2)]
    assert obj.data.orbifold.signature == "2(12)2"


def check_a_signature_gives_the_cones_their_orders():
    obj = start([50, 7, 100])
    obj.data.orbifold.signature = "632"
    assert picked(obj) == [(50, 6), (7, 3), (100, 2)]
    obj.data.orbifold.signature = "63"  # too short: nothing changes
    assert picked(obj) == [(50, 6), (7, 3), (100, 2)]
    bpy.ops.mesh.orbifold_set_signature(signature="22(12)")
    assert picked(obj) == [(50, 2), (7, 2), (100, 12)]


def check_a_signature_typed_first_is_filled_in_turn():
    obj = start()
    obj.data.orbifold.signature = "432"
    for vertex in (50, 7, 100):
        click([vertex])
        bpy.ops.mesh.orbifold_add_cones()
        assert obj.data.orbifold.signature == "432"
    assert picked(obj) == [(50, 4), (7, 3), (100, 2)]
    click([3])
    bpy.ops.mesh.orbifold_add_cones()
    assert obj.data.orbifold.signature == "4322"


def check_moving_a_cone_takes_its_order_along():
    obj = start([50, 7, 100])
    obj.data.orbifold.signature = "632"
    obj.data.orbifold.active_cone = 0
    bpy.ops.mesh.orbifold_move_cone(direction="DOWN")
    assert picked(obj) == [(7, 3), (50, 6), (100, 2)] and obj.data.orbifold.signature == "362"


def check_the_panel_says_geometry_and_what_is_wrong():
    state = part("panels.sidebar").signature_state
    assert state("442", 3).good and "Euclidean" in state("442", 3).text
    assert state("432", 3).good and "24" in state("432", 3).text
    assert state("237", 3).good and "Hyperbolic" in state("237", 3).text
    for signature, cones in (("", 3), ("44y", 3), ("23", 2), ("441", 3), ("*442", 3), ("442", 2), ("442", 4)):
        assert not state(signature, cones).good, signature
    assert "remove 1" in state("442", 4).text and "add 1" in state("442", 2).text


def check_the_menu_offers_what_fits():
    offers, state = part("panels.menus").fitting, part("panels.sidebar").signature_state
    for count in (2, 3, 4, 5, 9):
        obj = blob()
        part("properties").set_cones(obj.data, list(range(0, 10 * count, 10)), [2] * count)
        assert len(offers(obj.data)) > 4
        assert all(state(offer.signature, count).good for offer in offers(obj.data))


def check_jump_selects_the_vertex_alone():
    obj = start([50, 7, 100])
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.orbifold_jump_to_cone(index=1)
    assert [v.index for v in bmesh.from_edit_mesh(obj.data).verts if v.select] == [7]
    assert obj.data.orbifold.active_cone == 1


def check_undo_and_redo_in_edit_mode():
    obj = start()
    click([50, 7, 100])
    bpy.ops.ed.undo_push(message="click")
    user(bpy.ops.mesh.orbifold_add_cones)
    assert vertices_of(bpy.context.object) == [50, 7, 100]
    bpy.ops.ed.undo()
    assert vertices_of(bpy.context.object) == []
    bpy.ops.ed.redo()
    obj = bpy.context.object
    assert vertices_of(obj) == [50, 7, 100]
    user(bpy.ops.mesh.orbifold_set_signature, signature="432")
    user(bpy.ops.mesh.orbifold_remove_cone, index=0)
    assert picked(bpy.context.object) == [(7, 3), (100, 2)]
    bpy.ops.ed.undo()
    obj = bpy.context.object
    assert picked(obj) == [(50, 4), (7, 3), (100, 2)] and obj.data.orbifold.signature == "432"


def check_undo_in_object_mode():
    obj = start([50, 7, 100])
    object_mode()
    bpy.ops.ed.undo_push(message="object")
    user(bpy.ops.mesh.orbifold_clear_cones)
    assert vertices_of(bpy.context.object) == []
    bpy.ops.ed.undo()
    assert vertices_of(bpy.context.object) == [50, 7, 100]


def check_leaving_edit_mode_keeps_them():
    obj = start([50, 7, 100])
    object_mode()
    assert vertices_of(obj) == [50, 7, 100]
    edit_mode()
    assert vertices_of(obj) == [50, 7, 100]


def check_deleting_other_vertices_shifts_nothing():
    obj = start([50, 7, 100])
    bm = bmesh.from_edit_mesh(obj.data)
    bm.verts.ensure_lookup_table()
    marks = [tuple(bm.verts[i].co) for i in (50, 7, 100)]
    bmesh.ops.delete(bm, geom=[bm.verts[20], bm.verts[60]], context="VERTS")
    bmesh.update_edit_mesh(obj.data)
    bpy.context.view_layer.update()
    bm.verts.ensure_lookup_table()
    assert [tuple(bm.verts[i].co) for i in vertices_of(obj)] == marks
    object_mode()
    assert [tuple(obj.data.vertices[i].co) for i in vertices_of(obj)] == marks


def check_deleting_a_cone_takes_it_off_the_list():
    obj = start([50, 7, 100])
    obj.data.orbifold.signature = "632"
    bm = bmesh.from_edit_mesh(obj.data)
    bm.verts.ensure_lookup_table()
    bmesh.ops.delete(bm, geom=[bm.verts[7]], context="VERTS")
    bmesh.update_edit_mesh(obj.data)
    bpy.context.view_layer.update()
    assert [order for _, order in picked(obj)] == [6, 2] and vertices_of(obj)[0] == 49
    assert obj.data.orbifold.signature == "62"


def check_subdividing_makes_no_cones():
    obj = start([50, 7, 100])
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide(number_cuts=2)
    bpy.context.view_layer.update()
    assert vertices_of(obj) == [50, 7, 100]


def check_duplicating_makes_no_cones():
    obj = start([50, 7, 100])
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.duplicate()
    bpy.context.view_layer.update()
    assert vertices_of(obj) == [50, 7, 100]


def check_save_and_reload():
    obj = start([50, 7, 100])
    obj.data.orbifold.signature = "237"
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "saved.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)  # in edit mode
        bpy.ops.wm.read_factory_settings()
        enable()
        bpy.ops.wm.open_mainfile(filepath=path)
    obj = bpy.data.objects["Blob"]
    assert picked(obj) == [(50, 2), (7, 3), (100, 7)] and obj.data.orbifold.signature == "237"


def check_operators_say_what_is_missing():
    blob()
    assert "edit mode" in raises(bpy.ops.mesh.orbifold_add_cones)
    assert "Add Cones" in raises(bpy.ops.mesh.orbifold_clear_cones)
    assert "at least two cones" in raises(bpy.ops.object.orbifold_sphere)
    set_cones(bpy.context.object, "442")
    assert "spherical one" in raises(bpy.ops.object.orbifold_sphere)
    bpy.ops.object.empty_add()
    assert "mesh object" in raises(bpy.ops.uv.orbifold_unwrap)


run_checks(globals())
