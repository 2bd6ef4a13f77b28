# SPDX-License-Identifier: GPL-3.0-or-later
"""Orbifold Unwrap: cones and signature -> the UV map `Orbifold`."""

from __future__ import annotations

import bpy

from .. import core, properties
from .embedding import mesh_problem
from .writing import UVOperator


def unwrap_problem(context: bpy.types.Context) -> str | None:
    problem = mesh_problem(context)
    if problem is None and not properties.default_signature(context.active_object.data):
        problem = "Pick at least two cones first: select vertices in edit mode and use Add Cones"
    return problem


class UV_OT_orbifold_unwrap(UVOperator, bpy.types.Operator):
    bl_idname = "uv.orbifold_unwrap"
    bl_label = "Orbifold Unwrap"
    bl_description = (
        "Map the whole mesh one to one onto the orbifold of its cones, into the UV map Orbifold, which is created or "
        "replaced; other UV maps stay as they are"
    )
    bl_options = {"REGISTER", "UNDO"}

    problem = staticmethod(unwrap_problem)

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "signature")
        if getattr(self, "_extra_borders", 0) > 0 or self.holes not in ("mesh", "refuse"):
            layout.prop(self, "holes")
        layout.prop(self, "weights")
        row = layout.row()
        row.active = self.weights in ("conformal", "cotan", "delaunay")
        row.prop(self, "clamp")
        self.draw_writing(_geometry(self.signature))


def _geometry(signature: str) -> str | None:
    try:
        return core.geometry_of(signature)
    except core.OrbifoldError:
        return None


CLASSES = (UV_OT_orbifold_unwrap,)
