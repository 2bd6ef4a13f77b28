# SPDX-License-Identifier: GPL-3.0-or-later
"""Orbifold Unwrap: cones and signature -> the UV map `Orbifold`, of every object in edit mode. What happens to one of
them is in unwrapping.py; cones that are missing are suggested there."""

from __future__ import annotations

from typing import Optional

import bpy
from bpy.props import BoolProperty

from .. import blender_mesh, core
from ..unwrapping import EXPECTED, Settings, Unwrapping, warnings
from .jobs import JobOperator, report_failure, select_culprits
from .writing import UVOperator

GEOMETRIES = ("euclidean", "spherical", "hyperbolic")


class UV_OT_orbifold_unwrap(UVOperator, bpy.types.Operator):
    bl_idname = "uv.orbifold_unwrap"
    bl_label = "Orbifold Unwrap"
    bl_description = (
        "Map the whole mesh one to one onto the orbifold of its cones, into the UV map Orbifold, which is created or "
        "replaced; other UV maps stay as they are. Where no cone is picked, the best ones are placed first; a single "
        "cone is kept, and the others are placed around it. Of a mesh in several components those that have cones are "
        "unwrapped, each by itself"
    )
    bl_options = {"REGISTER", "UNDO"}

    flat: BoolProperty(
        name="Plane Only",
        description="Where cones are suggested for any signature: only those of the plane, over whose tile an image "
        "repeats. Without this also those of the sphere and of the hyperbolic plane",
        default=True,
    )

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "signature")
        if getattr(self, "_searched", False):
            layout.prop(self, "flat")
        if getattr(self, "_extra_borders", 0) > 0 or self.holes not in ("mesh", "refuse"):
            layout.prop(self, "holes")
        self.draw_weights()
        self.draw_writing(_geometry(self.signature))

    # ------------------------------------------------------------- the stages, of all objects instead of one

    def settings_of(self, mesh: bpy.types.Mesh) -> Settings:
        charts = {geometry: getattr(self, f"chart_{geometry}") for geometry in GEOMETRIES}
        return Settings(
            signature=self.signature, weights=self.weights, clamp=self.clamp, holes=self.holes_of(mesh), flat=self.flat,
            charts=charts, mark_seams=self.mark_seams, sphere_key=self.sphere_key, pattern=self.pattern,
        )

    def _start(self, context: bpy.types.Context) -> bool:
        self._left: list[Unwrapping] = []
        self._ready: list[Unwrapping] = []
        self._failures: list[tuple[bpy.types.Object, Exception]] = []
        objects = blender_mesh.edited(context)
        self._several = len(objects) > 1
        with blender_mesh.object_mode(context.active_object):
            for obj in objects:
                try:
                    self._left.append(Unwrapping(obj, self.settings_of(obj.data)))
                except EXPECTED as error:
                    self._failures.append((obj, error))
            active = context.active_object
            known = next((work.arrays for work in self._left if work.obj == active), None)
            self._arrays = known or blender_mesh.read_mesh(active.data)
        pieces = [piece for work in self._left for piece in work.pieces]
        self._searched = any(piece.missing is not None and piece.missing.signature is None for piece in pieces)
        mirrors = [(len(piece.surface.loops), _mirrors(piece.signature)) for piece in pieces]
        self._extra_borders = max((loops - count for loops, count in mirrors), default=0)
        if not self._start_next():
            self._report_failures(context)
            return False
        return True

    def _start_next(self) -> bool:
        """The first job of the next object that has one."""
        while self._left:
            try:
                self._job = self._left[0].start()
                return True
            except EXPECTED as error:
                self._failures.append((self._left.pop(0).obj, error))
        return False

    def _proceed(self, context: bpy.types.Context) -> Optional[set[str]]:
        job, self._job = self._job, None
        work = self._left[0]
        try:
            self._job = work.proceed(job)
            if self._job is not None:
                return None
            self._ready.append(work)
        except EXPECTED as error:
            if isinstance(error, core.OrbifoldError) and error.status == "ORB_CANCELLED":
                report_failure(self, context, self._arrays, error)
                return {"CANCELLED"}
            self._failures.append((work.obj, error))
        self._left.pop(0)
        return None if self._start_next() else self._write(context)

    def _write(self, context: bpy.types.Context) -> set[str]:
        """All is computed. Objects that failed stay as they are."""
        if not self._ready:
            self._report_failures(context)
            return {"CANCELLED"}
        said, warned = [], []
        with blender_mesh.object_mode(context.active_object):
            for work in self._ready:
                work.write()
                said.append(f"{work.obj.name}: {work.message()}" if self._several else work.message())
                warned += warnings(work.obj)
            for obj, error in self._failures:
                self._select(context, obj, error)
        if self._failures:
            warned.insert(0, "Not unwrapped, and as before: " + " ".join(self._sentences()))
        self.report({"WARNING" if warned else "INFO"}, " ".join(warned + said))
        return {"FINISHED"}

    def _report_failures(self, context: bpy.types.Context) -> None:
        if not self._several:
            report_failure(self, context, self._arrays, self._failures[0][1])
            return
        for obj, error in self._failures:
            self._select(context, obj, error)
        self.report({"ERROR"}, "No object was unwrapped. " + " ".join(self._sentences()))

    def _sentences(self) -> list[str]:
        return [f"{obj.name}: {str(error).rstrip('.')}." for obj, error in self._failures]

    def _select(self, context: bpy.types.Context, obj: bpy.types.Object, error: Exception) -> None:
        if isinstance(error, core.OrbifoldError):
            with blender_mesh.object_mode(obj):
                select_culprits(context, obj, blender_mesh.read_mesh(obj.data), error)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if len(blender_mesh.edited(context)) > 1:  # each object has a signature and a choice of its own
            return JobOperator.invoke(self, context, event)
        return super().invoke(context, event)


def _mirrors(signature: str) -> int:
    try:
        return core.parse_signature(signature).n_mirrors
    except core.OrbifoldError:
        return 0


def _geometry(signature: str) -> str | None:
    try:
        return core.geometry_of(signature)
    except core.OrbifoldError:
        return None


CLASSES = (UV_OT_orbifold_unwrap,)
