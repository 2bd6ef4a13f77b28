# SPDX-License-Identifier: GPL-3.0-or-later
"""The image that an object's material shows by a UV map, for transfers; a copy of that material with another one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

import bpy
import numpy as np

from . import blender_mesh, image_pixels, materials


@dataclass(frozen=True)
class Texture:
    material: bpy.types.Material
    node: str  # its name: that of the image texture
    image: bpy.types.Image
    uv_map: str

    def pixels(self) -> np.ndarray:
        """(h, w, 4) as they are kept, from below."""
        width, height = self.image.size
        values = np.empty(4 * width * height, np.float32)
        self.image.pixels.foreach_get(values)
        return values.reshape(height, width, 4)


def node_of(obj: bpy.types.Object) -> Optional[bpy.types.Node]:
    """Of the active material the active image texture, or the first; None where there is none."""
    material = obj.active_material
    pictures = _pictures(material)
    active = material.node_tree.nodes.active if pictures else None
    return next((node for node in pictures if node == active), pictures[0] if pictures else None)


def node_with(obj: bpy.types.Object, image: bpy.types.Image) -> Optional[bpy.types.Node]:
    """The image texture with this image in one of the object's materials, the active one first."""
    materials_of = [obj.active_material, *(slot.material for slot in obj.material_slots)]
    return next((node for material in materials_of for node in _pictures(material) if node.image == image), None)


def _pictures(material: Optional[bpy.types.Material]) -> list[bpy.types.Node]:
    nodes = material.node_tree.nodes if material is not None and material.node_tree is not None else ()
    return [node for node in nodes if node.type == "TEX_IMAGE" and node.image is not None]


def find(obj: bpy.types.Object) -> Texture:
    """BlenderMeshError where the active material has no image texture, or not one that can be read."""
    node = node_of(obj)
    if node is None:
        raise blender_mesh.BlenderMeshError(f"The active material of {obj.name} has no image texture to bake")
    if node.image.source == "TILED" or not all(node.image.size) or node.image.channels != 4:
        raise blender_mesh.BlenderMeshError(
            f"The image {node.image.name} of {obj.name} cannot be read: it has to be one tile, and its file there"
        )
    uv_map = uv_map_of(node, obj.data)
    if uv_map is None:
        raise blender_mesh.BlenderMeshError(f"{obj.name} has no UV map for its image texture")
    return Texture(obj.active_material, node.name, node.image, uv_map)


def uv_map_of(node: bpy.types.Node, mesh: bpy.types.Mesh) -> Optional[str]:
    """That of the node which says where the image is looked up, else the one that is rendered."""
    links = node.inputs["Vector"].links
    named = getattr(links[0].from_node, "uv_map", "") if links else ""
    if named in mesh.uv_layers:
        return named
    return next((layer.name for layer in mesh.uv_layers if layer.active_render), None)


def write(obj: bpy.types.Object, texture: Texture, pixels: np.ndarray, uv_map: str) -> None:
    """The object gets an image of its own, in a copy of the texture's material, on all faces."""
    material_name = f"{texture.material.name} on {obj.name}"
    earlier = bpy.data.materials.get(material_name)
    material = texture.material.copy()
    material.name = material_name
    if earlier is not None:
        earlier.user_remap(material)
        bpy.data.materials.remove(earlier)
        material.name = material_name
    tree = material.node_tree
    node = tree.nodes[texture.node]
    node.image = _image(f"{texture.image.name} on {obj.name}", texture.image, pixels)
    node.extension = "REPEAT"  # layouts may lie beyond the unit square
    coordinates = tree.nodes.new("ShaderNodeUVMap")
    coordinates.location = (node.location[0] - 200, node.location[1])
    coordinates.uv_map = uv_map
    tree.links.new(coordinates.outputs["UV"], node.inputs["Vector"])
    materials.assign(obj, material)


def _image(name: str, like: bpy.types.Image, pixels: np.ndarray) -> bpy.types.Image:
    """An earlier one of this name is replaced."""
    image = bpy.data.images.get(name)
    if image is not None:
        bpy.data.images.remove(image)
    return new_image(name, pixels, like)


def new_image(name: str, pixels: np.ndarray, like: Optional[bpy.types.Image] = None) -> bpy.types.Image:
    """Of pixels (h, w, 4), packed into the file; of the same kind as another one, else with 8 bits."""
    height, width = pixels.shape[:2]
    image = bpy.data.images.new(name, width, height, alpha=True, float_buffer=like is not None and like.is_float)
    if like is not None:
        image.colorspace_settings.name = like.colorspace_settings.name
        image.alpha_mode = like.alpha_mode
    image_pixels.write(image, pixels)
    image.pack()
    return image
