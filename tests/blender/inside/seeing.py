# SPDX-License-Identifier: GPL-3.0-or-later
"""What is shown of a layout: the cut's paths, heat maps, the tile's copies, patterns; Orbifold Live."""

import os
import sys
import tempfile
import time

import bmesh
import bpy
import numpy as np

sys.path.insert(0, os.path.dirname(__file__))
from harness import (  # noqa: E402
    blob, edit_mode, empty_scene, enable, far_vertices, object_mode, part, picked, quad_blob, raises, run_checks,
    set_cones, user,
)

enable()
layouts, blender_mesh, live = part("layouts"), part("blender_mesh"), part("live")


def unwrapped(signature="442", obj=None, **settings):
    obj = obj or blob(4)
    set_cones(obj, signature)
    assert bpy.ops.uv.orbifold_unwrap(**settings) == {"FINISHED"}
    return obj


def read(obj):
    arrays = blender_mesh.read_mesh(obj.data)
    return arrays, layouts.read(obj.data, arrays)


def uv_in_edit_mode(obj):
    bm = bmesh.from_edit_mesh(obj.data)
    layer = bm.loops.layers.uv["Orbifold"]
    return np.array([loop[layer].uv[:] for face in bm.faces for loop in face.loops])


def refused(operator, **settings):
    try:
        operator(**settings)
    except RuntimeError as error:
        return str(error)
    return ""


# ------------------------------------------------------------------------------------------- the cut, layouts


def in_turn(edges):
    """The edges of a path one after the other, all in its direction."""
    met = [vertex for edge in edges for vertex in edge]
    at, left, found = next((vertex for vertex in met if met.count(vertex) == 1), met[0]), list(edges), []
    while left:
        edge = next(edge for edge in left if at in edge)
        left.remove(edge)
        found.append((at, sum(edge) - at))
        at = found[-1][1]
    return found


def check_a_path_is_two_sides_that_one_motion_carries_to_one_another():
    for signature, count in (("442", 2), ("2222", 3), ("237", 2), ("22222", None)):
        obj = unwrapped(signature)
        arrays, layout = read(obj)
        indices, edges, paths = layouts.read_cut(obj.data)
        assert count is None or paths.max() + 1 == count, (signature, paths.max())
        places = {}
        for triangle, points in zip(arrays.triangles.tolist(), layout.points):
            for k in range(3):
                places[triangle[k], triangle[k - 2]] = points[k], points[k - 2]
        for path in range(paths.max() + 1):
            rows = [(*places[a, b], *places[b, a][::-1]) for a, b in in_turn(edges[paths == path].tolist())]
            one, other = np.array([row[:2] for row in rows]), np.array([row[2:] for row in rows])
            form = np.array([1.0, 1.0, layout.curvature])
            forms = [(p.reshape(-1, 3) * form) @ p.reshape(-1, 3).T for p in (one, other)]
            if layout.curvature == 0:
                forms = [np.linalg.norm(p.reshape(-1, 1, 3) - p.reshape(-1, 3), axis=-1) for p in (one, other)]
            assert np.allclose(*forms, rtol=1e-3, atol=2e-4), (signature, path, np.abs(forms[0] - forms[1]).max())


def check_the_cut_is_known_without_seams_and_seams_by_hand_stay():
    obj = unwrapped(mark_seams=False)
    cut, _, _ = layouts.read_cut(obj.data)
    assert cut and not any(edge.use_seam for edge in obj.data.edges)
    by_hand = cut[0]
    obj.data.edges[by_hand].use_seam = True
    bpy.context.window_manager.orbifold_live = True
    try:
        for number, mode in enumerate((object_mode, edit_mode)):
            mode()
            part("properties").set_cones(obj.data, far_vertices(obj, 9)[3 * number + 3 :][:3], [4, 4, 2])
            bpy.context.view_layer.update()  # as the window does before it is drawn
            settled()
            object_mode()
            before, (cut, _, _) = cut, layouts.read_cut(obj.data)
            assert cut != before
            assert [edge.index for edge in obj.data.edges if edge.use_seam] == [by_hand]
    finally:
        bpy.context.window_manager.orbifold_live = False
    bpy.ops.uv.orbifold_unwrap()
    cut, _, _ = layouts.read_cut(obj.data)
    assert sorted({*cut, by_hand}) == [edge.index for edge in obj.data.edges if edge.use_seam]


def check_the_layout_is_found_again_after_saving_and_undo():
    obj = unwrapped("442")
    _, before = read(obj)
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "kept.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.open_mainfile(filepath=path)
    obj = bpy.context.view_layer.objects.active
    _, after = read(obj)
    assert after.signature == "442" and np.allclose(after.points, before.points)
    edit_mode()
    bpy.ops.ed.undo_push(message="442")
    obj.data.orbifold.signature = "333"
    user(bpy.ops.uv.orbifold_unwrap)
    object_mode()
    assert read(obj)[1].signature == "333"
    edit_mode()
    while bpy.ops.ed.undo.poll() and bpy.context.object.data.orbifold.signature != "442":
        bpy.ops.ed.undo()
    object_mode()
    assert read(bpy.context.object)[1].signature == "442"


def check_a_mesh_that_has_changed_is_refused():
    obj = blob()
    assert "Orbifold Unwrap first" in refused(bpy.ops.object.orbifold_tile_preview)
    unwrapped("442", obj)
    layer = obj.data.uv_layers["Orbifold"]
    values = np.zeros(2 * len(obj.data.loops), np.float32)
    layer.data.foreach_set("uv", values)
    assert "changed" in refused(bpy.ops.object.orbifold_tile_preview)


# ------------------------------------------------------------------------------------------------ heat maps


def check_angle_and_area_are_those_of_the_report():
    core = part("core")
    for signature in ("442", "432", "237"):
        obj = blob(4)
        cones = set_cones(obj, signature)
        bpy.ops.uv.orbifold_unwrap(weights="cotan")
        arrays, layout = read(obj)
        said = core.embed(arrays.vertices, arrays.triangles, signature, cones, weights="cotan").report["distortion"]
        ratio, area = part("heat").distortion(arrays, layout.points, layout.curvature)
        p, q, r = arrays.vertices[arrays.triangles].transpose(1, 0, 2)
        weight = np.linalg.norm(np.cross(q - p, r - p), axis=1)
        mean = np.average(np.exp(ratio), weights=weight)
        spread = np.sqrt(np.average((area - np.average(area, weights=weight)) ** 2, weights=weight))
        assert abs(mean - said["quasi_conformal_mean"]) < 0.02, (signature, mean, said)
        assert abs(spread - said["log_area_std"]) < 0.03, (signature, spread, said)


def names_of(obj):
    """Of attributes, but for Blender's own ones: what is selected has some, from the first time in edit mode on."""
    return sorted(attribute.name for attribute in obj.data.attributes if not attribute.name.startswith("."))


def check_a_heat_map_leaves_nothing_behind():
    for make in (blob, quad_blob):
        obj = unwrapped("442", make())
        own = obj.data.color_attributes.new("Own", "FLOAT_COLOR", "POINT")
        obj.data.color_attributes.active_color = own
        before = names_of(obj)
        for mode in (object_mode, edit_mode):
            mode()
            for measure in ("ANGLE", "AREA"):
                assert bpy.ops.mesh.orbifold_show_distortion(measure=measure) == {"FINISHED"}
                assert part("heat").shown(obj.data).colour == f"Orbifold {measure.title()}"
            object_mode()
            colours = np.empty(4 * len(obj.data.vertices), np.float32)
            obj.data.attributes["Orbifold Area"].data.foreach_get("color", colours)
            assert colours.reshape(-1, 4)[:, :3].std() > 0.01
            mode()
            assert bpy.ops.mesh.orbifold_hide_distortion() == {"FINISHED"}
            object_mode()
            assert names_of(obj) == before
            assert obj.data.color_attributes.active_color.name == "Own"
        assert not bpy.ops.mesh.orbifold_hide_distortion.poll()


# -------------------------------------------------------------------------------------------- tile preview


def instances_of(preview):
    graph = bpy.context.evaluated_depsgraph_get()
    return [np.array(one.matrix_world) for one in graph.object_instances
            if one.is_instance and one.parent is not None and one.parent.original == preview]


def check_copies_are_instances_and_as_many_as_the_group_says():
    for signature, count in (("442", 36), ("2222", 18), ("333", 54), ("432", 24), ("222", 4), ("22", 2)):
        obj = unwrapped(signature)
        faces = len(obj.data.polygons)
        assert bpy.ops.object.orbifold_tile_preview() == {"FINISHED"}
        preview = part("tile_preview").preview_of(bpy.context, obj)
        assert len(preview.data.polygons) == faces
        found = instances_of(preview)
        assert len(found) == count, (signature, len(found))
        base = np.linalg.inv(np.array(preview.matrix_world))
        local = np.array([base @ matrix for matrix in found])
        assert np.allclose(local[:, :3, :3] @ local[:, :3, :3].transpose(0, 2, 1), np.eye(3), atol=1e-5)


def check_copies_do_not_overlap():
    """Areas in the plane, where copies would lie over one another: 3 x 3 cells are as large as their tiles together."""
    obj = unwrapped("442")
    bpy.ops.object.orbifold_tile_preview()
    _, layout = read(obj)
    middle = layout.points.reshape(-1, 3).mean(0)
    elements = part("tile_copies").copies_of(
        layout.generators, 0, layout.points.reshape(-1, 3), layout.points[:1, 0], layout.euler, layout.to_cells
    )
    at = (elements @ middle) @ layout.to_cells
    assert len(np.unique(np.round(at, 4), axis=0)) == len(elements) == 36
    assert (np.ptp(at, axis=0) < 3).all()


def check_three_rings_fill_the_middle_of_the_disk():
    for signature in ("237", "22222", "2222222"):
        obj = unwrapped(signature)
        bpy.ops.object.orbifold_tile_preview()
        preview = part("tile_preview").preview_of(bpy.context, obj)
        shown = preview.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
        arrays = blender_mesh.read_mesh(shown)
        places = arrays.vertices[arrays.triangles][..., :2]
        assert len(arrays.triangles) > 10 * len(preview.data.polygons)
        assert np.linalg.norm(places, axis=-1).max() < 1.00001
        preview.to_mesh_clear()
        points = np.random.default_rng(1).uniform(-0.5, 0.5, (60, 2))
        one, two = places[:, 1] - places[:, 0], places[:, 2] - places[:, 0]
        area = one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0]
        for point in points:
            step = point - places[:, 0]
            a = (step[:, 0] * two[:, 1] - step[:, 1] * two[:, 0]) / area
            b = (one[:, 0] * step[:, 1] - one[:, 1] * step[:, 0]) / area
            inside = ((a > 1e-4) & (b > 1e-4) & (a + b < 1 - 1e-4)).sum()
            assert inside <= 1, (signature, point, inside)
            assert ((a > -1e-2) & (b > -1e-2) & (a + b < 1 + 1e-2)).any(), (signature, point)


def check_the_preview_is_updated_and_taken_back_in_one_step():
    obj = unwrapped("442")
    bpy.ops.ed.undo_push(message="before")
    user(bpy.ops.object.orbifold_tile_preview)
    preview = part("tile_preview").preview_of(bpy.context, obj)
    preview.location.x += 1
    place = preview.location.copy()
    obj.data.orbifold.signature = "333"
    bpy.ops.uv.orbifold_unwrap()
    meshes = len(bpy.data.meshes)
    bpy.ops.object.orbifold_tile_preview()
    again = part("tile_preview").preview_of(bpy.context, obj)
    assert again == preview and again.location == place and len(bpy.data.meshes) == meshes
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    bpy.ops.ed.undo()
    assert len(bpy.context.scene.objects) == 1


# ------------------------------------------------------------------------------------------------- patterns


def check_patterns_are_as_exact_as_the_group():
    procedural, formulas = part("procedural"), part("formulas")
    fitting = {
        "442": {"CHECKER", "QUADS", "WEAVE"}, "2222": {"CHECKER", "STRIPES", "QUADS", "BRICKS", "WEAVE"},
        "333": {"TRIANGLES", "HEXAGONS"}, "632": {"HEXAGONS"},
    }
    for signature, wanted in fitting.items():
        obj = unwrapped(signature)
        arrays, layout = read(obj)
        kinds = {kind for kind in formulas.PATTERNS if procedural.why_not(kind, layout, layout.to_cells) is None}
        assert wanted <= kinds and (signature == "2222" or kinds == wanted), (signature, kinds)
        sides = {}
        indices, edges, _ = layouts.read_cut(obj.data)
        cut = {tuple(sorted(edge)) for edge in edges.tolist()}
        for triangle, uv in zip(arrays.triangles.tolist(), layout.uv):
            for k in range(3):
                edge = tuple(sorted((triangle[k], triangle[k - 2])))
                if edge in cut:
                    sides.setdefault(edge, []).append((uv[k] + uv[k - 2]) / 2)
        both = np.array([pair for pair in sides.values() if len(pair) == 2])
        assert len(both)
        for kind in kinds:
            lattice = np.column_stack([both.reshape(-1, 2), np.ones(2 * len(both))]) @ layout.lattice
            value = formulas.value_at(formulas.PATTERNS[kind], lattice).reshape(-1, 2)
            sure = np.abs(value).min(1) > 1e-3
            assert (np.sign(value[sure, 0]) == np.sign(value[sure, 1])).all(), (signature, kind)
            assert bpy.ops.object.orbifold_pattern(pattern=kind) == {"FINISHED"}
            assert obj.active_material.name == f"Orbifold {obj.name}"


def check_a_pattern_that_would_show_the_seams_is_refused():
    unwrapped("442")
    assert "Checker" in refused(bpy.ops.object.orbifold_pattern, pattern="TRIANGLES")
    unwrapped("432")
    assert "Rings" in refused(bpy.ops.object.orbifold_pattern, pattern="CHECKER")
    assert bpy.ops.object.orbifold_pattern(pattern="RINGS") == {"FINISHED"}


# ----------------------------------------------------------------------------------------------------- live


def settled():
    """Let the timer do its work; there is no main loop here."""
    while bpy.app.timers.is_registered(live._tick):
        if live._tick() is None and bpy.app.timers.is_registered(live._tick):
            bpy.app.timers.unregister(live._tick)
        time.sleep(0.01)


def with_live(signature="442", obj=None):
    obj = unwrapped(signature, obj)
    edit_mode()
    bpy.context.window_manager.orbifold_live = True
    settled()
    bpy.ops.ed.undo_push(message="start")
    return obj


def check_live_follows_a_cone_an_order_and_the_signature():
    core, sliding = part("core"), part("operators.sliding")
    obj = with_live()
    try:
        before = uv_in_edit_mode(obj)
        target = sliding.neighbours(obj.data, picked(obj)[0][0])[0]
        assert user(bpy.ops.mesh.orbifold_slide_cone, vertex=target) == {"FINISHED"}
        assert picked(obj)[0][0] == target
        settled()
        arrays = blender_mesh.read_mesh(obj.data)
        for _ in range(2):
            cones = [vertex for vertex, _ in picked(obj)]
            signature = obj.data.orbifold.signature
            result = core.embed(arrays.vertices, arrays.triangles, signature, cones, weights="conformal")
            assert np.allclose(uv_in_edit_mode(obj), result.uv.reshape(-1, 2), atol=1e-6)
            assert np.abs(uv_in_edit_mode(obj) - before).max() > 1e-4
            before = uv_in_edit_mode(obj)
            obj.data.orbifold.signature = "632"
            settled()
        bm = bmesh.from_edit_mesh(obj.data)
        seams = {tuple(sorted(v.index for v in edge.verts)) for edge in bm.edges if edge.seam}
        assert seams == {tuple(sorted(edge)) for edge in result.seams.tolist()}
        obj.data.orbifold.cones[0].order = 2
        obj.data.orbifold.cones[1].order = 2
        settled()
        assert live.problem(obj.data) is None and obj.data.orbifold.signature == "222"
        object_mode()
        assert read(obj)[1].signature == "222"
        unwrapped("442", obj)
        assert sum(edge.use_seam for edge in obj.data.edges) == len(layouts.read_cut(obj.data)[0])
    finally:
        bpy.context.window_manager.orbifold_live = False


def check_live_undo_is_one_step_for_each_action():
    sliding = part("operators.sliding")
    obj = with_live()
    try:
        first, before = picked(obj), uv_in_edit_mode(obj)
        user(bpy.ops.mesh.orbifold_slide_cone, vertex=sliding.neighbours(obj.data, first[0][0])[0])
        settled()
        second = picked(obj)
        user(bpy.ops.mesh.orbifold_slide_cone, vertex=sliding.neighbours(obj.data, second[0][0])[0])
        settled()
        bpy.ops.ed.undo()
        obj = bpy.context.object
        assert picked(obj) == second
        bpy.ops.ed.undo()
        obj = bpy.context.object
        assert picked(obj) == first
        settled()
        assert np.allclose(uv_in_edit_mode(obj), before, atol=1e-6)
    finally:
        bpy.context.window_manager.orbifold_live = False


def check_live_says_why_and_keeps_the_last_uvs():
    obj = with_live()
    try:
        before = uv_in_edit_mode(obj)
        for text in ("44", "4z2", ""):
            obj.data.orbifold.signature = text
            settled()
            assert live.problem(obj.data), text
            assert np.array_equal(uv_in_edit_mode(obj), before)
        obj.data.orbifold.signature = "442"
        settled()
        assert live.problem(obj.data) is None
    finally:
        bpy.context.window_manager.orbifold_live = False
    assert live.problem(obj.data) is None and not bpy.app.timers.is_registered(live._tick)


def check_live_sees_edits_of_the_surface():
    core = part("core")
    obj = with_live()
    try:
        bm = bmesh.from_edit_mesh(obj.data)
        for vertex in bm.verts:
            vertex.co.z *= 1.5
        bmesh.update_edit_mesh(obj.data)
        bpy.context.view_layer.update()
        obj.data.orbifold.signature = "333"
        settled()
        obj.update_from_editmode()
        arrays = blender_mesh.read_mesh(obj.data)
        result = core.embed(arrays.vertices, arrays.triangles, "333", [v for v, _ in picked(obj)], weights="conformal")
        assert np.allclose(uv_in_edit_mode(obj), result.uv.reshape(-1, 2), atol=1e-6)
    finally:
        bpy.context.window_manager.orbifold_live = False


def check_live_does_not_wait_for_a_large_mesh_and_can_be_cancelled():
    obj = with_live()
    limit, live.LARGE = live.LARGE, 100
    try:
        before = uv_in_edit_mode(obj)
        obj.data.orbifold.signature = "333"
        assert live.progress(obj.data) is not None and np.array_equal(uv_in_edit_mode(obj), before)
        assert bpy.ops.mesh.orbifold_cancel_live() == {"FINISHED"}
        assert not bpy.ops.mesh.orbifold_cancel_live.poll() and live.progress(obj.data) is None
        settled()
        assert live.problem(obj.data).startswith("Cancelled") and np.array_equal(uv_in_edit_mode(obj), before)
        obj.data.orbifold.signature = "632"
        assert live.progress(obj.data) is not None
        settled()
        assert live.problem(obj.data) is None and np.abs(uv_in_edit_mode(obj) - before).max() > 1e-4
    finally:
        live.LARGE = limit
        bpy.context.window_manager.orbifold_live = False


def check_live_ends_with_the_object_and_the_file():
    obj = with_live()
    obj.data.orbifold.signature = "333"
    object_mode()
    empty_scene()
    bpy.context.view_layer.update()
    settled()
    obj = with_live()
    obj.data.orbifold.signature = "333"
    bpy.ops.wm.read_factory_settings(use_empty=True)
    enable()
    settled()
    assert not bpy.app.timers.is_registered(part("live")._tick)
    bpy.context.window_manager.orbifold_live = False


def check_a_corner_slides_along_its_border_only():
    obj = blob(4)
    bm = bmesh.new()
    bm.from_mesh(obj.data)
    bmesh.ops.delete(bm, geom=[face for face in bm.faces if face.calc_center_median().z > 0.3], context="FACES")
    bm.to_mesh(obj.data)
    bm.free()
    border = part("surface").read(obj.data).loops[0]
    inside = next(v for v in far_vertices(obj, 20) if v not in border)
    part("properties").set_cones(obj.data, [int(border[0]), int(border[1]), inside], [2, 2, 2])
    edit_mode()
    found = part("operators.sliding").neighbours(obj.data, int(border[0]))
    assert found == [int(border[-1])], found
    assert not set(part("operators.sliding").neighbours(obj.data, inside)) & set(border.tolist())
    obj.data.orbifold.active_cone = 0
    assert "neighbour" in raises(bpy.ops.mesh.orbifold_slide_cone, vertex=int(border[1]))
    object_mode()


run_checks(globals())
