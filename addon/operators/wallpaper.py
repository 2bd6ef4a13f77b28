# SPDX-License-Identifier: GPL-3.0-or-later
"""New images with the symmetry of a layout of the plane, and their preview on the mesh: from the patterns, and from any
picture."""

from __future__ import annotations

from typing import Optional

import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from .. import (
    blender_mesh, core, formulas, image_pixels, layouts, materials, procedural, symmetric_image, textures, wallpapers,
)
from .viewing import LayoutOperator

SIZE = dict(
    name="Size", description="Texels along the image's lower side; for signatures with thirds of turns the image is "
    "1.73 times as high as it is wide", default=2048, min=16, max=8192,
)
Painted = tuple[str, np.ndarray, Optional[bpy.types.Image]]  # a name, (h, w, 4), and the image it is to be like


class WallpaperOperator(LayoutOperator):
    """Mix-in: a new image, which becomes the object's material."""

    def show(self, context: bpy.types.Context, obj: bpy.types.Object, arrays: blender_mesh.MeshArrays,
             layout: layouts.Layout) -> str:
        symmetry = symmetric_image.symmetry_of(obj.name, layout)
        width, height = self.size, symmetry.height_for(self.size)
        try:
            wallpaper = symmetry.wallpaper(width, height)
            name, pixels, like = self.painted(layout, wallpaper, symmetry.sides)
            if like is None or not like.is_float:
                pixels = np.rint(255 * np.clip(pixels, 0, 1)).astype(np.uint8)
            wallpaper.symmetrize(pixels, "tile")
        except core.OrbifoldError as error:
            raise blender_mesh.BlenderMeshError(str(error)) from error
        image = textures.new_image(f"{name} {layout.signature}", pixels, like)
        material = bpy.data.materials.new(image.name)
        materials.show_image(material, image, "REPEAT")
        materials.assign(obj, material)
        said = "copies are equal"
        if not wallpaper.exact:
            scale = 1 if pixels.dtype == np.uint8 else 255
            off = scale * wallpapers.difference(pixels, wallpaper.motions[1:])
            said = f"copies differ by {off:.2g} of 255 in the mean, as they are interpolated"
        return f"{image.name}, {width} x {height} texels: {said}."


class OBJECT_OT_orbifold_pattern_image(WallpaperOperator, bpy.types.Operator):
    bl_idname = "object.orbifold_pattern_image"
    bl_label = "Pattern Image"
    bl_description = (
        "Make an image with a pattern that crosses the seams without a break, to paint on, and give it to the object"
    )

    pattern: EnumProperty(
        name="Pattern", items=[(key, one.name, one.description) for key, one in formulas.PATTERNS.items()]
    )
    size: IntProperty(**SIZE)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        chosen = context.scene.orbifold_view.pattern
        if chosen in formulas.PATTERNS:
            self.pattern = chosen
        return self.execute(context)

    def painted(self, layout: layouts.Layout, wallpaper: core.Wallpaper, _sides: np.ndarray) -> Painted:
        problem = procedural.why_not(self.pattern, layout, layout.to_cells)
        if problem is not None:
            raise blender_mesh.BlenderMeshError(problem)
        pattern = formulas.PATTERNS[self.pattern]
        pixels = wallpapers.of_formula(
            pattern, wallpaper.width, wallpaper.height, layout.lattice[2], procedural.DARK, procedural.LIGHT
        )
        pixels[:, :, :3] = _encoded(pixels[:, :, :3])
        return pattern.name, pixels, None


def _encoded(linear: np.ndarray) -> np.ndarray:
    """sRGB."""
    return np.where(linear < 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 0) ** (1 / 2.4) - 0.055)


class IMAGE_OT_orbifold_wallpaper(WallpaperOperator, bpy.types.Operator):
    bl_idname = "image.orbifold_wallpaper"
    bl_label = "Wallpaper from Image"
    bl_description = (
        "Make an image with the symmetry of the layout from any picture: the part that lies over the tile is repeated "
        "by the group, and blended where it meets itself. The picture stays as it is; the object gets the new one"
    )

    picture: StringProperty(name="Picture", description="The image to cut the tile from")
    size: IntProperty(**SIZE)
    blend: FloatProperty(
        name="Blend", description="How far the tile and its copies are blended with one another. 0: they meet with a "
        "break wherever the picture is not the same", default=0.5, min=0, max=1, subtype="FACTOR",
    )
    whole: BoolProperty(
        name="Whole Picture", description="Stretch the picture over the tile. Off: its proportions are kept, and what "
        "is too wide or too high is cut off",
    )

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop_search(self, "picture", bpy.data, "images")
        for name in ("size", "blend", "whole"):
            layout.prop(self, name)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        if self.picture not in bpy.data.images:
            shown = context.space_data.image if context.area.type == "IMAGE_EDITOR" else None
            self.picture = shown.name if shown is not None else ""
        return context.window_manager.invoke_props_dialog(self)

    def painted(self, layout: layouts.Layout, wallpaper: core.Wallpaper, sides: np.ndarray) -> Painted:
        picture = bpy.data.images.get(self.picture)
        if picture is None:
            raise blender_mesh.BlenderMeshError("Choose a picture: open one in the image editor first")
        problem = image_pixels.problem(picture)
        if problem is not None:
            raise blender_mesh.BlenderMeshError(problem)
        pixels = image_pixels.read_colours(picture)
        return picture.name, wallpapers.of_picture(pixels, wallpaper, layout.uv, sides, self.blend, self.whole), picture


CLASSES = (OBJECT_OT_orbifold_pattern_image, IMAGE_OT_orbifold_wallpaper)
