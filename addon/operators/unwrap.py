# SPDX-License-Identifier: GPL-3.0-or-later
"""Orbifold Unwrap: cones and signature -> the UV map `Orbifold`."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty, EnumProperty

from .. import blender_mesh, core, faces, materials, sphere_map
from .embedding import EmbeddingOperator, mesh_problem

PERIODIC = (
    "For repeating images: the unit square is a period of the layout. An image is seamless on the mesh when turning it "
    "about its corner leaves it as it is: by a quarter turn for 442, by half a turn for 2222; by a third for 333 and a "
    "sixth for 632, there with the square drawn as a rectangle 1 : 1.73"
)


def unwrap_problem(context: bpy.types.Context) -> str | None:
    problem = mesh_problem(context)
    if problem is None and len(context.active_object.data.orbifold.cones) < 2:
        problem = "Pick at least two cones first: select vertices in edit mode and use Add Cones"
    return problem


class UV_OT_orbifold_unwrap(EmbeddingOperator, bpy.types.Operator):
    bl_idname = "uv.orbifold_unwrap"
    bl_label = "Orbifold Unwrap"
    bl_description = (
        "Map the whole mesh one to one onto the orbifold of its cones, into the UV map Orbifold, which is created or "
        "replaced; other UV maps stay as they are"
    )
    bl_options = {"REGISTER", "UNDO"}

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
        description="Mark the cut as seams, in place of the one of an earlier Orbifold Unwrap. Your own seams stay",
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

    problem = staticmethod(unwrap_problem)

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "signature")
        layout.prop(self, "weights")
        row = layout.row()
        row.active = self.weights == "cotan"
        row.prop(self, "clamp")
        geometry = _geometry(self.signature)
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
        layout = faces.layout_of(result, self._arrays, getattr(self, f"chart_{result.geometry}"))
        key, missing = None, ""
        if result.geometry == "spherical" and self.sphere_key:
            try:
                key = sphere_map.placed_sphere(result.whole_sphere(), self._arrays)
            except core.OrbifoldError as error:  # the UVs are certified all the same, and not to be lost
                missing = f" No shape key: {error}."
        return layout, key, missing

    def write(self, context: bpy.types.Context, result: core.Result, computed: tuple) -> str:
        layout, key, missing = computed
        obj = context.active_object
        blender_mesh.write_uv(obj.data, self._arrays, layout.uv)
        if self.mark_seams:
            blender_mesh.mark_seams(obj.data, layout.seams)
        if key is not None:
            blender_mesh.write_shape_key(obj, key)
        if self.pattern:
            materials.assign(obj, materials.make_material(obj, result, layout))
        distortion = result.report["distortion"]
        return (
            f"Orbifold {result.signature} ({result.geometry}): a bijection, certified; "
            f"mean angle distortion {distortion['quasi_conformal_mean']:.3f}, "
            f"area spread {distortion['log_area_std']:.2f}.{missing}"
        )


def _geometry(signature: str) -> str | None:
    try:
        return core.geometry_of(signature)
    except core.OrbifoldError:
        return None


CLASSES = (UV_OT_orbifold_unwrap,)
