# SPDX-License-Identifier: GPL-3.0-or-later
"""What the scripts of this folder share: enabling the add-on, making meshes, and running the checks."""

from __future__ import annotations

import faulthandler
import hashlib
import importlib
import json
import sys
import traceback
from typing import Iterable

import bmesh
import bpy
import numpy as np

HANGS = 570  # seconds until a script says where it is, and ends; conftest.py waits a little longer


def module_name() -> str:
    return "bl_ext.user_default.orbifold_uv" if "extensions" in dir(bpy.ops) else "orbifold_uv"


def enable() -> object:
    """The add-on's package, enabled."""
    bpy.ops.preferences.addon_enable(module=module_name())
    return importlib.import_module(module_name())


def install(package: str) -> None:
    """The zip, as a user does: as an extension where Blender has them, else as an add-on. Extensions are enabled."""
    if "extensions" in dir(bpy.ops):
        bpy.ops.extensions.package_install_files(filepath=package, repo="user_default", enable_on_install=True)
    else:
        bpy.ops.preferences.addon_install(filepath=package, overwrite=True)


def part(name: str):
    return importlib.import_module(f"{module_name()}.{name}")


def run_checks(scope: dict) -> None:
    """Run the functions `check_...` of a script in turn and write name -> traceback or null where conftest.py reads
    it, after each one, so that a crash of Blender loses nothing."""
    out, results = sys.argv[-1], {}
    faulthandler.dump_traceback_later(HANGS, exit=True)
    for name, function in list(scope.items()):
        if name.startswith("check_"):
            try:
                function()
                results[name] = None
            except Exception:
                results[name] = traceback.format_exc()
            with open(out, "w", encoding="utf-8") as file:
                json.dump(results, file)


# --------------------------------------------------------------------------------------------------- meshes


def empty_scene() -> None:
    if bpy.context.object is not None and bpy.context.object.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    for mesh in list(bpy.data.meshes):
        bpy.data.meshes.remove(mesh)


def mesh_object(vertices, faces, name: str = "Mesh") -> bpy.types.Object:
    """A new object, the only one, active and in object mode."""
    empty_scene()
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(v) for v in vertices], [], [tuple(f) for f in faces])
    mesh.update()
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    return obj


def pulled(vertices: np.ndarray) -> np.ndarray:
    """A sphere without symmetry."""
    x, y, z = vertices.T
    return np.stack([x * (1 + 0.2 * y), 1.3 * y + 0.15 * x * z, z + 0.3 * np.exp(-((x - 0.5) ** 2))], 1)


def blob(subdivisions: int = 3) -> bpy.types.Object:
    """Triangles: a distorted icosphere of 10 * 4^(subdivisions - 1) + 2 vertices."""
    bm = bmesh.new()
    bmesh.ops.create_icosphere(bm, subdivisions=subdivisions, radius=1.0)
    vertices, faces = _taken(bm)
    return mesh_object(pulled(vertices), faces, "Blob")


def quad_blob(cuts: int = 6) -> bpy.types.Object:
    """Quads, and two n-gons."""
    bm = bmesh.new()
    bmesh.ops.create_cube(bm, size=2.0)
    bmesh.ops.subdivide_edges(bm, edges=bm.edges[:], cuts=cuts, use_grid_fill=True)
    for v in bm.verts:
        v.co.normalize()
    for place in (0, len(bm.faces) // 2):
        bm.faces.ensure_lookup_table()
        face = bm.faces[place]
        neighbour = next(f for e in face.edges for f in e.link_faces if f is not face)
        bmesh.ops.dissolve_faces(bm, faces=[face, neighbour])
    vertices, faces = _taken(bm)
    return mesh_object(pulled(vertices), faces, "Quads")


def _taken(bm: bmesh.types.BMesh) -> tuple[np.ndarray, list[list[int]]]:
    bm.verts.index_update()
    vertices = np.array([v.co[:] for v in bm.verts])
    faces = [[v.index for v in f.verts] for f in bm.faces]
    bm.free()
    return vertices, faces


def far_vertices(obj: bpy.types.Object, count: int) -> list[int]:
    return far_among(obj.data, range(len(obj.data.vertices)), count)


def far_among(mesh: bpy.types.Mesh, vertices: Iterable[int], count: int) -> list[int]:
    """The first of these vertices, and others of them, each as far as can be from those before it."""
    among = np.array(vertices)
    points = np.array([mesh.vertices[vertex].co[:] for vertex in among])
    chosen, nearest = [0], np.full(len(points), np.inf)
    while len(chosen) < count:
        nearest = np.minimum(nearest, np.linalg.norm(points - points[chosen[-1]], axis=1))
        chosen.append(int(nearest.argmax()))
    return among[chosen].tolist()


def set_cones(obj: bpy.types.Object, signature: str, vertices: Iterable[int] | None = None) -> list[int]:
    """Cones at these vertices (far apart by default) with the orders of the signature."""
    orders = list(part("core").parse_signature(signature).orders)
    vertices = far_vertices(obj, len(orders)) if vertices is None else list(vertices)
    part("properties").set_cones(obj.data, vertices, orders)
    return vertices


# ------------------------------------------------------------------------------------------------- modes, UI


def edit_mode() -> None:
    if bpy.context.object.mode != "EDIT":
        bpy.ops.object.mode_set(mode="EDIT")


def object_mode() -> None:
    if bpy.context.object.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")


def click(vertices: list[int]) -> None:
    """Select these vertices one after the other, as with the mouse. In edit mode."""
    bpy.ops.mesh.select_all(action="DESELECT")
    bm = bmesh.from_edit_mesh(bpy.context.object.data)
    bm.verts.ensure_lookup_table()
    bm.select_history.clear()
    for vertex in vertices:
        bm.verts[vertex].select = True
        bm.select_history.add(bm.verts[vertex])
    bmesh.update_edit_mesh(bpy.context.object.data)


def user(operator, **settings) -> set[str]:
    """Call an operator as the user interface does, with an undo step of its own."""
    return operator("EXEC_DEFAULT", True, **settings)


# --------------------------------------------------------------------------------------------------- reading


def digest(obj: bpy.types.Object) -> str:
    """Of everything that the mesh is, but for what is selected and hidden. In object mode."""
    mesh, found = obj.data, hashlib.sha256()

    def add(collection, name: str, kind, width: int) -> None:
        values = np.empty(len(collection) * width, kind)
        collection.foreach_get(name, values)
        found.update(values.tobytes())

    add(mesh.vertices, "co", np.float32, 3)
    add(mesh.loops, "vertex_index", np.int32, 1)
    add(mesh.polygons, "loop_total", np.int32, 1)
    add(mesh.edges, "vertices", np.int32, 2)
    add(mesh.edges, "use_seam", bool, 1)
    for layer in mesh.uv_layers:
        found.update(layer.name.encode() + bytes([layer.active]))
        add(layer.data, "uv", np.float32, 2)
    for attribute in sorted(mesh.attributes, key=lambda attribute: attribute.name):  # Blender 5 changes their sequence
        if attribute.domain == "POINT" and attribute.data_type == "INT":
            found.update(attribute.name.encode())
            add(attribute.data, "value", np.int32, 1)
    names = sorted(a.name for a in mesh.attributes if not a.name.startswith("."))
    found.update(repr(names).encode())
    if mesh.shape_keys is not None:
        for key in mesh.shape_keys.key_blocks:
            found.update(key.name.encode())
            add(key.data, "co", np.float32, 3)
    settings = mesh.orbifold
    found.update(repr([settings.signature, [(c.vertex, c.order) for c in settings.cones]]).encode())
    found.update(repr([m.name if m else None for m in mesh.materials]).encode())
    return found.hexdigest()


def uv_of(obj: bpy.types.Object) -> np.ndarray:
    """(loops, 2) of the map Orbifold, in any mode; empty where there is none."""
    mesh = obj.data
    if obj.mode == "EDIT":
        bm = bmesh.from_edit_mesh(mesh)
        layer = bm.loops.layers.uv.get("Orbifold")
        found = [] if layer is None else [loop[layer].uv[:] for face in bm.faces for loop in face.loops]
        return np.array(found, np.float32).reshape(-1, 2)
    values = np.empty(2 * len(mesh.loops) if "Orbifold" in mesh.uv_layers else 0, np.float32)
    if len(values):
        mesh.uv_layers["Orbifold"].data.foreach_get("uv", values)
    return values.reshape(-1, 2)


def picked(obj: bpy.types.Object) -> list[tuple[int, int]]:
    """(vertex, order) of the cones; the list that is shown must say the same."""
    there = [(cone.vertex, cone.order) for cone in part("cones").read_cones(obj.data)]
    shown = [(item.vertex, item.order) for item in obj.data.orbifold.cones]
    assert there == shown, f"the vertices say {there}, the list shows {shown}"
    return there


def raises(function, **settings) -> str:
    """The message with which an operator reports an error."""
    try:
        result = function(**settings)
    except RuntimeError as error:
        return str(error)
    raise AssertionError(f"no error was reported: {result}")
