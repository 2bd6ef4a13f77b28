# SPDX-License-Identifier: GPL-3.0-or-later
"""A material that shows the UV map `Orbifold`: an image with a pattern that the orbifold's group leaves as it is, so
that it crosses the seams without a break (pattern.py)."""

from __future__ import annotations

from typing import Optional

import bpy
import numpy as np

from . import blender_mesh, pattern
from .core import Result
from .faces import FaceLayout, plain_layout

IMAGE_SIZE = 1024
SMALL_LAYOUT = 0.6  # of the unit square; below it, as in the middle of the hyperbolic disk, the image is twice as fine


def make_material(
    obj: bpy.types.Object, result: Result, layout: Optional[FaceLayout] = None, size: Optional[int] = None,
    name_ending: str = "",
) -> bpy.types.Material:
    """A material for the layout that was written to the object (None: `result.uv` as it is), its image packed into
    the file. An earlier one of this object is replaced."""
    if layout is None:
        layout = plain_layout(result)
    pixels = pattern.image(result, layout, size or image_size(layout))
    return image_material(f"Orbifold {obj.name}{name_ending}", pixels, layout.chart)


def image_size(layout: FaceLayout) -> int:
    """Texels along a side of the unit square."""
    extent = np.ptp(layout.uv.reshape(-1, 2), axis=0).max()
    return IMAGE_SIZE if extent > SMALL_LAYOUT else 2 * IMAGE_SIZE


def image_material(name: str, pixels: np.ndarray, chart: str) -> bpy.types.Material:
    """A material that shows pixels (h, w, 4) by the UV map `Orbifold`, which is in this chart; an earlier one of this
    name is replaced."""
    return fill_material(bpy.data.materials.get(name) or bpy.data.materials.new(name), _image(name, pixels), chart)


def fill_material(material: bpy.types.Material, image: bpy.types.Image, chart: str) -> bpy.types.Material:
    """The material, which shows the image by the UV map `Orbifold`, and nothing else."""
    blender_mesh.enable_nodes(material)
    tree = material.node_tree
    tree.nodes.clear()
    output = _node(tree, "ShaderNodeOutputMaterial", 600)
    shader = _node(tree, "ShaderNodeBsdfPrincipled", 300)
    texture = _node(tree, "ShaderNodeTexImage", 0)
    coordinates = _node(tree, "ShaderNodeUVMap", -200)
    coordinates.uv_map = blender_mesh.UV_MAP
    texture.extension = "REPEAT" if chart in pattern.REPEATING else "EXTEND"
    texture.image = image
    shader.inputs["Roughness"].default_value = 0.6
    tree.links.new(coordinates.outputs["UV"], texture.inputs["Vector"])
    tree.links.new(texture.outputs["Color"], shader.inputs["Base Color"])
    tree.links.new(shader.outputs["BSDF"], output.inputs["Surface"])
    return material


def assign(obj: bpy.types.Object, material: bpy.types.Material, faces: Optional[np.ndarray] = None) -> None:
    """Show the material on the whole object, or on these faces; its other materials stay in their slots."""
    materials = obj.data.materials
    if materials.find(material.name) < 0:
        materials.append(material)
    slot = materials.find(material.name)
    polygons = obj.data.polygons
    slots = np.full(len(polygons), slot, np.int32)
    if faces is not None:
        polygons.foreach_get("material_index", slots)
        slots[faces] = slot
    polygons.foreach_set("material_index", slots)
    obj.active_material_index = slot
    obj.data.update()


def _node(tree: bpy.types.NodeTree, kind: str, x: float) -> bpy.types.Node:
    node = tree.nodes.new(kind)
    node.location = (x, 0)
    return node


def _image(name: str, pixels: np.ndarray) -> bpy.types.Image:
    image = bpy.data.images.get(name)
    if image is not None and tuple(image.size) != (pixels.shape[1], pixels.shape[0]):
        bpy.data.images.remove(image)
        image = None
    if image is None:
        image = bpy.data.images.new(name, pixels.shape[1], pixels.shape[0], alpha=False)
    image.pixels.foreach_set(np.ascontiguousarray(pixels, np.float32).ravel())
    image.update()
    image.pack()
    return image
