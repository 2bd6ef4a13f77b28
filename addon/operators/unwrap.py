# SPDX-License-Identifier: GPL-3.0-or-later
"""Orbifold Unwrap: cones and signature -> the UV map `Orbifold`. Cones that are missing are suggested first."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional, Union

import bpy
from bpy.props import BoolProperty

from .. import cones, core, properties, suggestions
from .suggesting import SuggestingOperator
from .writing import UVOperator


@dataclass(frozen=True)
class Missing:
    """What to suggest before a mesh can be unwrapped."""

    signature: Optional[str]  # None: any that is usual for the mesh
    fixed: list[int]  # vertices


def missing_cones(mesh: bpy.types.Mesh, typed: str, surface: core.Topology, holes: str) -> Optional[Missing]:
    """None: the cones are complete, or they do not fit what is typed, which is for the person to mend. A single cone is
    a beginning: it is kept."""
    picked = cones.read_cones(mesh)
    vertices = [cone.vertex for cone in picked]
    if len(picked) > 1:
        return None
    own = properties.arranged(mesh, vertices).text([cone.order for cone in picked])
    if typed and not (picked and typed == own):  # "2" is what a single cone writes by itself
        read = properties.read_signature(typed)
        return Missing(typed, vertices) if read is not None and len(read.orders) > len(picked) else None
    read = properties.read_signature(own if picked else properties.default_signature(mesh))
    whole = read is not None and len(read.orders) == len(picked)
    return None if whole and not (holes == "fill" and surface.loops) else Missing(None, vertices)


class UV_OT_orbifold_unwrap(SuggestingOperator, UVOperator, bpy.types.Operator):
    bl_idname = "uv.orbifold_unwrap"
    bl_label = "Orbifold Unwrap"
    bl_description = (
        "Map the whole mesh one to one onto the orbifold of its cones, into the UV map Orbifold, which is created or "
        "replaced; other UV maps stay as they are. Where no cone is picked, the best ones are placed first; a single "
        "cone is kept, and the others are placed around it"
    )
    bl_options = {"REGISTER", "UNDO"}

    flat: BoolProperty(
        name="Plane Only",
        description="Where cones are suggested for any signature: only those of the plane, which keep angles, and over "
        "whose tile an image repeats. Without this also those that even out areas more, but may shear a great deal",
        default=True,
    )

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "signature")
        missing = getattr(self, "_missing", None)
        if missing is not None and missing.signature is None:
            layout.prop(self, "flat")
        if getattr(self, "_extra_borders", 0) > 0 or self.holes not in ("mesh", "refuse"):
            layout.prop(self, "holes")
        layout.prop(self, "weights")
        row = layout.row()
        row.active = self.weights in ("conformal", "cotan", "delaunay")
        row.prop(self, "clamp")
        self.draw_writing(_geometry(self.signature))

    def prepare(self, context: bpy.types.Context) -> None:
        UVOperator.prepare(self, context)
        mesh = context.active_object.data
        self._suggested: list[core.Suggestion] = []
        self._failed: list[core.OrbifoldError] = []
        typed = self.signature or mesh.orbifold.signature
        self._missing = missing_cones(mesh, typed, self._surface, self.holes_of(mesh))
        if self._missing is not None:
            SuggestingOperator.prepare(self, context)

    def start(self, context: bpy.types.Context) -> core.Job:
        if self._missing is None:
            return super().start(context)
        holes = self.holes_of(context.active_object.data)
        return self.suggesting(self._missing.signature, self._missing.fixed, holes, flat=self.flat)

    def proceed(self, context: bpy.types.Context, job: core.Job) -> Union[core.Job, str]:
        mesh = context.active_object.data
        if isinstance(job, core.SuggestionJob):
            self._suggested = job.finish()
            self._tried = core.worth_trying(self._suggested, self.weights)
            return self._embed_next(mesh)
        try:
            result = job.finish()
        except core.OrbifoldError as error:
            if not self._suggested or error.status not in core.DEPENDS_ON_CONES:
                raise
            self._failed.append(error)
            if len(self._failed) < len(self._tried):
                return self._embed_next(mesh)
            raise self._failed[0] from error
        return self.finish(context, result)

    def _embed_next(self, mesh: bpy.types.Mesh) -> core.EmbeddingJob:
        best = self._tried[len(self._failed)]
        return self.embedding(mesh, best.signature, best.cones)

    def write_cones(self, mesh: bpy.types.Mesh, result: core.Result) -> None:
        if not self._suggested:
            super().write_cones(mesh, result)
            return
        best = self._tried[len(self._failed)]
        suggestions.place(mesh, best.signature, [cones.Cone(*pair) for pair in zip(best.cones, best.orders)])
        suggestions.keep(mesh, self._suggested, self._missing.fixed)

    def write(self, context: bpy.types.Context, result: core.Result, computed: tuple) -> str:
        message = super().write(context, result, computed)
        if self._failed:
            names = " and ".join(one.signature for one in self._tried[: len(self._failed)])
            message += f" {names} could not be embedded: this is the next suggestion."
        return message + (" The cones were suggested: the sidebar lists others." if self._suggested else "")


def _geometry(signature: str) -> str | None:
    try:
        return core.geometry_of(signature)
    except core.OrbifoldError:
        return None


CLASSES = (UV_OT_orbifold_unwrap,)
