# SPDX-License-Identifier: GPL-3.0-or-later
"""An ordinary UV map for a mesh: Blender's Smart UV Project, of all faces, whatever is selected or hidden."""

from __future__ import annotations

import bpy
import numpy as np

from . import blender_mesh

NAME = "Baked"  # of the new UV map


def projected(obj: bpy.types.Object, margin: float) -> np.ndarray:
    """(loops, 2) of islands so far apart, in the unit square; the object stays as it is. In object mode."""
    view_layer = bpy.context.view_layer
    active, selected = view_layer.objects.active, list(bpy.context.selected_objects)
    copy = bpy.data.objects.new(obj.name, obj.data.copy())
    bpy.context.scene.collection.objects.link(copy)
    try:
        mesh = copy.data
        while mesh.uv_layers:
            mesh.uv_layers.remove(mesh.uv_layers[0])
        mesh.uv_layers.new(name=NAME)
        for other in selected:
            other.select_set(False)
        copy.select_set(True)
        view_layer.objects.active = copy
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.reveal()
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.uv.smart_project(island_margin=margin)
        bpy.ops.object.mode_set(mode="OBJECT")
        return blender_mesh.read_uv(mesh, NAME)
    finally:
        bpy.data.meshes.remove(copy.data)  # and the object
        for other in selected:
            other.select_set(True)
        view_layer.objects.active = active
