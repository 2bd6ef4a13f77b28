# SPDX-License-Identifier: GPL-3.0-or-later
"""Orbifold Unwrap and Orbifold Sphere on good meshes."""

import os
import sys
import tempfile

import bpy
import numpy as np

sys.path.insert(0, os.path.dirname(__file__))
from harness import (  # noqa: E402
    blob, click, digest, edit_mode, enable, far_vertices, object_mode, part, picked, quad_blob, run_checks,
    set_cones, user,
)

enable()
core, blender_mesh, faces, charts = part("core"), part("blender_mesh"), part("faces"), part("core.charts")

SIGNATURES = ("442", "333", "632", "2222", "432", "532", "332", "22(5)", "33", "237", "22222", "2222222222")
CHARTS = [(geometry, chart) for geometry, names in core.CHARTS.items() for chart in names]
EXAMPLE = {"euclidean": "442", "spherical": "432", "hyperbolic": "237"}


def computed(obj, signature, cones, weights="conformal", **settings):
    """The same by core itself, with the operators' default weights."""
    arrays = blender_mesh.read_mesh(obj.data)
    return arrays, core.embed(arrays.vertices, arrays.triangles, signature, cones, weights=weights, **settings)


def corner_uv(obj, arrays):
    return blender_mesh.read_uv(obj.data)[arrays.loops]


def orientations(uv):
    p, q, r = uv.astype(np.float64).transpose(1, 0, 2)
    a, b = q - p, r - p
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def seam_pairs(obj):
    mesh = obj.data
    return {tuple(sorted(pair)) for pair in blender_mesh.read_edges(mesh)[blender_mesh.read_seams(mesh)].tolist()}


def check_picked_in_edit_mode_and_unwrapped_there():
    obj = blob()
    edit_mode()
    click(far_vertices(obj, 3))
    bpy.ops.mesh.orbifold_add_cones()
    obj.data.orbifold.signature = "632"
    assert bpy.ops.uv.orbifold_unwrap() == {"FINISHED"} and obj.mode == "EDIT"
    object_mode()
    arrays, result = computed(obj, "632", [vertex for vertex, _ in picked(obj)])
    assert np.array_equal(corner_uv(obj, arrays), result.uv.astype(np.float32))


def check_every_signature_gives_the_uv_of_core():
    for signature in SIGNATURES:
        obj = blob(4)
        cones = set_cones(obj, signature)
        assert bpy.ops.uv.orbifold_unwrap() == {"FINISHED"}, signature
        arrays, result = computed(obj, signature, cones)
        assert np.array_equal(corner_uv(obj, arrays), result.uv.astype(np.float32)), signature
        assert seam_pairs(obj) == {tuple(sorted(pair)) for pair in result.seams.tolist()}, signature


def check_every_layout_and_kind_of_weights():
    for geometry, chart in CHARTS:
        for weights in ("cotan", "mean-value", "uniform", "conformal", "delaunay"):
            obj = blob()
            cones = set_cones(obj, EXAMPLE[geometry])
            bpy.ops.uv.orbifold_unwrap(weights=weights, **{f"chart_{geometry}": chart})
            arrays, result = computed(obj, EXAMPLE[geometry], cones, weights=weights)
            assert np.array_equal(corner_uv(obj, arrays), result.uv_chart(chart).astype(np.float32)), (chart, weights)


def check_other_uv_maps_stay_and_ours_is_active():
    obj = blob()
    set_cones(obj, "442")
    first = obj.data.uv_layers.new(name="Mine")
    values = np.random.default_rng(1).random(len(obj.data.loops) * 2).astype(np.float32)
    first.data.foreach_set("uv", values)
    for _ in range(2):  # created, then replaced
        bpy.ops.uv.orbifold_unwrap()
        assert [layer.name for layer in obj.data.uv_layers] == ["Mine", "Orbifold"]
        assert obj.data.uv_layers.active.name == "Orbifold"
        assert np.array_equal(blender_mesh.read_uv(obj.data, "Mine").ravel(), values)


def check_quads_and_ngons_are_kept():
    """Every face is laid out in one piece, although the cut may run through it, and no triangle is flipped."""
    through = 0
    for geometry, chart in CHARTS:
        signature = EXAMPLE[geometry]
        obj = quad_blob()
        sizes = sorted({polygon.loop_total for polygon in obj.data.polygons})
        assert sizes == [4, 6], sizes
        cones = set_cones(obj, signature)
        count = len(obj.data.polygons)
        bpy.ops.uv.orbifold_unwrap(sphere_key=False, **{f"chart_{geometry}": chart})
        assert len(obj.data.polygons) == count
        arrays, result = computed(obj, signature, cones)
        uv = corner_uv(obj, arrays)
        assert (orientations(uv) > 0).all(), chart
        layout = faces.layout_of(result, arrays, chart)
        through += layout.mended
        assert np.abs(uv - layout.uv).max() < 2e-7, chart  # so the triangles of a face agree at its corners
        assert seam_pairs(obj) == {tuple(sorted(pair)) for pair in layout.seams.tolist()}, chart
        assert chart == "periodic" or (uv.min() >= 0 and uv.max() <= 1), chart
    assert through > 0, "the cut ran through no face: this check has shown nothing"


def check_mended_faces_are_moved_by_isometries():
    """Where a face was put together, its triangles have kept their shape, and across each edge that is no seam the
    layout is continuous."""
    for signature in SIGNATURES:
        obj = quad_blob()
        cones = set_cones(obj, signature)
        arrays, result = computed(obj, signature, cones)
        chart = core.CHARTS[result.geometry][0]
        layout = faces.layout_of(result, arrays, chart)
        curvature = charts.CURVATURE[result.geometry]

        def lengths(corners):
            side = np.roll(corners, -1, axis=1) - corners
            return side[..., 0] ** 2 + side[..., 1] ** 2 + curvature * side[..., 2] ** 2

        before, after = lengths(result.embedding[result.cut_triangles]), lengths(layout.embedding)
        assert np.allclose(before, after, rtol=1e-9, atol=1e-13), signature
        seams = {tuple(sorted(pair)) for pair in layout.seams.tolist()}
        at = {}
        for triangle, corners in zip(arrays.triangles.tolist(), layout.embedding):
            for s in range(3):
                a, b = triangle[s], triangle[(s + 1) % 3]
                place = np.stack([corners[s], corners[(s + 1) % 3]])
                at.setdefault((min(a, b), max(a, b)), []).append(place if a < b else place[::-1])
        for edge, (one, other) in at.items():
            apart = np.abs(one - other).max() > 1e-9
            assert apart == (edge in seams), (signature, edge)


def check_folds_and_the_date_line_are_seams():
    """Charts with a discontinuity of their own: faces do not cross it, and edges along it are seams as well. (With
    cotangents: the conformal map of two cones near one another draws the faces at the cones half round the sphere.)"""
    cases = [(chart, signature, make) for chart in charts.DISCONTINUOUS for signature in ("22", "33")
             for make in (lambda: blob(4), quad_blob)]
    further = {chart: 0 for chart in charts.DISCONTINUOUS}
    for chart, signature, make in cases:
        obj = make()
        cones = set_cones(obj, signature)
        bpy.ops.uv.orbifold_unwrap(sphere_key=False, chart_spherical=chart, weights="cotan")
        arrays, result = computed(obj, signature, cones, weights="cotan")
        case, uv = (chart, signature, obj.name), blender_mesh.read_uv(obj.data)
        assert np.abs(charts.without_poles(chart, faces.layout_of(result, arrays, chart).uv)
                      - charts.without_poles(chart, corner_uv(obj, arrays))).max() < 1e-6, case
        plain = faces.layout_of(result, arrays, "stereographic")
        assert len(seam_pairs(obj)) >= len(plain.seams), case
        further[chart] += len(seam_pairs(obj)) - len(plain.seams)
        sides = {}
        for polygon in obj.data.polygons:
            own = [tuple(uv[loop]) for loop in polygon.loop_indices]
            at_pole = chart == "equirectangular" and any(abs(p[1] - 0.5) > 0.4 for p in own)  # wide there
            assert at_pole or np.ptp(own, axis=0).max() < 0.3, (case, polygon.index, own)
            around = list(polygon.vertices)
            for a, b, p, q in zip(around, around[1:] + around[:1], own, own[1:] + own[:1]):
                sides.setdefault((min(a, b), max(a, b)), []).append((p, q) if a < b else (q, p))
        seams = seam_pairs(obj)
        for edge, (one, other) in sides.items():
            one, other = (charts.without_poles(chart, np.array(side, float)) for side in (one, other))
            assert np.abs(one - other).max() < 1e-5 or edge in seams, (case, edge, one, other)
    assert all(further.values()), f"no layout has met a fold or the date line: {further}"


def check_seams_are_marked_and_the_users_stay():
    obj = blob()
    cones = set_cones(obj, "442")
    mine = [edge.index for edge in obj.data.edges if cones[0] in edge.vertices][:1] + [5]
    for index in mine:
        obj.data.edges[index].use_seam = True
    pairs = seam_pairs(obj)
    bpy.ops.uv.orbifold_unwrap(mark_seams=False)
    assert seam_pairs(obj) == pairs
    bpy.ops.uv.orbifold_unwrap()
    assert len(seam_pairs(obj)) > len(pairs) and pairs < seam_pairs(obj)
    other = set_cones(obj, "442", far_vertices(obj, 6)[3:])
    bpy.ops.uv.orbifold_unwrap()
    cut = {tuple(sorted(pair)) for pair in computed(obj, "442", other)[1].seams.tolist()}
    assert seam_pairs(obj) == pairs | cut


def check_one_undo_step_in_edit_mode():
    one_undo_step(edit_mode)


def check_one_undo_step_in_object_mode():
    one_undo_step(object_mode)


def one_undo_step(enter):
    obj = blob()
    set_cones(obj, "432")
    before = digest(obj)
    enter()
    bpy.ops.ed.undo_push(message="before")
    user(bpy.ops.uv.orbifold_unwrap, pattern=True)
    object_mode()
    assert digest(bpy.context.object) != before
    if enter is edit_mode:  # leaving edit mode here made no step: the last one is the operator's
        edit_mode()
    bpy.ops.ed.undo()
    object_mode()
    obj = bpy.context.object
    assert "Orbifold" not in obj.data.uv_layers and not seam_pairs(obj)
    assert obj.data.shape_keys is None
    assert [order for _, order in picked(obj)] == [4, 3, 2]


def check_again_with_other_settings():
    """What the redo panel does: undo, then the operator with other settings."""
    obj = blob()
    cones = set_cones(obj, "432")
    bpy.ops.ed.undo_push(message="before")
    user(bpy.ops.uv.orbifold_unwrap)
    bpy.ops.ed.undo()
    user(bpy.ops.uv.orbifold_unwrap, signature="442", chart_euclidean="conformal", mark_seams=False)
    obj = bpy.context.object
    arrays, result = computed(obj, "442", cones)
    assert np.array_equal(corner_uv(obj, arrays), result.uv_chart("conformal").astype(np.float32))
    assert picked(obj) == list(zip(cones, (4, 4, 2))) and obj.data.orbifold.signature == "442"
    assert not seam_pairs(obj) and obj.data.shape_keys is None


def check_sphere_key_is_a_sphere_of_the_objects_size():
    for make in (blob, quad_blob):
        obj = make()
        before = blender_mesh.read_vertices(obj.data)
        set_cones(obj, "432")
        bpy.ops.uv.orbifold_unwrap()
        assert np.array_equal(blender_mesh.read_vertices(obj.data), before)
        key = obj.data.shape_keys.key_blocks["Orbifold Sphere"]
        assert key.value == 0, "the object looks different"
        key.value = 0.5
        bpy.ops.uv.orbifold_unwrap()
        assert obj.data.shape_keys.key_blocks["Orbifold Sphere"].value == 0.5, "the user's value is lost"
        points = blender_mesh.read_shape_key(obj).astype(np.float64)
        a = np.c_[2 * points, np.ones(len(points))]
        centre = np.linalg.lstsq(a, (points**2).sum(1), rcond=None)[0][:3]
        radii = np.linalg.norm(points - centre, axis=1)
        assert np.ptp(radii) < 1e-5 * radii.mean()
        assert 0.7 < radii.mean() < 1.6
        triangles = blender_mesh.read_mesh(obj.data).triangles
        assert (np.linalg.det((points - centre)[triangles]) > 0).all()  # turned out, no flips


def check_sphere_operator_whole_and_split():
    for make in (blob, quad_blob):
        obj = make()
        set_cones(obj, "532")
        assert bpy.ops.object.orbifold_sphere() == {"FINISHED"}
        assert "Orbifold Sphere" in obj.data.shape_keys.key_blocks and len(bpy.data.objects) == 1
        assert "Orbifold" not in obj.data.uv_layers
        obj.shape_key_clear()
        count, polygons = len(obj.data.vertices), len(obj.data.polygons)
        assert bpy.ops.object.orbifold_sphere(target="SPLIT") == {"FINISHED"}
        copy = bpy.context.object
        assert copy is not obj and obj.data.shape_keys is None and len(obj.data.vertices) == count
        assert len(copy.data.vertices) > count and len(copy.data.polygons) == polygons
        points = blender_mesh.read_shape_key(copy).astype(np.float64)
        triangles = blender_mesh.read_mesh(copy.data).triangles
        p, q, r = points[triangles].transpose(1, 0, 2)
        area = np.linalg.norm(np.cross(q - p, r - p), axis=1).sum() / 2
        base = blender_mesh.read_vertices(copy.data)
        p, q, r = base[triangles].transpose(1, 0, 2)
        whole = np.linalg.norm(np.cross(q - p, r - p), axis=1).sum() / 2
        assert abs(area / whole - 1 / 60) < 0.002, area / whole  # a sphere of the mesh's area, one tile of 60


def check_sphere_operator_in_edit_mode():
    obj = blob()
    set_cones(obj, "33")
    edit_mode()
    assert bpy.ops.object.orbifold_sphere() == {"FINISHED"} and obj.mode == "EDIT"
    object_mode()
    assert "Orbifold Sphere" in obj.data.shape_keys.key_blocks


def check_nothing_else_of_the_mesh_changes():
    obj = quad_blob()
    obj.data.attributes.new("mine", "INT", "POINT").data[3].value = 5
    set_cones(obj, "333")
    bpy.ops.uv.orbifold_unwrap(mark_seams=False)
    after = digest(obj)
    obj.data.uv_layers.remove(obj.data.uv_layers["Orbifold"])
    obj.data.attributes.remove(obj.data.attributes["orbifold_path"])  # where the cut runs, for drawing it
    stripped = digest(obj)
    other = quad_blob()
    other.data.attributes.new("mine", "INT", "POINT").data[3].value = 5
    set_cones(other, "333")
    assert digest(other) == stripped != after


def check_transform_and_modifiers_do_not_matter():
    obj = blob()
    cones = set_cones(obj, "442")
    arrays, result = computed(obj, "442", cones)
    obj.scale, obj.location = (2, 3, -1), (5, 0, 0)
    obj.modifiers.new("Subdivision", "SUBSURF")
    bpy.ops.uv.orbifold_unwrap()
    assert np.array_equal(corner_uv(obj, arrays), result.uv.astype(np.float32))


def check_isolated_vertices_are_tolerated():
    obj = blob()
    obj.data.vertices.add(1)
    obj.data.vertices[-1].co = (9, 9, 9)
    obj.data.update()
    set_cones(obj, "432", [0, 20, 50])
    bpy.ops.uv.orbifold_unwrap()
    assert tuple(blender_mesh.read_shape_key(obj)[-1]) == (9, 9, 9)


def check_pattern_is_the_same_on_both_sides_of_every_seam():
    pattern = part("pattern")
    for signature in ("442", "333", "632", "2222", "432", "22", "237", "22222"):
        obj = blob(4)
        cones = set_cones(obj, signature)
        arrays, result = computed(obj, signature, cones)
        curvature = charts.CURVATURE[result.geometry]
        corners = result.embedding[result.cut_triangles]
        chart = charts.chart_of(result.chart, result.geometry, corners, result.uv)
        assert np.abs(chart.to_uv(corners) - result.uv).max() < 1e-9, signature
        assert np.abs(chart.to_point(result.uv.reshape(-1, 2)) - corners.reshape(-1, 3)).max() < 1e-8, signature
        spacing = pattern.ring_spacing(result)
        orbits = pattern.orbits_of(result, faces.plain_layout(result), chart, spacing)
        colours = {}
        for copy in np.flatnonzero(np.isin(result.cut_to_vertex, result.seams)):
            point = result.embedding[copy][None]
            colour = pattern.colour_at(point, orbits, curvature, spacing)[0]
            colours.setdefault(int(result.cut_to_vertex[copy]), []).append(colour)
        several = [np.ptp(same, axis=0).max() for same in colours.values() if len(same) > 1]
        assert len(several) > 5 and max(several) < 5e-3, (signature, max(several))


def check_pattern_material_is_saved_with_the_file():
    obj = blob()
    obj.data.materials.append(bpy.data.materials.new("Own"))
    set_cones(obj, "632")
    bpy.ops.uv.orbifold_unwrap(pattern=True)
    bpy.ops.uv.orbifold_unwrap(pattern=True)
    assert [material.name for material in obj.data.materials] == ["Own", "Orbifold Blob"]
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "saved.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.open_mainfile(filepath=path)
    nodes = bpy.data.materials["Orbifold Blob"].node_tree.nodes
    assert next(n for n in nodes if n.type == "TEX_IMAGE").image.packed_file is not None
    assert next(n for n in nodes if n.type == "UVMAP").uv_map == "Orbifold"
    assert "Orbifold" in bpy.data.objects["Blob"].data.uv_layers


run_checks(globals())
