# SPDX-License-Identifier: GPL-3.0-or-later
"""Orbifold Transfer: what comes over, what is refused, undo; Suggest Order; the panel; the Python API."""

import importlib
import os
import sys
from types import SimpleNamespace

import bmesh
import bpy
import numpy as np

sys.path.insert(0, os.path.dirname(__file__))
import grids  # noqa: E402
from harness import (  # noqa: E402
    blob, digest, enable, far_vertices, mesh_object, module_name, part, picked, quad_blob, raises, run_checks,
    set_cones, user,
)

enable()
api = importlib.import_module(module_name())
core, blender_mesh, transferring = part("core"), part("blender_mesh"), part("transferring")
operators = part("operators.transfer")
FEW = 7


def copy_of(obj, name="Copy", shuffled=True, subdivided=False):
    """The same surface, its vertices and faces in another sequence; with the place of each vertex of `obj` in it."""
    vertices = [v.co[:] for v in obj.data.vertices]
    faces = [list(p.vertices) for p in obj.data.polygons]
    random = np.random.default_rng(4)
    place = random.permutation(len(vertices)) if shuffled else np.arange(len(vertices))
    moved = [None] * len(vertices)
    for old, new in enumerate(place.tolist()):
        moved[new] = vertices[old]
    turn = random.permutation(len(faces)) if shuffled else np.arange(len(faces))
    faces = [[int(place[v]) for v in faces[k]] for k in turn.tolist()]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(moved, [], faces)
    if subdivided:
        bm = bmesh.new()
        bm.from_mesh(mesh)
        bmesh.ops.subdivide_edges(bm, edges=bm.edges[:], cuts=1, use_grid_fill=True)
        bm.to_mesh(mesh)
        bm.free()
    mesh.update()
    new = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(new)
    new.select_set(True)
    return new, place


def pair(make=blob, count=3, **settings):
    """A source with landmarks, active, and its copy with the corresponding ones, selected."""
    source = make()
    target, place = copy_of(source, **settings)
    vertices = far_vertices(source, count)
    sequence = core.landmark_sequence(*mesh_of(source), vertices)
    vertices = [vertices[k] for k in sequence]
    set_cones(source, "2" * count, vertices)
    set_cones(target, "2" * count, place[vertices].tolist())
    return source, target, place


def mesh_of(obj):
    arrays = blender_mesh.read_mesh(obj.data)
    return arrays.vertices, arrays.triangles


def positions(obj):
    return blender_mesh.read_vertices(obj.data)


def filled(obj):
    """Vertex groups, attributes of all types and a UV map, torn along a meridian of longitude, on an object."""
    mesh, points = obj.data, positions(obj)
    for name, weights in (("Up", np.clip(points[:, 2], 0, 1)), ("All", np.ones(len(points)))):
        group = obj.vertex_groups.new(name=name)
        for vertex, weight in enumerate(weights.tolist()):
            if weight:
                group.add([vertex], weight, "REPLACE")
    values = {
        "heights": ("FLOAT", "POINT", points[:, 2:]), "places": ("FLOAT_VECTOR", "POINT", points),
        "count": ("INT", "POINT", np.arange(len(points))[:, None]), "left": ("BOOLEAN", "POINT", points[:, :1] < 0),
        "colour": ("FLOAT_COLOR", "POINT", np.column_stack([abs(points) / 2, np.ones(len(points))])),
    }
    corners = blender_mesh.read_loop_vertices(mesh)
    at = points[corners]
    values["byte"] = ("BYTE_COLOR", "CORNER", np.column_stack([abs(at) / 2, np.ones(len(at))]))
    for name, (kind, domain, rows) in values.items():
        blender_mesh.write_attribute(mesh, name, domain, kind, rows, np.ones(len(rows), bool))
    write_uv(obj, longitude(obj))
    return obj


def longitude(obj):
    """(loops, 2) longitude and height; continuous on each face, that is torn where x < 0 and y = 0."""
    at = positions(obj)[blender_mesh.read_loop_vertices(obj.data)]
    sizes = [polygon.loop_total for polygon in obj.data.polygons]
    face = np.repeat(np.arange(len(sizes)), sizes)
    middle = np.arctan2(*(np.bincount(face, at[:, axis])[face] for axis in (1, 0)))
    angle = middle + (np.arctan2(at[:, 1], at[:, 0]) - middle + np.pi) % (2 * np.pi) - np.pi
    angle /= 2 * np.pi
    return np.column_stack([angle, at[:, 2]])


def write_uv(obj, uv, name="Longitude"):
    blender_mesh.write_uv_of_loops(obj.data, uv, np.ones(len(uv), bool), name)


def at_vertices(obj, name, place=None):
    values = blender_mesh.read_attribute(obj.data, name)
    return values if place is None else values[place]


def reported(operator, **settings):
    """What an operator reports, as (kind, text)."""
    said, cls = [], operators.OBJECT_OT_orbifold_transfer
    real = cls._proceed

    def proceed(self, context):
        work = self

        class Told:
            def __getattr__(self, name):
                return getattr(work, name)

            def __setattr__(self, name, value):
                setattr(work, name, value)

            def report(self, kind, text):
                said.append((next(iter(kind)), text))

        return real(Told(), context)

    cls._proceed = proceed
    try:
        assert operator(**settings) == {"FINISHED"}
    finally:
        cls._proceed = real
    return said[-1]


# --------------------------------------------------------------------------------------------- what comes over


def check_all_of_it_comes_over_to_the_same_surface():
    for make, count in ((blob, 3), (quad_blob, 4), (blob, FEW)):
        source, target, place = pair(make, count)
        filled(source)
        kind, said = reported(bpy.ops.object.orbifold_transfer)
        assert kind == "INFO" and "mean angle distortion 1.000, area spread 0.00" in said, said
        assert [group.name for group in target.vertex_groups] == ["Up", "All"]
        weights = [blender_mesh.read_all_group_weights(obj.data, 2) for obj in (source, target)]
        assert np.abs(weights[1][place] - weights[0]).max() < 1e-4
        for name in ("heights", "places", "count", "left", "colour"):
            assert target.data.attributes[name].data_type == source.data.attributes[name].data_type
            assert np.abs(at_vertices(target, name, place) * 1.0 - at_vertices(source, name)).max() < 1e-4, name
        at = positions(target)[blender_mesh.read_loop_vertices(target.data)]
        assert np.abs(at_vertices(target, "byte")[:, :3] - abs(at) / 2).max() < 0.01  # bytes
        assert np.abs(blender_mesh.read_uv(target.data, "Longitude") - longitude(target)).max() < 1e-4
        assert "orbifold_cone" in target.data.attributes and len(picked(target)) == count, "its own landmarks"


def face_middles(obj):
    middles = np.empty(3 * len(obj.data.polygons), np.float32)
    obj.data.polygons.foreach_get("center", middles)
    return middles.reshape(-1, 3)


def check_attributes_of_faces():
    """On the same surface, on a finer one, and of one component only; those of edges stay."""
    off = dict(groups=False, colours=False, uv_maps=False)
    kinds = {"middles": "FLOAT_VECTOR", "number": "INT", "upper": "BOOLEAN", "height": "FLOAT"}
    for make, settings in ((blob, {}), (quad_blob, {}), (quad_blob, {"shuffled": False, "subdivided": True})):
        source, target, _ = pair(make, 4, **settings)
        middles, edges = face_middles(source), len(source.data.edges)
        numbers = np.arange(len(middles))[:, None]
        rows = {"middles": middles, "number": numbers, "upper": middles[:, 2:] > 0, "height": middles[:, 2:]}
        for name, kind in kinds.items():
            blender_mesh.write_attribute(source.data, name, "FACE", kind, rows[name], np.ones(len(middles), bool))
        blender_mesh.write_attribute(source.data, "of edges", "EDGE", "INT", np.ones((edges, 1)), np.ones(edges, bool))
        bm = bmesh.new()
        bm.from_mesh(target.data)
        bmesh.ops.create_icosphere(bm, subdivisions=1, radius=0.3)  # of 20 faces
        n_faces = len(bm.faces)
        bm.to_mesh(target.data)
        bm.free()
        own = face_middles(target)[: n_faces - 20]
        _, said = reported(bpy.ops.object.orbifold_transfer, **off)
        assert "Copy: 4 attributes; mean" in said, said
        found = {name: at_vertices(target, name) for name in kinds}
        assert all(target.data.attributes[name].domain == "FACE" for name in kinds) and len(found["upper"]) == n_faces
        known = np.linalg.norm(middles[:, None] - own, axis=2).argmin(0)
        right = found["number"][: len(own), 0] == known
        assert right.all() if not settings else right.mean() > 0.9, right.mean()
        for name in kinds:
            expected = rows[name][found["number"][: len(own), 0]]
            assert (found[name][: len(own)] == expected).all() and not found[name][len(own):].any(), name
        assert "of edges" not in target.data.attributes


def check_only_what_is_ticked():
    source, target, _ = pair()
    filled(source)
    _, said = reported(bpy.ops.object.orbifold_transfer, groups=False, attributes=False, uv_maps=False)
    assert "Copy: 2 colours; mean" in said, said
    assert not len(target.vertex_groups) and not len(target.data.uv_layers)
    assert {a.name for a in target.data.color_attributes} == {"colour", "byte"}
    assert "heights" not in target.data.attributes
    assert target.data.shape_keys is None and source.data.shape_keys is None
    assert target.data.color_attributes.active_color is not None, "the viewport shows none otherwise"


def check_a_finer_mesh_gets_what_is_near():
    source, target, _ = pair(shuffled=False, subdivided=True, make=lambda: blob(4), count=5)
    filled(source)
    kind, said = reported(bpy.ops.object.orbifold_transfer)
    assert kind == "WARNING" and "cross a seam" in said, said
    points = positions(target)
    assert np.abs(at_vertices(target, "places") - points).max() < 0.15
    wrong = np.abs(blender_mesh.read_uv(target.data, "Longitude") - longitude(target)).max(1)
    selected = np.array([polygon.select for polygon in target.data.polygons])
    near_axis = np.hypot(*points[blender_mesh.read_loop_vertices(target.data)][:, :2].T) < 0.3
    assert np.median(wrong) < 0.02
    uv = blender_mesh.read_uv(target.data, "Longitude").reshape(-1, 3, 2)
    sound = ~near_axis.reshape(-1, 3).any(1)
    assert np.ptp(uv[sound, :, 0], axis=1).max() < 0.2, "no face is drawn over the whole map"
    assert 0 < selected.sum() < 0.1 * len(selected)


def check_forms_and_shape_keys():
    source, target, place = pair(make=lambda: blob(4), count=5)
    turn = np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))[0]
    turn *= 3 * np.sign(np.linalg.det(turn))
    moved = positions(target) @ turn.T
    target.data.vertices.foreach_set("co", moved.astype(np.float32).ravel())
    target.data.update()
    bump = positions(source) * [1, 1, 1.5] + [0, 0.2, 0]
    blender_mesh.write_shape_key(source, bump, "Tall")
    off = dict(groups=False, attributes=False, colours=False, uv_maps=False)
    bpy.ops.object.orbifold_transfer(form=True, form_back=True, shape_keys=True, **off)
    names = [[key.name for key in obj.data.shape_keys.key_blocks] for obj in (source, target)]
    assert names == [["Basis", "Tall", "Form of Copy"], ["Basis", "Form of Blob", "Tall"]], names
    size = np.ptp(moved)
    assert np.abs(blender_mesh.read_shape_key(target, "Form of Blob")[place] - positions(source)).max() < 1e-4
    assert np.abs(blender_mesh.read_shape_key(source, "Form of Copy") - moved[place]).max() < 1e-4 * size
    assert np.abs(blender_mesh.read_shape_key(target, "Tall")[place] - bump @ turn.T).max() < 1e-4 * size
    assert all(key.value == 0 for obj in (source, target) for key in obj.data.shape_keys.key_blocks[1:])
    assert np.abs(positions(target) - moved).max() < 1e-5 * size


def check_locked_groups_stay():
    source, target, _ = pair()
    filled(source)
    source.vertex_groups["All"].lock_weight = True
    own = target.vertex_groups.new(name="Up")
    own.add([5], 0.25, "REPLACE")
    own.lock_weight = True
    kind, said = reported(bpy.ops.object.orbifold_transfer)
    assert kind == "WARNING" and "Locked vertex groups stay: Up." in said, said
    weights = blender_mesh.read_all_group_weights(target.data, 2)
    assert weights[5, 0] == 0.25 and weights[:, 0].sum() == 0.25
    assert target.vertex_groups["All"].lock_weight and np.allclose(weights[:, 1], 1)


def check_the_component_of_the_landmarks():
    source, target, place = pair()
    filled(source)
    bm = bmesh.new()
    bm.from_mesh(target.data)
    more = bmesh.ops.create_icosphere(bm, subdivisions=1, radius=0.3)["verts"]
    bm.to_mesh(target.data)
    bm.free()
    group = target.vertex_groups.new(name="Up")
    group.add([len(place)], 0.5, "REPLACE")
    bpy.ops.object.orbifold_transfer()
    assert len(target.data.vertices) == len(place) + len(more)
    heights = at_vertices(target, "heights")[:, 0]
    assert np.abs(heights[place] - positions(source)[:, 2]).max() < 1e-4 and (heights[len(place):] == 0).all()
    assert blender_mesh.read_all_group_weights(target.data, 1)[len(place), 0] == 0.5


def check_what_lies_in_a_hole_of_the_source_stays():
    source, target, place = pair()
    landmarks = [vertex for vertex, _ in picked(source)]
    bm = bmesh.new()
    bm.from_mesh(source.data)
    bm.verts.ensure_lookup_table()
    far = next(v for v in bm.verts if not {w.index for e in v.link_edges for w in e.verts} & set(landmarks))
    gone = int(place[far.index])
    bmesh.ops.delete(bm, geom=far.link_faces[:], context="FACES_ONLY")  # the vertex stays, loose
    bm.to_mesh(source.data)
    bm.free()
    assert len(source.data.vertices) == len(place)
    filled(source)
    assert "Blob: the mesh is open" in raises(bpy.ops.object.orbifold_transfer)
    source.data.orbifold.holes = "fill"
    target.vertex_groups.new(name="All").add([gone], 0.125, "REPLACE")
    bpy.ops.object.orbifold_transfer(form=True, form_back=True, shape_keys=True)
    weights = blender_mesh.read_all_group_weights(target.data, 1)[:, 0]
    around = {v for polygon in target.data.polygons if gone in polygon.vertices for v in polygon.vertices}
    others = np.delete(weights, sorted(around))  # the hole is filled with other triangles than there were
    assert weights[gone] == 0.125 and np.allclose(others, 1)
    assert (at_vertices(target, "places")[gone] == 0).all()
    form = blender_mesh.read_shape_key(target, "Form of Blob")
    assert np.abs(form[gone] - positions(target)[gone]).max() < 1e-6 and np.isfinite(form).all()
    assert np.isfinite(blender_mesh.read_uv(target.data, "Longitude")).all()


def check_several_targets_and_the_heat_map():
    source, target, _ = pair()
    other, place = copy_of(source, "Other")
    set_cones(other, "222", place[[vertex for vertex, _ in picked(source)]].tolist())
    filled(source)
    kind, said = reported(bpy.ops.object.orbifold_transfer, heat=True)
    counts = "2 vertex groups, 2 colours, 4 attributes, 1 UV map, 1 heat map; mean angle"
    assert kind == "INFO" and said.count(counts) == 2, said
    for obj in (target, other):
        assert "heights" in obj.data.attributes and part("heat").shown(obj.data).colour == "Orbifold Map"
        assert np.abs(at_vertices(obj, "orbifold_map")).max() < 1e-3
    bpy.context.view_layer.objects.active = target
    assert bpy.ops.mesh.orbifold_hide_distortion() == {"FINISHED"} and "Orbifold Map" not in target.data.attributes


def areas_about(obj, points):
    """(n,) of all triangles around each vertex, where the vertices are at these points."""
    triangles = blender_mesh.read_mesh(obj.data).triangles
    p, q, r = points[triangles].transpose(1, 0, 2)
    return np.bincount(triangles.ravel(), np.repeat(np.linalg.norm(np.cross(q - p, r - p), axis=1), 3))


def check_the_heat_map_of_areas():
    """Compared with the areas about the vertices, on the target and on the form that the map gives it."""
    source, target, place = pair(lambda: blob(4), 5)
    off = dict(groups=False, attributes=False, colours=False, uv_maps=False)
    heat = part("heat")
    for stretch in (3, [3, 3, 12]):
        target.shape_key_clear()
        moved = (positions(source) * stretch)[np.argsort(place)]
        target.data.vertices.foreach_set("co", moved.astype(np.float32).ravel())
        target.data.update()
        bpy.ops.object.orbifold_transfer(heat=True, heat_area=True, form=True, **off)
        assert {"Orbifold Map", "Orbifold Map Area"} <= {one.name for one in target.data.color_attributes}
        assert heat.shown(target.data) is heat.MAP_AREA, "of both the last one is shown"
        form = blender_mesh.read_shape_key(target, "Form of Blob")
        areas = [areas_about(target, points) for points in (positions(target), form)]
        known = np.log(areas[0] / areas[0].sum() * areas[1].sum() / areas[1])
        found = at_vertices(target, "orbifold_map_area")[:, 0]
        assert np.abs(found - known).max() < 0.2 * np.abs(known).max() + 1e-3, np.abs(found - known).max()
        assert (np.abs(known).max() > 0.3) == (stretch != 3), np.abs(known).max()
    bpy.ops.object.orbifold_transfer(heat=True, **off)
    assert heat.shown(target.data) is heat.MAP and "Orbifold Map Area" in target.data.attributes
    bpy.context.view_layer.objects.active = target
    assert bpy.ops.mesh.orbifold_hide_distortion() == {"FINISHED"}
    assert not {"Orbifold Map", "Orbifold Map Area", "orbifold_map_area"} & set(target.data.attributes.keys())


def pictured(obj, size=256):
    """An object with a material that shows an image by its map Longitude: red is the height, green a wave."""
    y, x = (np.mgrid[0:size, 0:size] + 0.5) / size
    pixels = np.stack([y, 0.5 + 0.5 * np.sin(2 * np.pi * x), 0 * x, 1 + 0 * x], 2)
    image = bpy.data.images.new("Waves", size, size, alpha=True, float_buffer=True)
    image.pixels.foreach_set(pixels.astype(np.float32).ravel())
    material = bpy.data.materials.new("Wavy")
    blender_mesh.enable_nodes(material)
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    obj.data.materials.append(material)
    uv = longitude(obj)
    write_uv(obj, np.column_stack([uv[:, 0], 0.5 + 0.25 * uv[:, 1]]))


def check_an_image_is_baked_without_seams():
    source, target, place = pair(lambda: blob(4), 5)
    pictured(source)
    off = dict(groups=False, attributes=False, colours=False)
    assert "no UV map to bake to" in raises(bpy.ops.object.orbifold_transfer, texture=True, uv_maps=False, **off)
    assert bpy.ops.uv.orbifold_unwrap(signature="2" * 5) == {"FINISHED"}  # the source: another map becomes active
    source.data.uv_layers["Longitude"].active_render = True
    bpy.context.view_layer.objects.active = target
    assert bpy.ops.uv.orbifold_unwrap(signature="2" * 5) == {"FINISHED"}
    bpy.context.view_layer.objects.active = source
    assert "would be replaced" in raises(bpy.ops.object.orbifold_transfer, texture=True, **off)
    for _ in range(2):  # the second time in place of the first
        _, said = reported(bpy.ops.object.orbifold_transfer, texture=True, uv_maps=False, **off)
        assert "Copy: 1 image; mean" in said, said
    (material,) = target.data.materials
    node = next(node for node in material.node_tree.nodes if node.type == "TEX_IMAGE")
    assert material.name == "Wavy on Copy" and node.image.name == "Waves on Copy" and node.image.packed_file is not None
    assert node.inputs["Vector"].links[0].from_node.uv_map == "Orbifold"
    assert sorted(image.name for image in bpy.data.images if image.name.startswith("Wav")) == ["Waves", "Waves on Copy"]
    assert all(polygon.material_index == 0 for polygon in target.data.polygons)
    size = node.image.size[0]
    pixels = np.empty(4 * size * size, np.float32)
    node.image.pixels.foreach_get(pixels)
    arrays = blender_mesh.read_mesh(target.data)
    middles = blender_mesh.read_uv(target.data)[arrays.loops].mean(1)
    found = part("baking").sampled(pixels.reshape(size, size, 4), middles)
    at = arrays.vertices[arrays.triangles].mean(1)
    wave = 0.5 + 0.5 * np.sin(np.arctan2(at[:, 1], at[:, 0]))
    round_axis = np.hypot(at[:, 0], at[:, 1]) > 0.2
    off_by = np.abs(np.column_stack([found[:, 0] - 0.5 - 0.25 * at[:, 2], found[:, 1] - wave]))[round_axis].max(1)
    assert np.quantile(off_by, 0.95) < 0.02 and off_by.max() < 0.1, (np.quantile(off_by, 0.95), off_by.max())
    assert source.data.materials[0].name == "Wavy" and len(source.data.materials) == 1
    source.data.materials.clear()
    assert "no image texture" in raises(bpy.ops.object.orbifold_transfer, texture=True, uv_maps=False, **off)


def check_landmarks_that_do_not_correspond_are_warned_of():
    source, target, _ = pair(lambda: blob(4), FEW)
    others = [vertex for vertex, _ in picked(target)]
    others[1], others[4] = others[4], others[1]
    set_cones(target, "2" * FEW, others)
    kind, said = reported(bpy.ops.object.orbifold_transfer)
    assert kind == "WARNING" and "look whether the landmarks correspond" in said, said


# ------------------------------------------------------------------------------------------------- what is refused


def check_unequal_landmarks_are_refused_and_shown():
    source, target, _ = pair()
    set_cones(target, "22")
    before = digest(target)
    said = raises(bpy.ops.object.orbifold_transfer)
    assert "Blob has 3 landmarks and Copy has 2" in said, said
    assert digest(target) == before
    rows = []

    class Row:
        def __init__(self):
            self.alert = False

        def column(self, **_):
            return self

        def row(self, **_):
            rows.append(Row())
            return rows[-1]

        def split(self, **_):
            return self

        def label(self, text="", icon="NONE"):
            self.text = text

    part("panels.transfer").draw_meshes(Row(), source, [target])
    assert [(row.text, row.alert) for row in rows] == [("3 landmarks", False), ("2 landmarks", True)]
    part("cones").write_cones(target.data, [])
    part("cones").write_cones(source.data, [])
    assert "0 landmarks are too few" in raises(bpy.ops.object.orbifold_transfer)


def check_what_fails_leaves_all_as_it_was():
    source, target, place = pair()
    filled(source)
    other, _ = copy_of(source, "Broken")
    set_cones(other, "222", far_vertices(other, 3))
    bm = bmesh.new()
    bm.from_mesh(other.data)
    bm.faces.ensure_lookup_table()
    bm.faces.remove(bm.faces[300])
    bm.to_mesh(other.data)
    bm.free()
    before = [digest(obj) for obj in (source, target, other)]
    said = raises(bpy.ops.object.orbifold_transfer)
    assert "Broken: the mesh is open" in said, said
    assert [digest(obj) for obj in (source, target, other)] == before
    assert sum(edge.select for edge in other.data.edges) == 3, "the hole is selected on the mesh that has it"
    other.select_set(False)
    target.data.attributes.new("heights", "INT", "POINT")
    before = digest(target)
    assert 'Copy: The mesh has another attribute "heights"' in raises(bpy.ops.object.orbifold_transfer)
    assert digest(target) == before
    twin = source.copy()
    bpy.context.scene.collection.objects.link(twin)
    twin.select_set(True)
    target.select_set(False)
    assert "share one mesh" in raises(bpy.ops.object.orbifold_transfer)
    off = {name: False for name in ("groups", "attributes", "colours", "uv_maps")}
    assert "Nothing is ticked" in raises(bpy.ops.object.orbifold_transfer, **off)
    twin.select_set(False)
    assert "Select the meshes that are to get something too" in raises(bpy.ops.object.orbifold_transfer)


def check_a_full_mesh_is_refused_before_the_computation():
    source, target, _ = pair()
    filled(source)
    for number in range(8):
        target.data.uv_layers.new(name=f"Own {number}")
    said = raises(bpy.ops.object.orbifold_transfer)
    assert "UV maps" in said and not len(target.vertex_groups), said


def check_escape_leaves_all_as_it_was():
    """The modal operator's stages, by hand: there is no window."""
    source, target, _ = pair(count=5)
    filled(source)
    before = [digest(obj) for obj in (source, target)]
    cls, said = operators.OBJECT_OT_orbifold_transfer, []
    stub = SimpleNamespace(report=lambda kind, text: said.append(text), bl_label="", _timer=None)
    settings = bpy.context.scene.orbifold_transfer
    wishes = transferring.Wishes(**{name: getattr(settings, name) for name in part("transfer_settings").NAMES})
    stub.wishes = lambda: wishes
    stub._fail = lambda context, error: cls._fail(stub, context, error)
    assert cls._start(stub, bpy.context)
    while not stub._job.poll()[2]:
        pass
    assert cls._proceed(stub, bpy.context) is None, "the second mesh is next"
    stub._job.cancel()
    assert cls._proceed(stub, bpy.context) == {"CANCELLED"} and "cancelled" in said[0], said
    assert [digest(obj) for obj in (source, target)] == before


def check_one_undo_step():
    source, target, _ = pair()
    filled(source)
    bpy.ops.ed.undo_push(message="before")
    before = digest(target)
    assert user(bpy.ops.object.orbifold_transfer, form=True) == {"FINISHED"}
    assert digest(bpy.data.objects["Copy"]) != before
    bpy.ops.ed.undo()
    assert digest(bpy.data.objects["Copy"]) == before and not len(bpy.data.objects["Copy"].vertex_groups)


# ------------------------------------------------------------------------------------------- order, colours, API


def check_suggest_order_is_the_same_for_all():
    source, target, place = pair(count=FEW)
    there = picked(source)
    mixed = [there[k] for k in (3, 0, 5, 1, 6, 4, 2)]
    set_cones(source, "2" * FEW, [vertex for vertex, _ in mixed])
    set_cones(target, "2" * FEW, place[[vertex for vertex, _ in mixed]].tolist())
    bpy.ops.ed.undo_push(message="mixed")
    assert user(bpy.ops.object.orbifold_suggest_order) == {"FINISHED"}
    own, others = ([vertex for vertex, _ in picked(bpy.data.objects[name])] for name in ("Blob", "Copy"))
    assert place[own].tolist() == others
    assert own in ([v for v, _ in there], [v for v, _ in there][::-1]) or own != [v for v, _ in mixed]
    bpy.ops.ed.undo()
    assert picked(bpy.data.objects["Blob"]) == mixed


def check_equal_places_have_equal_colours():
    source, target, place = pair(count=FEW)
    bpy.ops.uv.orbifold_unwrap(signature="2" * FEW)
    overlay = part("overlay")

    def colours(obj):
        (compared, hues) = overlay._compared([source, target])
        assert compared == [source, target]
        return overlay._cone_colours(obj.data, tuple(picked(obj)), hues)

    assert np.allclose(colours(source), colours(target))
    set_cones(source, "2" * FEW, [vertex for vertex, _ in picked(source)][::-1])
    assert np.allclose(colours(source), colours(target)), "those of the list, not of an earlier layout"
    set_cones(target, "2" * 4, [vertex for vertex, _ in picked(target)][:4])
    assert np.allclose(colours(source)[:4], colours(target)), "also while some are missing"
    target.select_set(False)
    assert overlay._compared([source, target]) == ([], 0)


def check_the_api():
    source, target, place = pair()
    filled(source)
    lists = [[vertex for vertex, _ in picked(obj)] for obj in (source, target)]
    for obj in (source, target):
        part("cones").write_cones(obj.data, [])
    report = api.transfer(source, target, landmarks=lists, heat=False)
    (one,) = report["targets"]
    assert report["signature"] == "333" and report["geometry"] == "euclidean" and one["object"] == "Copy"
    assert one["written"]["UV maps"] == ["Longitude"] and one["written"]["vertex groups"] == ["Up", "All"]
    assert one["bijective"] and one["flipped"] == 0 and abs(one["distortion"]["quasi_conformal_mean"] - 1) < 1e-4
    assert one["crossing_faces"] == [] and one["landmark_residual"] < 1e-9
    bpy.ops.object.mode_set(mode="EDIT")
    assert api.transfer(source, [target], landmarks=lists, signature="222")["geometry"] == "spherical"
    bpy.ops.object.mode_set(mode="OBJECT")
    for arguments, said in (
        ((source, [target], lists[:1]), "lists of landmarks for 2 meshes"),
        ((source, [target]), "0 landmarks are too few"),
        ((source, [target], [lists[0], [-1, 0, 1]]), "no vertex -1"), ((source, [None]), "no mesh object"),
    ):
        try:
            api.transfer(*arguments)
        except api.OrbifoldError as error:
            assert said in str(error), error
        else:
            raise AssertionError(said)
    before = digest(target)
    try:
        api.transfer(source, target, landmarks=lists, progress=lambda stage, fraction: False)
    except api.OrbifoldError as error:
        assert error.status == "ORB_CANCELLED"
    assert digest(target) == before


def check_a_disk_with_corners():
    source = mesh_object(*grids.disk(n=16), "Disk")
    target, place = copy_of(source)
    border = np.flatnonzero(blender_mesh.boundary_vertices(source.data)).tolist()
    points = positions(source)
    towards = [np.array([np.cos(angle), np.sin(angle), 0]) for angle in (0.3, 1.9, 3.5, 5.0)]
    corners = [border[int(np.argmax(points[border] @ one))] for one in towards]
    set_cones(source, "*2222", corners)
    set_cones(target, "*2222", place[corners].tolist())
    filled(source)
    kind, said = reported(bpy.ops.object.orbifold_transfer)
    assert kind == "INFO" and "by *2222" in said, said
    assert np.abs(at_vertices(target, "places") - positions(target)).max() < 1e-4
    inside = [v for v in range(len(points)) if v not in border]
    set_cones(target, "2*222", [int(place[inside[0]]), *place[corners[1:]].tolist()])
    said = raises(bpy.ops.object.orbifold_transfer)
    assert "lie differently on borders" in said, said


run_checks(globals())
