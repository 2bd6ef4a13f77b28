# SPDX-License-Identifier: GPL-3.0-or-later
"""In Blender: each kind of mesh file through the importers of `run`, vertices compared with the file's.

Arguments: ANSWER.json ADDON_FOLDER SCRATCH_FOLDER"""

import contextlib
import importlib.util
import json
import sys
from pathlib import Path

import bpy
import numpy as np

answer, addon, scratch = map(Path, sys.argv[sys.argv.index("--") + 1 :])
spec = importlib.util.spec_from_file_location("run", addon / "run.py")
run = importlib.util.module_from_spec(spec)
spec.loader.exec_module(run)
run.load_package()

from orbifold_uv import blender_mesh, core  # noqa: E402
from orbifold_uv.headless.errors import RunError  # noqa: E402
from orbifold_uv.headless.importers import load_object  # noqa: E402

# A pyramid whose vertices 0, 3 and 6 no face uses.
VERTICES = np.array([[9, 9, 9], [0, 0, 0], [1, 0, 0], [5, 5, 5], [0, 1, 0], [0, 0, 1], [7, 7, 7]], np.float32)
FACES = np.array([[1, 4, 2], [1, 2, 5], [2, 4, 5], [4, 1, 5]])
COMPACT = VERTICES[[1, 2, 4, 5]]
OBJ_LINES = [f"v {x} {y} {z}" for x, y, z in VERTICES.tolist()]
FACE_LINES = [f"f {a} {b} {c}" for a, b, c in (FACES + 1).tolist()]


def verdict(path, expected, object_name=None):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    obj = load_object(path, object_name, core.read_mesh)
    arrays = blender_mesh.read_mesh(obj.data)
    if len(bpy.data.objects) != 1 or bpy.context.view_layer.objects.active is not obj:
        return "other objects were left"
    if arrays.vertices.shape != expected.shape or not np.allclose(arrays.vertices, expected, atol=1e-6):
        return f"vertices {arrays.vertices.tolist()}"
    where = {tuple(np.round(p).astype(int)): k for k, p in enumerate(expected)}
    wanted = [[where[tuple(np.round(VERTICES[v]).astype(int))] for v in face] for face in FACES]
    turned = {tuple(np.roll(face, -int(np.argmin(face)))) for face in wanted}
    if {tuple(np.roll(face, -int(np.argmin(face)))) for face in arrays.triangles} != turned:
        return f"triangles {arrays.triangles.tolist()}"
    return "as in the file"


def refused(path, *causes):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    try:
        load_object(path, None, core.read_mesh)
    except RunError as reason:
        return "as in the file" if all(cause in str(reason) for cause in causes) else str(reason)
    return "not refused"


def make_scene(uv):
    """The pyramid alone, or with texture coordinates that split it."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    mesh = bpy.data.meshes.new("pyramid")
    index = {1: 0, 2: 1, 4: 2, 5: 3}
    mesh.from_pydata(COMPACT.tolist(), [], [[index[v] for v in face] for face in FACES.tolist()])
    if uv:
        layer = mesh.uv_layers.new(name="map")
        for number, loop in enumerate(layer.data):
            loop.uv = (number / 12, number * 5 % 12 / 12)
    obj = bpy.data.objects.new("pyramid", mesh)
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    return obj


def sorted_like(path):
    """Formats that number anew: the same corners, in the sequence that Blender gives them."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    arrays = blender_mesh.read_mesh(load_object(path, None, core.read_mesh).data)
    return arrays.vertices


seen = {}
one = scratch / "one.obj"
one.write_text("\n".join(OBJ_LINES + FACE_LINES))
seen["obj with unused vertices"] = verdict(one, VERTICES)
grouped = scratch / "grouped.obj"
grouped.write_text("\n".join(OBJ_LINES + ["g a"] + FACE_LINES[2:] + ["usemtl m", "g b"] + FACE_LINES[:2]))
seen["obj with groups"] = verdict(grouped, VERTICES)
textured = scratch / "textured.obj"
textured.write_text("\n".join([line for k in range(3) for line in (f"vt 0.{k} 0.3", f"vn 0 {k} 1")] + OBJ_LINES
                              + [f"f {a}/1/1 {b}/2/2 {c}/3/3" for a, b, c in (FACES + 1).tolist()]))
seen["obj with texture coordinates"] = verdict(textured, VERTICES)
two = scratch / "two.obj"
two.write_text("\n".join(["o first"] + OBJ_LINES + FACE_LINES + ["o second"] + OBJ_LINES + [
    f"f {a} {b} {c}" for a, b, c in (FACES + 8).tolist()]))
seen["obj with two objects"] = refused(two, "first", "second", "--object")
no_faces = scratch / "points.obj"
no_faces.write_text("\n".join(OBJ_LINES))
seen["obj without faces"] = refused(no_faces, "no mesh with faces")
ply = scratch / "one.ply"
ply.write_text("ply\nformat ascii 1.0\nelement vertex 7\nproperty float x\nproperty float y\nproperty float z\n"
               "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
               + "\n".join(f"{x} {y} {z}" for x, y, z in VERTICES.tolist()) + "\n"
               + "\n".join(f"3 {a} {b} {c}" for a, b, c in FACES.tolist()) + "\n")
seen["ply"] = verdict(ply, VERTICES)
off = scratch / "one.off"
off.write_text("OFF\n7 4 0\n" + "\n".join(f"{x} {y} {z}" for x, y, z in VERTICES.tolist()) + "\n"
               + "\n".join(f"3 {a} {b} {c}" for a, b, c in FACES.tolist()) + "\n")
seen["off"] = verdict(off, VERTICES)
stl = scratch / "one.stl"
stl.write_text("solid s\n" + "".join(
    "facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {x} {y} {z}\n" for x, y, z in VERTICES[face].tolist())
    + "endloop\nendfacet\n" for face in FACES) + "endsolid s\n")
seen["stl"] = verdict(stl, sorted_like(stl)) if len(sorted_like(stl)) == 4 else "not joined"

make_scene(uv=True)
bpy.ops.wm.save_as_mainfile(filepath=str(scratch / "one.blend"))
seen["blend"] = verdict(scratch / "one.blend", COMPACT)
other = make_scene(uv=False).copy()
other.name, other.data = "other", other.data.copy()
bpy.context.scene.collection.objects.link(other)
bpy.ops.wm.save_as_mainfile(filepath=str(scratch / "two.blend"))
seen["blend with an active object"] = verdict(scratch / "two.blend", COMPACT)
seen["blend, another object by its name"] = verdict(scratch / "two.blend", COMPACT, "other")
make_scene(uv=True)
with contextlib.suppress(RuntimeError):
    bpy.ops.export_scene.fbx(filepath=str(scratch / "one.fbx"), axis_forward="Y", axis_up="Z")
    found = sorted_like(scratch / "one.fbx")  # FBX counts in centimetres
    seen["fbx"] = "as in the file" if np.allclose(found / found.max(), COMPACT, atol=1e-6) else str(found.tolist())
make_scene(uv=True)
with contextlib.suppress(RuntimeError):
    bpy.ops.export_scene.gltf(filepath=str(scratch / "one.glb"))
    found = sorted_like(scratch / "one.glb")
    seen["glb, split by texture coordinates"] = "as in the file" if len(found) == 4 else f"{len(found)} vertices"
answer.write_text(json.dumps(seen))
