# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps the lists of cones in line with the vertices after edits, undo and loading."""

from __future__ import annotations

import bpy
from bpy.app.handlers import persistent

from . import cones, properties


def _is_ours(mesh: bpy.types.Mesh) -> bool:
    return mesh.library is None and cones.has_cones(mesh)


@persistent
def sync_after_change(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    for update in depsgraph.updates:
        if update.is_updated_geometry and isinstance(update.id, bpy.types.Mesh):
            mesh = update.id.original
            if _is_ours(mesh) and not cones.mirror_is_valid(mesh):
                properties.sync(mesh)


@persistent
def sync_all(*_arguments: object) -> None:
    for mesh in bpy.data.meshes:
        if _is_ours(mesh):
            properties.sync(mesh)


HANDLERS = (
    ("depsgraph_update_post", sync_after_change),
    ("undo_post", sync_all),
    ("redo_post", sync_all),
    ("load_post", sync_all),
)


def register() -> None:
    for name, handler in HANDLERS:
        getattr(bpy.app.handlers, name).append(handler)


def unregister() -> None:
    for name, handler in HANDLERS:
        getattr(bpy.app.handlers, name).remove(handler)
