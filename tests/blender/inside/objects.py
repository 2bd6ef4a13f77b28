# SPDX-License-Identifier: GPL-3.0-or-later
"""Several objects, meshes in several components, linked duplicates, shape keys and modifiers; the Python API."""

import contextlib
import importlib
import io
import json
import os
import re
import sys
import tempfile
import textwrap
from pathlib import Path

import bmesh
import bpy
import numpy as np

sys.path.insert(0, os.path.dirname(__file__))
from harness import (  # noqa: E402
    blob, digest, edit_mode, empty_scene, enable, far_vertices, mesh_object, module_name, object_mode, part, picked,
    quad_blob, raises, run_checks, set_cones, user,
)

enable()
api = importlib.import_module(module_name())  # as a script imports it
core, blender_mesh, unwrapping = part("core"), part("blender_mesh"), part("unwrapping")


def arrays_of(obj):
    return [list(v.co) for v in obj.data.vertices], [list(p.vertices) for p in obj.data.polygons]


def beside(make, name):
    """Another object in the scene, selected."""
    bm = bmesh.new()
    make(bm)
    mesh = bpy.data.meshes.new(name)
    bm.to_mesh(mesh)
    bm.free()
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(obj)
    obj.select_set(True)
    return obj


def ball(bm):
    bmesh.ops.create_icosphere(bm, subdivisions=3, radius=1.0)


def open_ball(bm):
    ball(bm)
    bm.faces.ensure_lookup_table()
    bm.faces.remove(bm.faces[7])


def two_blobs(half=False):
    """One mesh of two components, of which the second may be a disk; its vertices and faces are the last ones."""
    vertices, faces = arrays_of(blob())
    n = len(vertices)
    kept = [face for face in faces if not half or min(vertices[v][2] for v in face) > 0]
    more = [[v + n for v in face] for face in kept]
    far = [[x + 5, y, z * (1 + 0.1 * y)] for x, y, z in vertices]
    return mesh_object(vertices + far, faces + more, "Two"), n, len(faces)


def reported(function, **settings):
    """What an operator reports, as (kind, text): its class's report is not to be seen from a script."""
    said, cls = [], part("operators.unwrap").UV_OT_orbifold_unwrap
    real = cls._write

    def write(self, context):
        work = self

        class Told:
            def __getattr__(self, name):
                return getattr(work, name)

            def report(self, kind, text):
                said.append((kind, text))
                work.report(kind, text)

        return real(Told(), context)

    cls._write = write
    try:
        assert function(**settings) == {"FINISHED"}
    finally:
        cls._write = real
    return next(iter(said[0][0])), said[0][1]


def expected_uv(obj, signature, cones, triangles=None, **settings):
    arrays = blender_mesh.read_mesh(obj.data)
    chosen = np.arange(len(arrays.triangles)) if triangles is None else triangles
    result = core.embed(arrays.vertices, arrays.triangles[chosen], signature, cones, weights="conformal", **settings)
    return arrays, chosen, result


def has_uv_of(obj, signature, cones, triangles=None):
    arrays, chosen, result = expected_uv(obj, signature, cones, triangles)
    return np.array_equal(blender_mesh.read_uv(obj.data)[arrays.loops[chosen]], result.uv.astype(np.float32))


# ------------------------------------------------------------------------------------------- several objects


def check_every_object_in_edit_mode_with_its_own_cones():
    one = blob()
    first = set_cones(one, "442")
    other = beside(ball, "Ball")
    second = set_cones(other, "2222")
    idle = beside(ball, "Idle")
    idle.select_set(False)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.ed.undo_push(message="before")
    kind, said = reported(lambda: user(bpy.ops.uv.orbifold_unwrap))
    assert kind == "INFO" and "Blob: Orbifold 442" in said and "Ball: Orbifold 2222" in said, said
    assert [one.mode, other.mode, idle.mode] == ["EDIT", "EDIT", "OBJECT"]
    object_mode()
    assert has_uv_of(one, "442", first) and has_uv_of(other, "2222", second) and not len(idle.data.uv_layers)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.ed.undo()
    object_mode()
    assert not any(len(obj.data.uv_layers) for obj in bpy.data.objects), "one undo step for all"


def check_objects_that_fail_are_named_and_stay():
    one = blob()
    set_cones(one, "442")
    other = beside(open_ball, "Open")
    set_cones(other, "333", far_vertices(other, 3))
    before = digest(other)
    for active in (one, other):
        bpy.context.view_layer.objects.active = active
        bpy.ops.object.mode_set(mode="EDIT")
        kind, said = reported(bpy.ops.uv.orbifold_unwrap)
        bpy.ops.object.mode_set(mode="OBJECT")
        assert kind == "WARNING" and said.startswith("Not unwrapped, and as before: Open: "), said
        assert "hole" in said.lower() and "Blob: Orbifold 442" in said
        assert digest(other) == before and "Orbifold" in one.data.uv_layers
        selected = [edge.index for edge in other.data.edges if edge.select]
        assert len(selected) == 3, "the culprits of the one that failed"


def check_where_all_objects_fail():
    one = blob()
    one.data.orbifold.signature = "44y"
    other = beside(open_ball, "Open")
    set_cones(other, "333", far_vertices(other, 3))
    bpy.ops.object.mode_set(mode="EDIT")
    said = raises(bpy.ops.uv.orbifold_unwrap)
    assert "No object was unwrapped" in said and "Blob:" in said and "Open:" in said, said
    object_mode()
    assert not any(len(obj.data.uv_layers) for obj in bpy.data.objects)


def check_linked_duplicates_are_treated_once():
    one = blob()
    cones = set_cones(one, "442")
    twin = one.copy()
    bpy.context.scene.collection.objects.link(twin)
    twin.select_set(True)
    twin.modifiers.new("Smooth", "SUBSURF")
    bpy.ops.object.mode_set(mode="EDIT")
    made, real = [], unwrapping.Unwrapping.write
    unwrapping.Unwrapping.write = lambda self: (made.append(self.obj.name), real(self))
    try:
        kind, said = reported(bpy.ops.uv.orbifold_unwrap)
    finally:
        unwrapping.Unwrapping.write = real
    object_mode()
    assert len(made) == 1 and has_uv_of(one, "442", cones), made
    assert kind == "WARNING" and '"Smooth" of' in said, said  # the twin's modifier counts too


# ------------------------------------------------------------------------------- modifiers and shape keys


def check_subdivision_is_warned_of():
    obj = blob()
    set_cones(obj, "442")
    modifier = obj.modifiers.new("Round", "SUBSURF")
    kind, said = reported(bpy.ops.uv.orbifold_unwrap)
    assert kind == "WARNING" and 'modifier "Round"' in said and 'UV Smooth is "Keep Boundaries"' in said, said
    assert modifier.uv_smooth == "PRESERVE_BOUNDARIES" and len(obj.modifiers) == 1, "nothing is changed silently"
    modifier.uv_smooth = "NONE"
    assert reported(bpy.ops.uv.orbifold_unwrap)[0] == "INFO"
    obj.modifiers.new("Bend", "SIMPLE_DEFORM")
    assert reported(bpy.ops.uv.orbifold_unwrap)[0] == "INFO"


def check_shape_keys_the_basis_is_unwrapped():
    obj = blob()
    cones = set_cones(obj, "442")
    wanted = expected_uv(obj, "442", cones)[2].uv.astype(np.float32)
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Long")
    for point in key.data:
        point.co.z *= 3
    key.value = 0.0
    assert reported(bpy.ops.uv.orbifold_unwrap)[0] == "INFO"
    key.value, obj.active_shape_key_index = 1.0, 1
    for enter in (object_mode, edit_mode):
        enter()
        kind, said = reported(bpy.ops.uv.orbifold_unwrap)
        object_mode()
        assert kind == "WARNING" and "The shape of Basis was unwrapped, not the mix with Long" in said, said
        arrays = blender_mesh.read_mesh(obj.data)
        assert np.array_equal(blender_mesh.read_uv(obj.data)[arrays.loops], wanted)


# ----------------------------------------------------------------------------------------------- components


def check_a_component_with_cones_beside_one_without():
    obj, n, m = two_blobs()
    layer = obj.data.uv_layers.new(name="Mine")
    values = np.random.default_rng(1).random(len(obj.data.loops) * 2).astype(np.float32)
    layer.data.foreach_set("uv", values)
    cones = set_cones(obj, "442", [5, 50, 100])
    kind, said = reported(bpy.ops.uv.orbifold_unwrap)
    assert f"kept their UVs: that of vertex {n} ({m} faces)" in said, said
    assert has_uv_of(obj, "442", cones, np.arange(m))
    assert np.array_equal(blender_mesh.read_uv(obj.data)[3 * m :].ravel(), values.reshape(-1)[6 * m :])
    assert picked(obj) == [(5, 4), (50, 4), (100, 2)] and obj.data.orbifold.signature == "442"
    seams = blender_mesh.read_edges(obj.data)[blender_mesh.read_seams(obj.data)]
    assert len(seams) and seams.max() < n
    set_cones(obj, "333", [n + 5, n + 50, n + 100])  # then the other one: the first keeps what it has
    bpy.ops.uv.orbifold_unwrap()
    assert has_uv_of(obj, "442", cones, np.arange(m))
    assert has_uv_of(obj, "333", [n + 5, n + 50, n + 100], np.arange(m, 2 * m))
    now = blender_mesh.read_edges(obj.data)[blender_mesh.read_seams(obj.data)]
    assert {tuple(pair) for pair in seams.tolist()} < {tuple(pair) for pair in now.tolist()}


def check_each_component_with_cones_by_its_own_orders():
    obj, n, m = two_blobs()
    vertices = [5, n + 5, 50, n + 50, 100, n + 100]
    part("properties").set_cones(obj.data, vertices, [4, 3, 3, 3, 2, 3])
    kind, said = reported(bpy.ops.uv.orbifold_unwrap, pattern=True)
    assert "Orbifold 432 on the component of vertex 0" in said and f"333 on the component of vertex {n}" in said, said
    assert has_uv_of(obj, "333", [n + 5, n + 50, n + 100], np.arange(m, 2 * m))
    assert has_uv_of(obj, "432", [5, 50, 100], np.arange(m))
    key, base = blender_mesh.read_shape_key(obj), blender_mesh.read_vertices(obj.data)
    assert np.array_equal(key[n:], base[n:].astype(np.float32)) and np.abs(key[:n] - base[:n]).max() > 0.05
    slots = [polygon.material_index for polygon in obj.data.polygons]
    assert len(set(slots[:m])) == len(set(slots[m:])) == 1 and slots[0] != slots[m]
    assert [vertex for vertex, _ in picked(obj)] == vertices
    before = digest(obj)
    assert "own cones" in raises(bpy.ops.uv.orbifold_unwrap, signature="442") and digest(obj) == before


def check_a_component_that_is_a_disk_gets_its_own_signature():
    obj, n, m = two_blobs(half=True)
    seen = part("surface").read(obj.data)
    loop = [int(v) for v in max(seen.loops, key=len) if v >= n]
    corners = [loop[0], loop[len(loop) // 3], loop[2 * len(loop) // 3]]
    part("properties").set_cones(obj.data, corners, [4, 4, 2])
    assert obj.data.orbifold.signature == "*442", obj.data.orbifold.signature
    kind, said = reported(bpy.ops.uv.orbifold_unwrap)
    assert "Orbifold *442 on the component of vertex" in said, said


def check_a_failure_names_the_component_and_changes_nothing():
    obj, n, m = two_blobs()
    vertices, faces = arrays_of(obj)
    hole = next(number for number in range(m, 2 * m) if not {n + 5, n + 50, n + 100} & set(faces[number]))
    obj = mesh_object(vertices, faces[:hole] + faces[hole + 1 :], "Two")
    part("properties").set_cones(obj.data, [5, 50, 100, n + 5, n + 50, n + 100], [4, 4, 2, 3, 3, 3])
    before = digest(obj)
    said = raises(bpy.ops.uv.orbifold_unwrap)
    assert f"omponent of vertex {n}: " in said and digest(obj) == before, said
    assert sorted(v for edge in obj.data.edges if edge.select for v in edge.vertices)[0] >= n


def check_a_single_cone_on_a_component_is_completed():
    obj, n, m = two_blobs()
    part("properties").set_cones(obj.data, [n + 7], [2])
    bpy.ops.uv.orbifold_unwrap()
    there = [vertex for vertex, _ in picked(obj)]
    assert n + 7 in there and len(there) > 2 and min(there) >= n


# ------------------------------------------------------------------------------------------------------- API


def check_the_api_gives_the_report():
    obj = blob()
    cones = far_vertices(obj, 3)
    report = api.unwrap(obj, cones=cones, signature="442", pattern=True)
    assert has_uv_of(obj, "442", cones) and picked(obj) == list(zip(cones, (4, 4, 2)))
    assert obj.data.orbifold.signature == "442" and report["orbifold"]["signature"] == "442"
    assert report["certificate"]["bijective"] is True and report["object"] == "Blob"
    assert report["uv_map"] == "Orbifold" and report["warnings"] == [] and len(report["components"]) == 1
    json.dumps(report, allow_nan=False)


def check_the_api_needs_no_context():
    """Objects that are neither active nor selected, in edit mode, or in no scene at all."""
    obj = blob()
    cones = far_vertices(obj, 3)
    other = beside(ball, "Other")
    other.select_set(False)
    bpy.context.view_layer.objects.active = other
    api.unwrap(obj, cones, "442")
    assert has_uv_of(obj, "442", cones) and bpy.context.view_layer.objects.active == other
    bpy.context.view_layer.objects.active = obj
    edit_mode()
    api.unwrap(other, far_vertices(other, 3), "333")
    assert obj.mode == "EDIT" and "Orbifold" in other.data.uv_layers
    api.unwrap(obj, cones, "632")
    assert obj.mode == "EDIT" and api.check(obj)["ready"]
    object_mode()
    assert has_uv_of(obj, "632", cones)
    loose = bpy.data.objects.new("Loose", other.data.copy())
    bpy.context.view_layer.objects.active = None
    assert api.unwrap(loose, far_vertices(loose, 2), "22")["shape_key"] == "Orbifold Sphere"


def check_api_signatures_and_orders():
    obj = blob()
    a, b, c = far_vertices(obj, 3)
    api.unwrap(obj, [a, b, c], "442", [2, 4, 4])
    assert has_uv_of(obj, "442", [b, c, a]) and picked(obj) == [(b, 4), (c, 4), (a, 2)]
    report = api.unwrap(obj, [a, b, c], orders=[3, 6, 2])
    assert sorted(report["orbifold"]["signature"]) == ["2", "3", "6"] and picked(obj) == [(a, 3), (b, 6), (c, 2)]
    report = api.unwrap(obj)  # those of the mesh
    assert sorted(cone["vertex"] for cone in report["orbifold"]["cones"]) == sorted([a, b, c])
    report = api.unwrap(obj, cones=[], chart="conformal")  # none: the best ones
    best = api.suggest(obj, flat=True)[0]
    assert [vertex for vertex, _ in picked(obj)] == best["cones"] and report["suggested"]["predicted"] > 0
    report = api.unwrap(obj, cones=[b], signature="333")
    assert b in [vertex for vertex, _ in picked(obj)] and report["orbifold"]["signature"] == "333"


def check_api_errors_leave_the_mesh():
    obj = blob()
    cones = set_cones(obj, "442")
    api.unwrap(obj)
    before = digest(obj)
    a, b, c = cones
    cases = (
        (dict(cones=[a, b], signature="442"), "ORB_CONE_COUNT"), (dict(signature="44y"), "ORB_BAD_SIGNATURE"),
        (dict(cones=[a, b, 99999], signature="442"), "ORB_BAD_CONE"), (dict(cones=[a, b, c]), "ORB_BAD_ARGUMENT"),
        (dict(cones=[a, a, c], signature="442"), "ORB_BAD_CONE"), (dict(orders=[4, 4, 2]), "ORB_BAD_ARGUMENT"),
        (dict(cones=[a, b, c], signature="442", orders=[3, 3, 3]), "ORB_BAD_ORDER"),
        (dict(cones=[a, b, c], orders=[4, 4]), "ORB_BAD_ORDER"), (dict(chart="klein"), "ORB_BAD_ARGUMENT"),
        (dict(chart="round"), "ORB_BAD_ARGUMENT"), (dict(weights="lead"), "ORB_BAD_ARGUMENT"),
        (dict(signature="442", progress=lambda stage, fraction: False), "ORB_CANCELLED"),
    )
    for arguments, status in cases:
        try:
            api.unwrap(obj, **arguments)
        except api.OrbifoldError as error:
            assert error.status == status, (arguments, error.status, str(error))
        else:
            raise AssertionError(f"not refused: {arguments}")
        assert digest(obj) == before, arguments
    for wrong in (None, "Cube", bpy.data.objects.new("Empty", None)):
        try:
            api.check(wrong)
        except core.OrbifoldError as error:
            assert "mesh object" in str(error)
        else:
            raise AssertionError("not refused")
    try:
        api.sphere(obj, signature="442")
    except core.OrbifoldError as error:
        assert "not spherical" in str(error) and digest(obj) == before
    for number in range(7):
        obj.data.uv_layers.new(name=f"Map {number}")
    obj.data.uv_layers.remove(obj.data.uv_layers["Orbifold"])
    obj.data.uv_layers.new(name="Map 8")
    try:
        api.unwrap(obj)
    except core.OrbifoldError as error:
        assert "8 UV maps" in str(error)
    else:
        raise AssertionError("not refused")


def check_api_sphere_suggest_check():
    obj = quad_blob()
    cones = far_vertices(obj, 3)
    report = api.sphere(obj, cones, "432")
    assert report["shape_key"] == "Orbifold Sphere" and report["uv_map"] is None and not len(obj.data.uv_layers)
    assert "Orbifold Sphere" in obj.data.shape_keys.key_blocks
    obj = blob()
    assert core.geometry_of(api.sphere(obj)["orbifold"]["signature"]) == "spherical"
    before = digest(obj)
    found = api.suggest(obj, ["442", "333"], fixed=[9])
    assert {one["signature"] for one in found} == {"442", "333"} and all(9 in one["cones"] for one in found)
    assert api.check(obj) == {"object": "Blob", "ready": True, "defects": []} and digest(obj) == before
    vertices, faces = arrays_of(obj)
    faces[30] = faces[30][::-1]
    told = api.check(mesh_object(vertices, faces + [[0, 1, 2]]))
    kinds = {defect["kind"]: defect for defect in told["defects"]}
    assert not told["ready"] and kinds["flipped"]["elements"] == [30] and kinds["flipped"]["element"] == "face"
    json.dumps(told)


def check_api_components():
    obj, n, m = two_blobs()
    report = api.unwrap(obj, [n + 5, n + 50, n + 100], "442")
    assert has_uv_of(obj, "442", [n + 5, n + 50, n + 100], np.arange(m, 2 * m))
    assert report["untreated"] == [{"first_vertex": 0, "faces": m}] and report["components"][0]["first_vertex"] == n
    report = api.unwrap(obj, [5, 50, 100, n + 5, n + 50, n + 100], orders=[3, 3, 3, 4, 4, 2])
    assert [one["orbifold"]["signature"] for one in report["components"]] == ["333", "442"]


def check_the_example_in_the_documentation():
    """Run as it stands: it prints what docs/batch.md says."""
    text = (Path(__file__).parents[3] / "docs" / "batch.md").read_text(encoding="utf-8")
    code, rest = re.search(r"```python\n(.*?)```\n\nprints\n\n(.*)", text, re.S).groups()
    said = re.match(r"(?:    .*\n)+", rest)[0]
    empty_scene()
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(code, "batch.md", "exec"), {})
    assert printed.getvalue() == textwrap.dedent(said), printed.getvalue()


def check_the_command_from_the_installed_add_on():
    """What `blender --command orbifold` calls: the exit status; the add-on is enabled afterwards."""
    with tempfile.TemporaryDirectory() as folder:
        obj = blob()
        lines = [f"v {v.co.x} {v.co.y} {v.co.z}" for v in obj.data.vertices]
        lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in (p.vertices for p in obj.data.polygons)]
        for name, rows in (("good", lines), ("bad", lines[:-1])):
            with open(os.path.join(folder, f"{name}.obj"), "w", encoding="utf-8") as file:
                file.write("\n".join(rows))
        out = os.path.join(folder, "out")
        words = [folder, "--orbifold", "442", "--output", out, "--files", "json"]
        assert part("cli")._run(words) == 1 and os.listdir(out) == ["good.json"]
        assert part("cli")._run([os.path.join(folder, "good.obj"), *words[1:]]) == 0
    assert module_name() in bpy.context.preferences.addons and hasattr(bpy.types.Mesh, "orbifold")
    empty_scene()
    assert bpy.ops.uv.orbifold_unwrap.poll() is False


run_checks(globals())
