# SPDX-License-Identifier: GPL-3.0-or-later
"""Fixed-Boundary Unwrap: a disk onto a convex polygon, its border by length (Tutte's embedding)."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

from .. import arrangement, blender_mesh, cones, core, surface
from .jobs import mesh_problem
from .writing import UVOperator


def border_problem(context: bpy.types.Context) -> str | None:
    problem = mesh_problem(context)
    if problem is None and not surface.glance(context.active_object.data).loops:
        problem = "The mesh has no border to fix to a polygon: delete a face"
    return problem


class UV_OT_orbifold_fixed_boundary(UVOperator, bpy.types.Operator):
    bl_idname = "uv.orbifold_fixed_boundary"
    bl_label = "Fixed-Boundary Unwrap"
    bl_description = (
        "Map a mesh with one border one to one onto a regular polygon, into the UV map Orbifold: the border goes to "
        "the polygon's sides by its length, the picked mirror corners, where there are three or more, to its corners"
    )
    bl_options = {"REGISTER", "UNDO"}

    geometry: EnumProperty(
        name="Geometry",
        items=(
            ("euclidean", "Plane", "A polygon in the plane"),
            ("spherical", "Sphere", "A polygon of great circles"),
            ("hyperbolic", "Hyperbolic Plane", "A polygon of hyperbolic lines"),
        ),
    )
    use_picks: BoolProperty(
        name="Picked Corners",
        description="The vertices of the list that lie on the border go to the polygon's corners",
        default=True,
    )
    sides: IntProperty(
        name="Sides", description="Of the polygon, where no corners are picked", default=4, min=3, soft_max=64, max=4096
    )
    radius: FloatProperty(
        name="Radius",
        description="From the polygon's middle to its corners, in the geometry; 0: as large as suits it",
        default=0.0,
        min=0.0,
        soft_max=3.0,
    )

    problem = staticmethod(border_problem)

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        for name in ("geometry", "use_picks", "sides"):
            layout.prop(self, name)
        if self.geometry != "euclidean":
            layout.prop(self, "radius")
        if getattr(self, "_extra_borders", 0) > 0:
            layout.prop(self, "holes")
        self.draw_weights()
        self.draw_writing(self.geometry)

    def start(self, context: bpy.types.Context) -> core.Job:
        mesh = context.active_object.data
        self._text = None  # no signature
        self._extra_borders = len(self._surface.loops) - 1
        picked = [cone.vertex for cone in cones.read_cones(mesh)]
        loops = self._surface.loops
        if not loops:
            raise blender_mesh.BlenderMeshError("The mesh has no border to fix to a polygon: delete a face")
        if self.chart_euclidean != "conformal":
            self.chart_euclidean = "conformal"  # a polygon has no lattice
        corners: list[int] = []
        if self.use_picks:
            places = arrangement.arrange(picked, self._surface, False)
            border = max(places.borders, key=len, default=())
            corners = [picked[place] for place in border] if len(border) >= 3 else []
        polygon = core.Polygon(self.geometry, n=len(corners) or self.sides, radius=self.radius)
        return core.start_embedding(
            *(self._arrays.vertices, self._arrays.triangles, None, corners),
            weights=self.weights, clamp=self.clamp, holes=self.holes_of(mesh), polygon=polygon,
        )

    def name_of(self, result: core.Result) -> str:
        return "Fixed boundary"


CLASSES = (UV_OT_orbifold_fixed_boundary,)
