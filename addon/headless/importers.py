# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh file -> the one mesh object in it, its vertices numbered as in the file.

What each kind of file means by a vertex's number:
  .obj .off .ply .blend   the file's, from 0; vertices that no face uses count too
  .stl .glb .gltf .fbx    the one that Blender shows after import (the first three store no shared vertices, so
                          those at one place are joined)
"""

from __future__ import annotations

from contextlib import contextmanager
from pathlib import Path
from typing import Callable, Iterator, Optional

import addon_utils
import bmesh
import bpy
import numpy as np
from mathutils import Matrix

from .errors import RunError


ReadMesh = Callable[[Path], tuple[np.ndarray, np.ndarray]]


def load_object(
    path: Path, object_name: Optional[str], read_mesh: ReadMesh, option: str = "--object"
) -> bpy.types.Object:
    """The mesh object of the file, alone in an empty scene. `read_mesh` is core.read_mesh, `option` what would name it
    on the command line."""
    if not path.is_file():
        raise RunError(f"{path}: there is no such file")
    importer = IMPORTERS.get(path.suffix.lower())
    if importer is None and path.suffix.lower() != ".off":
        raise RunError(f"{path}: the ending is none of {' '.join(MESH_ENDINGS)}")
    try:
        active = _import_off(path, read_mesh) if importer is None else importer(path)
    except (RuntimeError, ValueError, OSError) as reason:
        first_line = (str(reason).strip().splitlines() or ["unknown reason"])[0]
        raise RunError(f"{path}: cannot be imported ({first_line})") from reason
    obj = _choose(path, object_name, active, option)
    if path.suffix.lower() == ".obj":
        _restore_unused_vertices(path, obj, read_mesh)
    _keep_only(obj)
    return obj


def _choose(path: Path, object_name: Optional[str], active: Optional[str], option: str) -> bpy.types.Object:
    """The named object; else the only mesh with faces; else the active one."""
    meshes = {obj.name: obj for obj in bpy.data.objects if obj.type == "MESH" and len(obj.data.polygons)}
    listed = ", ".join(sorted(meshes))
    if not meshes:
        raise RunError(f"{path}: no mesh with faces in it")
    if object_name is not None:
        if object_name not in meshes:
            raise RunError(f"{path}: no mesh object is called {object_name}; there is {listed}")
        return meshes[object_name]
    if len(meshes) == 1:
        return next(iter(meshes.values()))
    if active in meshes:
        return meshes[active]
    raise RunError(f"{path}: {len(meshes)} mesh objects ({listed}); say which with {option} NAME")


def _keep_only(obj: bpy.types.Object) -> None:
    """Everything else that came with the file goes; `obj` stays where it stood and becomes the active object."""
    place = _place(obj)
    for other in list(bpy.data.objects):
        if other is not obj:
            bpy.data.objects.remove(other)
    obj.parent = None
    obj.matrix_world = place
    collection = bpy.context.scene.collection
    if obj.name not in collection.objects:
        collection.objects.link(obj)
    for group in list(bpy.data.collections):
        bpy.data.collections.remove(group)
    obj.hide_render = obj.hide_viewport = False
    bpy.context.view_layer.objects.active = obj
    if obj.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")


def _place(obj: bpy.types.Object) -> Matrix:
    """Its matrix in the world. Blender 4 and later compute that of an object that came from a file only once it is in
    the scene, with what it hangs on."""
    collection, one = bpy.context.scene.collection, obj
    while one is not None:
        if one.name not in bpy.context.scene.objects:
            collection.objects.link(one)
        one = one.parent
    bpy.context.view_layer.update()
    return obj.matrix_world.copy()


# ------------------------------------------------------------------------------------------------ by ending


def has_operator(group: object, name: str) -> bool:
    """Whether this Blender has the operator (bpy.ops answers hasattr with True for any name)."""
    return name in dir(group)


def enabled_addon(module: str) -> None:
    """Blender's own importers and exporters that are add-ons may be switched off in a person's preferences."""
    if not addon_utils.check(module)[1]:
        addon_utils.enable(module, default_set=False)


def empty_file() -> None:
    """As after a start with factory settings, without any object. Preferences stay, and with them the add-ons."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)


def _import_obj(path: Path) -> None:
    bpy.ops.wm.obj_import(filepath=str(path), validate_meshes=False)


def _import_ply(path: Path) -> None:
    if has_operator(bpy.ops.wm, "ply_import"):
        bpy.ops.wm.ply_import(filepath=str(path), merge_verts=False)
    else:
        bpy.ops.import_mesh.ply(filepath=str(path))


def _import_stl(path: Path) -> None:
    if has_operator(bpy.ops.wm, "stl_import"):
        bpy.ops.wm.stl_import(filepath=str(path), use_mesh_validate=False)
    else:
        bpy.ops.import_mesh.stl(filepath=str(path))


def _import_gltf(path: Path) -> None:
    enabled_addon("io_scene_gltf2")
    with _numpy_bool():
        bpy.ops.import_scene.gltf(filepath=str(path), merge_vertices=True)
    for obj in bpy.data.objects:
        if obj.type == "MESH":
            _join_vertices(obj.data)


def _import_fbx(path: Path) -> None:
    enabled_addon("io_scene_fbx")
    bpy.ops.import_scene.fbx(filepath=str(path), use_anim=False)


def _import_blend(path: Path) -> str:
    """The objects of the file, in this session's scene; the name of the file's active object."""
    bpy.ops.wm.open_mainfile(filepath=str(path), load_ui=False, use_scripts=False)
    active = bpy.context.view_layer.objects.active
    name = active.name if active is not None else ""
    names = [obj.name for obj in bpy.context.scene.objects if obj.type == "MESH"]
    empty_file()
    with bpy.data.libraries.load(str(path), link=False) as (_, wanted):
        wanted.objects = names
    return name


def _import_off(path: Path, read_mesh: ReadMesh) -> None:
    vertices, triangles = read_mesh(path)
    mesh = bpy.data.meshes.new(path.stem)
    mesh.from_pydata(np.asarray(vertices).tolist(), [], np.asarray(triangles).tolist())
    mesh.polygons.foreach_set("use_smooth", np.ones(len(mesh.polygons), bool))
    obj = bpy.data.objects.new(path.stem, mesh)
    bpy.context.scene.collection.objects.link(obj)


IMPORTERS: dict[str, Callable[[Path], Optional[str]]] = {
    ".obj": _import_obj,
    ".ply": _import_ply,
    ".stl": _import_stl,
    ".glb": _import_gltf,
    ".gltf": _import_gltf,
    ".fbx": _import_fbx,
    ".blend": _import_blend,
}
MESH_ENDINGS = tuple(sorted([*IMPORTERS, ".off"]))


@contextmanager
def _numpy_bool() -> Iterator[None]:
    """Blender 3.4's glTF importer uses `numpy.bool`, which NumPy 1.24 to 1.26 do not have."""
    missing = "bool" not in np.__dict__
    if missing:
        np.bool = bool
    try:
        yield
    finally:
        if missing:
            del np.bool


def _join_vertices(mesh: bpy.types.Mesh) -> None:
    """Join vertices at exactly one place: a glTF file splits them wherever normals or texture coordinates differ."""
    joined = bmesh.new()
    joined.from_mesh(mesh)
    first: dict[tuple[float, float, float], bmesh.types.BMVert] = {}
    onto = {}
    for vert in joined.verts:
        keeper = first.setdefault(tuple(vert.co), vert)
        if keeper is not vert:
            onto[vert] = keeper
    bmesh.ops.weld_verts(joined, targetmap=onto)
    joined.to_mesh(mesh)
    joined.free()


# ---------------------------------------------------------------------------------- numbering of .obj files


def _restore_unused_vertices(path: Path, obj: bpy.types.Object, read_mesh: ReadMesh) -> None:
    """Blender leaves out the vertices of an .obj file that no face uses, which shifts the numbers of those behind
    them: put them back in their places."""
    text = path.read_bytes()
    n_file = text.count(b"\nv ") + text.count(b"\nv\t") + text.startswith((b"v ", b"v\t"))
    mesh = obj.data
    if len(mesh.vertices) == n_file:
        return
    positions, triangles = read_mesh(path)
    used = np.unique(triangles)
    imported = np.empty(len(mesh.vertices) * 3, np.float32)
    mesh.vertices.foreach_get("co", imported)
    imported = imported.reshape(-1, 3)
    if len(used) != len(imported) or not np.allclose(positions[used], imported, rtol=1e-5, atol=1e-30):
        raise RunError(f"{path}: {n_file} vertices in the file but {len(imported)} in {obj.name}, so that the file's "
                       "vertex numbers are not Blender's; save it from Blender as one .obj object and use that")
    place = np.concatenate([used, np.setdiff1d(np.arange(len(positions)), used)])
    filled = bmesh.new()
    filled.from_mesh(mesh)
    for vertex in place[len(used):]:
        filled.verts.new(positions[vertex])
    for vert, number in zip(filled.verts, place):
        vert.index = int(number)
    filled.verts.sort()
    filled.to_mesh(mesh)
    filled.free()
