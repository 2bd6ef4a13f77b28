# SPDX-License-Identifier: GPL-3.0-or-later
"""What operators that write a UV map share: the layouts to choose from, and writing map, seams, shape key, material."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty, EnumProperty

from .. import blender_mesh, core, cut_paths, layouts, live, materials, unwrapping
from .embedding import EmbeddingOperator

PERIODIC = (
    "For repeating images: the unit square is a period of the layout. An image is seamless on the mesh when turning it "
    "about its corner leaves it as it is: by a quarter turn for 442, by half a turn for 2222; by a third for 333 and a "
    "sixth for 632, there with the square drawn as a rectangle 1 : 1.73"
)


class UVOperator(EmbeddingOperator):
    """Mix-in."""

    chart_euclidean: EnumProperty(
        name="Layout",
        description="How the plane is laid out in the UV editor",
        items=(
            ("periodic", "Periodic", PERIODIC),
            ("conformal", "Conformal", "No shear; the layout fills the unit square"),
        ),
    )
    chart_spherical: EnumProperty(
        name="Layout",
        description="How the sphere is laid out in the UV editor",
        items=(
            ("stereographic", "Stereographic", "Angles are kept"),
            ("equirectangular", "Equirectangular", "Longitude and latitude, for environment images"),
            ("octahedral", "Octahedral", "The sphere unfolded to the unit square"),
        ),
    )
    chart_hyperbolic: EnumProperty(
        name="Layout",
        description="How the hyperbolic plane is laid out in the UV editor",
        items=(
            ("poincare", "Poincaré", "Angles are kept; the plane is the disk in the unit square"),
            ("klein", "Klein", "Straight lines are kept; the plane is the disk in the unit square"),
        ),
    )
    mark_seams: BoolProperty(
        name="Mark Seams",
        description="Mark the cut as seams, in place of the one of an earlier Orbifold Unwrap. Your own seams stay. "
        "Without it the cut is drawn all the same",
        default=True,
    )
    sphere_key: BoolProperty(
        name="Sphere Shape Key",
        description="Spherical orbifolds: also add the shape key Orbifold Sphere, the mesh on the whole sphere",
        default=True,
    )
    pattern: BoolProperty(
        name="Pattern Material",
        description="Give the object a material whose pattern crosses the seams without a break, in its last slot",
        default=False,
    )

    def draw_writing(self, geometry: str | None) -> None:
        """The settings of this class that matter in a geometry."""
        layout = self.layout
        if geometry is not None:
            layout.prop(self, f"chart_{geometry}")
        layout.prop(self, "mark_seams")
        if geometry == "spherical":
            layout.prop(self, "sphere_key")
        layout.prop(self, "pattern")

    def prepare(self, context: bpy.types.Context) -> None:
        with blender_mesh.object_mode(context.active_object):
            blender_mesh.check_uv_space(context.active_object.data)

    def compute(self, result: core.Result) -> tuple:
        chart = getattr(self, f"chart_{result.geometry}")
        return unwrapping.laid_out(result, self._arrays, chart, self.sphere_key)

    def write(self, context: bpy.types.Context, result: core.Result, computed: tuple) -> str:
        layout, key, remarks = computed
        obj = context.active_object
        blender_mesh.write_uv(obj.data, self._arrays, layout.uv)
        if self.mark_seams:
            blender_mesh.mark_seams(obj.data, layout.seams)
        layouts.keep(obj.data, self._arrays, result, layout, self.weights, self.mark_seams)
        layouts.keep_cut(obj.data, layout.seams, cut_paths.number_paths(layout.seams, result.cones))
        live.note_written(obj.data)
        if key is not None:
            blender_mesh.write_shape_key(obj, key)
        if self.pattern:
            materials.assign(obj, materials.make_material(obj, result, layout))
        message = unwrapping.described(result, self.name_of(result), remarks)
        return " ".join([message, *unwrapping.warnings(obj)])

    def name_of(self, result: core.Result) -> str:
        return f"Orbifold {result.signature}"
