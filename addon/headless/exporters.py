# SPDX-License-Identifier: GPL-3.0-or-later
"""The object back into the format that it came in, with its texture coordinates, alone, without modifiers applied.

.ply and .glb keep one pair of texture coordinates for a vertex, so that vertices on a seam are several there."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Optional

import bpy

from .errors import RunError
from .importers import enabled_addon, has_operator


def check_export(mesh: Optional[Path], output: Path) -> None:
    """RunError, before any work, where a mesh cannot go back."""
    if mesh is None:
        raise RunError("--export: the sample creature comes from no file; name a mesh")
    ending = mesh.suffix.lower()
    if ending not in (*EXPORTERS, ".blend"):
        raise RunError(f"{mesh}: {ending or 'a file without an ending'} holds no texture coordinates; leave out "
                       f"--export, or save the mesh as {' '.join(sorted(EXPORTERS))} or .blend")
    if mesh.resolve().parent == output.resolve():
        raise RunError(f"{mesh}: --export would write over it; choose another folder with --output")


def export_object(obj: bpy.types.Object, path: Path) -> None:
    """Writes `path`, and what belongs to it, into its folder. The format follows from the ending."""
    for other in bpy.context.view_layer.objects:
        other.select_set(other is obj)
    bpy.context.view_layer.objects.active = obj
    try:
        EXPORTERS[path.suffix.lower()](str(path))
    except (RuntimeError, OSError) as reason:
        first_line = (str(reason).strip().splitlines() or ["unknown reason"])[0]
        raise RunError(f"{path.name}: cannot be exported ({first_line})") from reason
    if not path.is_file():
        raise RunError(f"{path.name}: cannot be exported")


def _export_obj(path: str) -> None:
    bpy.ops.wm.obj_export(
        filepath=path, export_selected_objects=True, export_uv=True, export_materials=False, apply_modifiers=False
    )


def _export_ply(path: str) -> None:
    if has_operator(bpy.ops.wm, "ply_export"):
        bpy.ops.wm.ply_export(
            filepath=path, export_selected_objects=True, export_uv=True, export_colors="NONE", apply_modifiers=False
        )
    else:
        bpy.ops.export_mesh.ply(
            filepath=path, use_selection=True, use_uv_coords=True, use_colors=False, use_mesh_modifiers=False
        )


def _export_glb(path: str) -> None:
    _export_gltf(path, "GLB")


def _export_gltf_text(path: str) -> None:
    _export_gltf(path, "GLTF_SEPARATE")


def _export_gltf(path: str, form: str) -> None:
    enabled_addon("io_scene_gltf2")
    bpy.ops.export_scene.gltf(
        filepath=path, export_format=form, use_selection=True, export_materials="NONE", export_animations=False
    )


def _export_fbx(path: str) -> None:
    enabled_addon("io_scene_fbx")
    bpy.ops.export_scene.fbx(
        filepath=path, use_selection=True, object_types={"MESH"}, use_mesh_modifiers=False, bake_anim=False,
        path_mode="STRIP",
    )


EXPORTERS: dict[str, Callable[[str], None]] = {
    ".obj": _export_obj,
    ".ply": _export_ply,
    ".glb": _export_glb,
    ".gltf": _export_gltf_text,
    ".fbx": _export_fbx,
}
