# SPDX-License-Identifier: GPL-3.0-or-later
"""Suggest Cones, its table, unwrapping with no cones, keeping away, and the predicted stretch."""

import functools
import os
import sys
import tempfile
from types import SimpleNamespace

import bmesh
import bpy
import numpy as np

sys.path.insert(0, os.path.dirname(__file__))
import grids  # noqa: E402
from harness import (  # noqa: E402
    blob, click, digest, edit_mode, enable, mesh_object, object_mode, part, picked, quad_blob, raises,
    run_checks, set_cones, user,
)

enable()
core, blender_mesh, suggestions = part("core"), part("blender_mesh"), part("suggestions")
unwrapping, sidebar = part("unwrapping"), part("panels.sidebar")


def table(obj):
    return obj.data.orbifold.suggestions.rows


def rows(obj):
    """(signature, vertices) of the table."""
    return [(row.signature, [pick.vertex for pick in row.picks()]) for row in table(obj)]


def found_by_core(obj, *arguments, **settings):
    arrays = blender_mesh.read_mesh(obj.data)
    return core.suggest_cones(arrays.vertices, arrays.triangles, *arguments, **settings)


def as_rows(found):
    return [(one.signature, list(one.cones)) for one in found]


def placed(obj):
    return suggestions.placed_row(obj.data)


def place(index):
    return user(bpy.ops.mesh.orbifold_place_suggestion, index=index)


def vertices_of(obj):
    return [vertex for vertex, _ in picked(obj)]


def disk():
    return mesh_object(*grids.disk(n=16), "Disk")


# ------------------------------------------------------------------------------------------------- suggesting


def check_the_table_is_what_core_suggests_in_both_modes():
    for make in (blob, quad_blob):
        for enter in (object_mode, edit_mode):
            obj = make()
            enter()
            assert bpy.ops.mesh.orbifold_suggest_cones() == {"FINISHED"}
            assert (obj.mode == "EDIT") == (enter is edit_mode)
            assert picked(obj) == [] and obj.data.orbifold.signature == "", "suggesting places nothing"
            object_mode()
            found = found_by_core(obj)
            assert rows(obj) == as_rows(found)
            assert np.allclose([row.predicted for row in table(obj)], [one.predicted for one in found])
            assert [row.measured for row in table(obj)] == [one.measured for one in found]
            assert placed(obj) == -1 and not suggestions.is_stale(obj.data)


def check_only_the_mesh_s_signature():
    obj = blob()
    assert "no signature" in raises(bpy.ops.mesh.orbifold_suggest_cones, scope="OWN")
    obj.data.orbifold.signature = "632"
    bpy.ops.mesh.orbifold_suggest_cones(scope="OWN")
    assert rows(obj) == as_rows(found_by_core(obj, "632"))


def check_picked_cones_stay_and_placed_ones_do_not():
    obj = blob()
    set_cones(obj, "22", [30, 100])
    bpy.ops.mesh.orbifold_suggest_cones()
    assert rows(obj) == as_rows(found_by_core(obj, None, [30, 100]))
    kept = rows(obj)
    assert all({30, 100} <= set(vertices) for _, vertices in kept)
    more = next(number for number, (_, vertices) in enumerate(kept) if len(vertices) > 2)
    place(more)
    bpy.ops.mesh.orbifold_suggest_cones()  # the others came from the table
    assert rows(obj) == kept
    bpy.ops.mesh.orbifold_suggest_cones(keep_picked=False)
    assert rows(obj) == as_rows(found_by_core(obj))


def check_only_the_plane():
    obj = blob()
    bpy.ops.mesh.orbifold_suggest_cones(scope="FLAT")
    assert rows(obj) == as_rows(found_by_core(obj, flat=True))
    assert {core.geometry_of(signature) for signature, _ in rows(obj)} == {"euclidean"}


def check_symmetry_can_be_ignored():
    obj = blob()
    bpy.ops.mesh.orbifold_suggest_cones(symmetry="ignore")
    assert rows(obj) == as_rows(found_by_core(obj, symmetry="ignore"))


def check_mirror_corners_on_a_disk():
    obj = disk()
    bpy.ops.mesh.orbifold_suggest_cones()
    found = rows(obj)
    assert found == as_rows(found_by_core(obj)) and all("*" in signature for signature, _ in found)
    border = blender_mesh.boundary_vertices(obj.data)
    for number, (signature, vertices) in enumerate(found):
        place(number)
        assert placed(obj) == number and vertices_of(obj) == vertices and obj.data.orbifold.signature == signature
        assert [item.mirror for item in obj.data.orbifold.cones] == border[vertices].tolist()
        bpy.context.view_layer.update()
        part("handlers").sync_all()
        assert placed(obj) == number, "the list's handlers say something else"
        assert bpy.ops.uv.orbifold_unwrap() == {"FINISHED"}


# --------------------------------------------------------------------------------------------------- the rows


def check_a_click_places_the_cones_in_one_undo_step():
    for enter in (object_mode, edit_mode):
        obj = blob()
        bpy.ops.mesh.orbifold_suggest_cones()
        enter()
        bpy.ops.ed.undo_push(message="suggested")
        wanted = rows(obj)[:2]
        for number, (signature, vertices) in enumerate(wanted):
            place(number)
            obj = bpy.context.object
            assert vertices_of(obj) == vertices and obj.data.orbifold.signature == signature
            assert placed(obj) == number == obj.data.orbifold.suggestions.active
        bpy.ops.ed.undo()
        obj = bpy.context.object
        assert vertices_of(obj) == wanted[0][1] and obj.data.orbifold.signature == wanted[0][0] and placed(obj) == 0
        bpy.ops.ed.undo()
        obj = bpy.context.object
        assert picked(obj) == [] and obj.data.orbifold.signature == "" and placed(obj) == -1, enter
        assert len(table(obj)) > 2 and obj.mode == ("EDIT" if enter is edit_mode else "OBJECT")
        bpy.ops.ed.redo()
        obj = bpy.context.object
        assert vertices_of(obj) == wanted[0][1] and obj.data.orbifold.signature == wanted[0][0] and placed(obj) == 0


def check_cones_that_were_there_come_back():
    for enter in (object_mode, edit_mode):
        obj = blob()
        cones = set_cones(obj, "632")
        bpy.ops.mesh.orbifold_suggest_cones(keep_picked=False)
        enter()
        bpy.ops.ed.undo_push(message="suggested")
        place(0)
        assert vertices_of(bpy.context.object) != cones
        bpy.ops.ed.undo()
        obj = bpy.context.object
        assert picked(obj) == list(zip(cones, (6, 3, 2))) and obj.data.orbifold.signature == "632"


def check_a_cleared_or_typed_signature_stays_over_undo():
    obj = blob()
    bpy.ops.mesh.orbifold_suggest_cones()
    edit_mode()
    place(0)
    user(bpy.ops.mesh.orbifold_clear_cones)
    signature = obj.data.orbifold.signature
    user(bpy.ops.mesh.select_all, action="SELECT")
    bpy.ops.ed.undo()
    assert bpy.context.object.data.orbifold.signature == signature


def check_suggesting_is_one_undo_step():
    obj = blob()
    bpy.ops.ed.undo_push(message="before")
    user(bpy.ops.mesh.orbifold_suggest_cones)
    assert len(table(bpy.context.object))
    bpy.ops.ed.undo()
    assert not len(table(bpy.context.object))
    bpy.ops.ed.redo()
    assert len(table(bpy.context.object))


def check_another_mesh_makes_the_table_stale():
    obj = blob()
    bpy.ops.mesh.orbifold_suggest_cones()
    place(0)
    edit_mode()
    bm = bmesh.from_edit_mesh(obj.data)
    bm.verts.ensure_lookup_table()
    taken = {vertex for _, vertices in rows(obj)[:1] for vertex in vertices}
    bmesh.ops.delete(bm, geom=[bm.verts[next(v for v in range(len(bm.verts)) if v not in taken)]], context="VERTS")
    bmesh.update_edit_mesh(obj.data)
    for enter in (edit_mode, object_mode):
        enter()
        assert suggestions.is_stale(obj.data) and placed(obj) == -1
        assert "Suggest Cones again" in raises(bpy.ops.mesh.orbifold_place_suggestion, index=1)
    bpy.ops.mesh.orbifold_suggest_cones(holes="fill", keep_picked=False)
    assert not suggestions.is_stale(obj.data)


def check_rows_that_are_not_there():
    obj = blob()
    assert "Suggest Cones first" in raises(bpy.ops.mesh.orbifold_place_suggestion, index=0)
    bpy.ops.mesh.orbifold_suggest_cones()
    assert "only" in raises(bpy.ops.mesh.orbifold_place_suggestion, index=len(table(obj)))


def check_the_table_survives_save_and_reload():
    obj = blob()
    obj.vertex_groups.new(name="Face").add([3], 1.0, "REPLACE")
    obj.data.orbifold.keep_away = "Face"
    bpy.ops.mesh.orbifold_suggest_cones()
    place(1)
    before = rows(obj), [row.predicted for row in table(obj)], picked(obj)
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "saved.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.read_factory_settings()
        enable()
        bpy.ops.wm.open_mainfile(filepath=path)
    obj = bpy.data.objects["Blob"]
    assert (rows(obj), [row.predicted for row in table(obj)], picked(obj)) == before
    assert placed(obj) == 1 and not suggestions.is_stale(obj.data)
    assert obj.data.orbifold.keep_away == "Face"
    assert place(0) == {"FINISHED"} and placed(obj) == 0


def check_what_a_row_says():
    obj = blob()
    suggestions.keep(obj.data, [
        core.Suggestion("442", (1, 2, 3), (4, 4, 2), 0.531, 0.5, False, True),
        core.Suggestion("22222", (1, 2, 3, 4, 5), (2,) * 5, 0.4, 0.3, True, False),
    ], [])
    assert [sidebar.table_texts(row) for row in table(obj)] == [("442", "0.53", "3"), ("22222", "~0.40", "5")]
    tips = [bpy.types.MESH_OT_orbifold_place_suggestion.description(bpy.context, SimpleNamespace(index=k))
            for k in (0, 1, 7)]
    assert "symmetric" in tips[0] and "measured" not in tips[0] and "degrees" in tips[0]
    assert "measured" in tips[1] and "symmetric" not in tips[1] and "suggestion" in tips[2]


# ------------------------------------------------------------------------------------------------ one click


def check_unwrap_with_no_cones_takes_the_best_suggestion():
    for make in (blob, quad_blob, disk):
        for enter in (object_mode, edit_mode):
            obj = make()
            best = found_by_core(obj, flat=True)[0]
            enter()
            assert bpy.ops.uv.orbifold_unwrap() == {"FINISHED"} and (obj.mode == "EDIT") == (enter is edit_mode)
            object_mode()
            assert "Orbifold" in obj.data.uv_layers
            assert picked(obj) == list(zip(best.cones, best.orders)) and obj.data.orbifold.signature == best.signature
            assert placed(obj) == 0 and rows(obj) == as_rows(found_by_core(obj, flat=True))
            arrays = blender_mesh.read_mesh(obj.data)
            result = core.embed(arrays.vertices, arrays.triangles, best.signature, best.cones, weights="conformal")
            layout = part("faces").layout_of(result, arrays, result.chart)
            assert np.abs(blender_mesh.read_uv(obj.data)[arrays.loops] - layout.uv).max() < 1e-5


def check_one_click_is_one_undo_step():
    for enter in (object_mode, edit_mode):
        obj = blob()
        before = digest(obj)
        enter()
        bpy.ops.ed.undo_push(message="before")
        user(bpy.ops.uv.orbifold_unwrap)
        object_mode()
        assert "Orbifold" in bpy.context.object.data.uv_layers and len(picked(bpy.context.object)) > 1
        if enter is edit_mode:  # leaving edit mode here made no step
            edit_mode()
        bpy.ops.ed.undo()
        object_mode()
        obj = bpy.context.object
        assert "Orbifold" not in obj.data.uv_layers and picked(obj) == [] and obj.data.orbifold.signature == ""
        assert enter is edit_mode or digest(obj) == before


def check_one_click_again_gives_the_same():
    """What the redo panel does: undo, then the operator with other settings."""
    obj = blob()
    bpy.ops.ed.undo_push(message="before")
    user(bpy.ops.uv.orbifold_unwrap)
    first = picked(bpy.context.object)
    bpy.ops.ed.undo()
    user(bpy.ops.uv.orbifold_unwrap, chart_euclidean="conformal", mark_seams=False)
    assert picked(bpy.context.object) == first
    bpy.ops.ed.undo()
    user(bpy.ops.uv.orbifold_unwrap, flat=False)
    obj = bpy.context.object
    assert vertices_of(obj) == list(found_by_core(obj)[0].cones)


def check_a_signature_that_is_typed_is_kept():
    obj = blob()
    obj.data.orbifold.signature = "632"
    bpy.ops.uv.orbifold_unwrap()
    assert vertices_of(obj) == list(found_by_core(obj, "632")[0].cones)
    assert obj.data.orbifold.signature == "632" and [order for _, order in picked(obj)] == [6, 3, 2]
    obj = blob()
    bpy.ops.uv.orbifold_unwrap(signature="333")
    assert obj.data.orbifold.signature == "333" and vertices_of(obj) == list(found_by_core(obj, "333")[0].cones)


def check_a_single_cone_is_kept():
    for signature in ("", "432"):
        obj = blob()
        obj.data.orbifold.signature = signature
        edit_mode()
        click([77])
        bpy.ops.mesh.orbifold_add_cones()
        bpy.ops.uv.orbifold_unwrap()
        object_mode()
        best = found_by_core(obj, signature or None, [77], flat=True)[0]
        assert 77 in vertices_of(obj) and vertices_of(obj) == list(best.cones)
        assert obj.data.orbifold.signature == best.signature


def check_what_is_missing():
    def missing(obj, typed, vertices=(), holes="refuse"):
        if vertices:
            part("properties").set_cones(obj.data, list(vertices), [None] * len(vertices))
        there = part("cones").read_cones(obj.data)
        found = unwrapping.missing_cones(there, typed, part("surface").read(obj.data), holes)
        return found if found is None else (found.signature, found.fixed)

    assert missing(blob(), "") == (None, []) and missing(disk(), "") == (None, [])
    assert missing(blob(), "432") == ("432", []) and missing(blob(), "44y") is None
    assert missing(blob(), "2", [5]) == (None, [5]) and missing(blob(), "22", [5, 50]) is None
    assert missing(blob(), "4422", [5, 50, 100]) is None, "the panel says what to add"
    torus, annulus = mesh_object(*grids.torus()), None
    assert missing(torus, "") is None and missing(torus, "o2") == ("o2", [])
    annulus = mesh_object(*grids.annulus())
    assert missing(annulus, "") is None and missing(annulus, "", holes="fill") == (None, [])


def check_surfaces_that_need_no_cones_get_none():
    for make, signature in ((grids.torus, "o"), (grids.annulus, "**"), (grids.klein, "xx")):
        obj = mesh_object(*make())
        assert bpy.ops.uv.orbifold_unwrap() == {"FINISHED"}
        assert picked(obj) == [] and obj.data.orbifold.signature == signature and not len(table(obj))


def failing(statuses):
    """core.start_embedding whose job fails with these statuses in turn, and then no more; the signatures it was
    called with."""
    real, asked, left = core.start_embedding, [], list(statuses)

    class Failing(core.EmbeddingJob):
        def __init__(self, job):
            self._job = job

        def finish(self):
            raise core.OrbifoldError(left.pop(0), "it did not work")

    def start(vertices, triangles, signature=None, *arguments, **settings):
        asked.append(signature)
        job = real(vertices, triangles, signature, *arguments, **settings)
        return Failing(job._job) if left else job

    core.start_embedding = start
    return asked, real


def check_where_a_suggestion_fails_the_next_is_tried():
    obj = blob()
    names = [one.signature for one in found_by_core(obj)]
    before = digest(obj)
    unwrap_any = functools.partial(bpy.ops.uv.orbifold_unwrap, flat=False)
    for statuses, tried, ends in (
        (["ORB_CERTIFICATE_FAILED"] * 2, names[:3], True),
        (["ORB_NOT_CONVERGED"] * 9, names[:5], False),
        (["ORB_ZERO_AREA_TRIANGLE"], names[:1], False),
    ):
        asked, real = failing(statuses)
        try:
            if ends:
                assert unwrap_any() == {"FINISHED"}
                assert obj.data.orbifold.signature == names[2] and placed(obj) == 2
            else:
                assert "did not work" in raises(unwrap_any)
                assert digest(obj) == before
        finally:
            core.start_embedding = real
        assert asked == tried, (statuses, asked)
        obj = blob()


# --------------------------------------------------------------------------------------------------- keep away


def check_cones_keep_away_from_a_vertex_group():
    for enter in (object_mode, edit_mode):
        obj = blob()
        points = blender_mesh.read_vertices(obj.data)
        bpy.ops.mesh.orbifold_suggest_cones()
        free = rows(obj)
        there = sorted({vertex for _, vertices in free for vertex in vertices})
        away = np.flatnonzero(np.linalg.norm(points[:, None] - points[there], axis=2).min(1) < 0.4).tolist()
        obj.vertex_groups.new(name="Other").add(list(range(10)), 0.5, "REPLACE")
        group = obj.vertex_groups.new(name="Face")
        group.add(away, 1.0, "REPLACE")
        obj.data.orbifold.keep_away = "Face"
        enter()
        bpy.ops.mesh.orbifold_suggest_cones()
        object_mode()
        assert len(rows(obj)) and rows(obj) != free
        assert not {vertex for _, vertices in rows(obj) for vertex in vertices} & set(away)
        bpy.ops.uv.orbifold_unwrap()
        assert not set(vertices_of(obj)) & set(away)


def check_what_a_weight_costs():
    obj = blob()
    assert suggestions.keep_away(obj) is None
    obj.vertex_groups.new(name="Other").add([1, 2], 1.0, "REPLACE")
    group = obj.vertex_groups.new(name="Face")
    for vertex, weight in ((0, 1.0), (1, 0.5), (2, 0.25)):
        group.add([vertex], weight, "REPLACE")
    obj.data.orbifold.keep_away = "Face"
    weights = suggestions.keep_away(obj)
    assert len(weights) == len(obj.data.vertices) and not weights[3:].any()
    assert weights[0] == np.inf and np.allclose(weights[1:3], (1.0, 1 / 3))


def check_a_group_that_is_not_there():
    obj = blob()
    obj.data.orbifold.keep_away = "Face"
    before = digest(obj)
    for operator in (bpy.ops.mesh.orbifold_suggest_cones, bpy.ops.uv.orbifold_unwrap):
        assert 'no vertex group "Face"' in raises(operator)
        assert digest(obj) == before and not len(table(obj))
    set_cones(obj, "442")
    assert bpy.ops.uv.orbifold_unwrap() == {"FINISHED"}, "where nothing is suggested, the group does not matter"


# ------------------------------------------------------------------------------------------------------ errors


def check_bad_meshes_show_their_culprits():
    for operator in (bpy.ops.mesh.orbifold_suggest_cones, bpy.ops.uv.orbifold_unwrap):
        obj = blob()
        vertices = [list(v.co) for v in obj.data.vertices]
        faces = [list(p.vertices) for p in obj.data.polygons]
        a, b = faces[0][:2]
        obj = mesh_object(vertices + [[3, 3, 3]], faces + [[a, b, len(vertices)]])
        before = digest(obj)
        message = raises(operator)
        assert "edit mode shows it selected" in message, message
        edit_mode()
        bm = bmesh.from_edit_mesh(obj.data)
        chosen = {tuple(sorted(v.index for v in e.verts)) for e in bm.edges if e.select}
        object_mode()
        assert tuple(sorted((a, b))) in chosen and digest(obj) == before and not len(table(obj))


def check_a_typed_signature_of_another_surface():
    obj = disk()
    obj.data.orbifold.signature = "442"
    before = digest(obj)
    cases = ((bpy.ops.uv.orbifold_unwrap, {}), (bpy.ops.mesh.orbifold_suggest_cones, {"scope": "OWN"}))
    for operator, settings in cases:
        raises(operator, **settings)
        assert digest(obj) == before


# ------------------------------------------------------------------------------------------------ the stretch


def attribute(obj, name, field, width):
    values = np.empty(len(obj.data.vertices) * width, np.float32)
    obj.data.attributes[name].data.foreach_get(field, values)
    return values.reshape(-1, width)


def check_stretch_is_core_s_prediction():
    for enter in (object_mode, edit_mode):
        obj = quad_blob()
        mine = obj.data.color_attributes.new("Mine", "BYTE_COLOR", "CORNER")
        mine.data.foreach_set("color", np.full(4 * len(obj.data.loops), 0.25, np.float32))
        own = obj.data.attributes.new("own", "FLOAT", "POINT")
        own.data.foreach_set("value", np.arange(len(obj.data.vertices), dtype=np.float32))
        cones = set_cones(obj, "432")
        for _ in range(2):  # created, then replaced
            enter()
            assert bpy.ops.mesh.orbifold_show_stretch() == {"FINISHED"}
            object_mode()
            arrays = blender_mesh.read_mesh(obj.data)
            scale = core.predict(arrays.vertices, arrays.triangles, "432", cones).scale
            assert np.allclose(attribute(obj, "orbifold_stretch", "value", 1)[:, 0], scale, atol=1e-5)
            colour = attribute(obj, "Orbifold Stretch", "color", 4)
            red, blue = colour[:, 0] - colour[:, 2], scale
            assert (red[scale > 0.05] > 0).all() and (red[scale < -0.05] < 0).all() and (colour[:, 3] == 1).all()
            assert np.abs(colour[np.abs(scale) < 1e-3] - 1).max(initial=0) < 0.01
            assert obj.data.color_attributes.active_color.name == "Orbifold Stretch"
        seen = np.empty(4 * len(obj.data.loops), np.float32)
        obj.data.color_attributes["Mine"].data.foreach_get("color", seen)
        assert np.allclose(seen, 0.25, atol=0.01)
        assert np.array_equal(attribute(obj, "own", "value", 1)[:, 0], np.arange(len(obj.data.vertices)))


def check_stretch_can_be_undone():
    for enter in (object_mode, edit_mode):
        obj = blob()
        set_cones(obj, "442")
        enter()
        bpy.ops.ed.undo_push(message="before")
        user(bpy.ops.mesh.orbifold_show_stretch)
        assert "Orbifold Stretch" in bpy.context.object.data.attributes
        bpy.ops.ed.undo()
        object_mode()
        names = set(bpy.context.object.data.attributes.keys())
        assert not names & {"Orbifold Stretch", "orbifold_stretch"} and len(picked(bpy.context.object)) == 3


def check_stretch_of_mirrors_and_of_suggestions():
    obj = disk()
    bpy.ops.mesh.orbifold_suggest_cones()
    for number in range(len(table(obj))):
        place(number)
        if not table(obj)[number].measured:
            assert bpy.ops.mesh.orbifold_show_stretch() == {"FINISHED"}


def check_stretch_says_what_is_wrong():
    obj = blob()
    assert "Suggest Cones" in raises(bpy.ops.mesh.orbifold_show_stretch)
    set_cones(obj, "442")
    obj.data.orbifold.signature = "4422"
    assert "cone" in raises(bpy.ops.mesh.orbifold_show_stretch)
    obj.data.orbifold.signature = "442"
    obj.data.attributes.new("orbifold_stretch", "INT", "POINT")
    before = digest(obj)
    assert "rename it" in raises(bpy.ops.mesh.orbifold_show_stretch)
    assert digest(obj) == before


run_checks(globals())
