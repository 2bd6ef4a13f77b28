# SPDX-License-Identifier: GPL-3.0-or-later
"""Images with the symmetry of a layout: Symmetrize Image, New Symmetric Image."""

from __future__ import annotations

from contextlib import nullcontext

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatVectorProperty, IntProperty, StringProperty

from .. import blender_mesh, core, image_pixels, layouts, materials, painting, symmetric_image
from .jobs import WithProblem, mesh_problem

MODES = ("EDIT", "OBJECT", "TEXTURE_PAINT")
EXPECTED = (core.OrbifoldError, blender_mesh.BlenderMeshError)
SOURCES = (
    ("tile", "From the Tile", "Copies become what the layout's tile has: what is on the mesh stays as it is"),
    ("all", "Average", "All copies of a place become their mean"),
    ("painted", "From Painted", "Copies become what was painted since the last Symmetrize Image, or stroke with "
     "Symmetric Painting; whatever else is on the image stays as it is"),
)


def _without_edit_mode(obj: bpy.types.Object):
    """In paint mode meshes can be read."""
    return blender_mesh.object_mode(obj) if obj.mode == "EDIT" else nullcontext()


class PaintingOperator(WithProblem):
    """Mix-in."""

    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def problem(cls, context: bpy.types.Context) -> str | None:
        problem = mesh_problem(context, MODES)
        if problem is None and not layouts.has_layout(context.active_object.data):
            problem = "The mesh has no layout yet: use Orbifold Unwrap first"
        return problem

    def execute(self, context: bpy.types.Context) -> set[str]:
        painting.forget_layouts()
        try:
            with _without_edit_mode(context.active_object):
                message = self.run(context)
        except EXPECTED as error:
            sentence = str(error).rstrip(".")
            self.report({"ERROR"}, f"{sentence[:1].upper()}{sentence[1:]}.")
            return {"CANCELLED"}
        self.report({"INFO"}, message)
        return {"FINISHED"}


class IMAGE_OT_orbifold_symmetrize(PaintingOperator, bpy.types.Operator):
    bl_idname = "image.orbifold_symmetrize"
    bl_label = "Symmetrize Image"
    bl_description = (
        "Give the image the symmetry of the layout, so that it is seamless on the mesh: the image editor's image, or "
        "that of the active image texture of the active object"
    )

    source: EnumProperty(name="Source", description="What all copies of a place become", items=SOURCES)

    @classmethod
    def problem(cls, context: bpy.types.Context) -> str | None:
        problem = super().problem(context)
        if problem is None:
            image = painting.image_in(context)
            problem = "Show an image on the mesh first: use New Symmetric Image" if image is None else (
                image_pixels.problem(image)
            )
        return problem

    def run(self, context: bpy.types.Context) -> str:
        image = painting.image_in(context)
        symmetry, wallpaper = painting.symmetry_for(image)
        before = image_pixels.read(image)
        painted = None
        if self.source == "painted":
            painted = painting.painted_since(image, before)
            if painted is None:
                raise blender_mesh.BlenderMeshError(
                    f"What was painted on {image.name} is not known: use From the Tile once, or switch Symmetric "
                    "Painting on before you paint"
                )
        after = before.copy()
        wallpaper.symmetrize(after, self.source, painted)
        painting.note_written(image, after)
        if image_pixels.differing(before, after).any():
            image_pixels.write(image, after)
            painting.push_later(image, before, after)
        return f"{image.name}: {symmetric_image.described(symmetry, wallpaper)}."


class IMAGE_OT_orbifold_new(PaintingOperator, bpy.types.Operator):
    bl_idname = "image.orbifold_new"
    bl_label = "New Symmetric Image"
    bl_description = (
        "Make an image of the shape that the layout has, and a material that shows it on the active object, to be "
        "painted on. The image repeats, and its texels are square on the mesh"
    )

    name: StringProperty(name="Name", description="Of image and material", default="Symmetric")
    width: IntProperty(
        name="Width", description="In texels; the height follows from the layout", default=2048, min=4, max=16384,
        subtype="PIXEL",
    )
    colour: FloatVectorProperty(
        name="Colour", description="Of the empty image", subtype="COLOR_GAMMA", size=4, min=0, max=1,
        default=(0.8, 0.8, 0.8, 1),
    )
    float_buffer: BoolProperty(name="32-Bit Float", description="Keep colours with 32 bits a channel", default=False)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        return context.window_manager.invoke_props_dialog(self)

    def run(self, context: bpy.types.Context) -> str:
        obj = context.active_object
        symmetry = painting.symmetry_of(obj)
        height = symmetry.height_for(self.width)
        if height > 32768:
            raise blender_mesh.BlenderMeshError(f"The image would be {height} texels high: make it narrower")
        image = bpy.data.images.new(
            self.name, self.width, height, alpha=True, float_buffer=self.float_buffer
        )
        image.generated_color = self.colour
        material = bpy.data.materials.new(self.name)
        materials.show_image(material, image, "REPEAT")
        materials.assign(obj, material)
        obj.data.uv_layers.active = obj.data.uv_layers[blender_mesh.UV_MAP]
        return f"{image.name}, {self.width} x {height}, is on {obj.name}."


CLASSES = (IMAGE_OT_orbifold_symmetrize, IMAGE_OT_orbifold_new)
