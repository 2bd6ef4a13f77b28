# SPDX-License-Identifier: GPL-3.0-or-later
"""Suggest Cones: fills the table in the sidebar. Place Suggestion: a click on one of its rows."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Optional

import bpy
from bpy.props import BoolProperty, EnumProperty, IntProperty

from .. import blender_mesh, core, properties, suggestions
from .jobs import JobOperator, mesh_problem


class SuggestingOperator(JobOperator):
    """Mix-in: operators that start a job of suggestions."""

    def prepare(self, context: bpy.types.Context) -> None:
        obj = context.active_object
        with blender_mesh.object_mode(obj):
            self._keep_away = suggestions.keep_away(obj)

    def suggesting(
        self, signature: Optional[str], fixed: Sequence[int], holes: str, symmetry: str = "detect", flat: bool = False
    ) -> core.SuggestionJob:
        return core.start_suggesting(
            *(self._arrays.vertices, self._arrays.triangles, signature, fixed, self._keep_away),
            flat=flat, holes=holes, symmetry=symmetry,
        )


class MESH_OT_orbifold_suggest_cones(SuggestingOperator, bpy.types.Operator):
    bl_idname = "mesh.orbifold_suggest_cones"
    bl_label = "Suggest Cones"
    bl_description = (
        "Find the cones with which areas are stretched least, for each signature that is usual for the mesh. The "
        "sidebar lists them, best first: click one to place its cones"
    )
    bl_options = {"REGISTER", "UNDO"}

    keep_picked: BoolProperty(
        name="Keep Picked Cones",
        description="The cones that were picked by hand are among those of every suggestion. Those of a suggestion "
        "that was placed are not kept",
        default=True,
    )
    scope: EnumProperty(
        name="Signatures",
        items=(
            ("USUAL", "Usual Ones", "Those that are usual for the mesh's surface"),
            ("FLAT", "Plane Only", "Of the usual ones those over whose tile an image repeats"),
            ("OWN", "The Mesh's Own", "Only the signature that is typed in the sidebar"),
        ),
    )
    symmetry: EnumProperty(
        name="Symmetry",
        items=(
            ("detect", "Detect", "If the mesh has a mirror plane, cones are symmetric too"),
            ("ignore", "Ignore", "Do not look for a mirror plane"),
        ),
    )
    holes: EnumProperty(
        name="Holes",
        description="What to do with borders of the mesh that the signature has no mirror for",
        items=(("mesh", "As in the Sidebar", "The choice that is kept with the mesh"), *properties.HOLES),
        default="mesh",
        options={"SKIP_SAVE"},
    )

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        for name in ("scope", "keep_picked", "symmetry", "holes"):
            layout.prop(self, name)

    def start(self, context: bpy.types.Context) -> core.Job:
        mesh = context.active_object.data
        settings = mesh.orbifold
        if self.scope == "OWN" and not settings.signature:
            raise blender_mesh.BlenderMeshError("The mesh has no signature: type one in the sidebar, or use Usual Ones")
        self._fixed = suggestions.picked_by_hand(mesh) if self.keep_picked else []
        holes = settings.holes if self.holes == "mesh" else self.holes
        signature = settings.signature if self.scope == "OWN" else None
        return self.suggesting(signature, self._fixed, holes, self.symmetry, self.scope == "FLAT")

    def proceed(self, context: bpy.types.Context, job: core.Job) -> str:
        found = job.finish()
        suggestions.keep(context.active_object.data, found, self._fixed)
        best = found[0]
        count = "One suggestion" if len(found) == 1 else f"{len(found)} suggestions, the best"
        return (
            f"{count}: {best.signature} with an area spread of {best.predicted:.2f}. "
            "Click it in the sidebar to place its cones."
        )


class MESH_OT_orbifold_place_suggestion(bpy.types.Operator):
    bl_idname = "mesh.orbifold_place_suggestion"
    bl_label = "Place Suggestion"
    bl_description = "Give the mesh the cones and the signature of a suggestion, in place of those that it has"
    bl_options = {"REGISTER", "UNDO"}

    index: IntProperty(name="Index", description="Row of the table of suggestions", min=0)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        problem = mesh_problem(context)
        if problem is None and not len(context.active_object.data.orbifold.suggestions.rows):
            problem = "There are no suggestions: use Suggest Cones first"
        if problem is None and suggestions.is_stale(context.active_object.data):
            problem = "The mesh has changed since: use Suggest Cones again"
        if problem is not None:
            cls.poll_message_set(problem)
        return problem is None

    @classmethod
    def description(cls, context: bpy.types.Context, settings) -> str:
        rows = context.active_object.data.orbifold.suggestions.rows
        if not 0 <= settings.index < len(rows):
            return cls.bl_description
        row = rows[settings.index]
        count = len(row.picks())
        text = f"Place {'this cone' if count == 1 else f'these {count} cones'}, in place of those that the mesh has. "
        text += f"{core.describe(row.signature)}. The spread is the standard deviation of log area"
        if row.measured:
            text += "; ~ : it was measured on this orbifold's own tile, which does not keep angles"
        return text + ("; the cones are symmetric" if row.symmetric else "")

    def execute(self, context: bpy.types.Context) -> set[str]:
        mesh = context.active_object.data
        rows = mesh.orbifold.suggestions.rows
        if self.index >= len(rows):
            self.report({"ERROR"}, f"There are only {len(rows)} suggestions.")
            return {"CANCELLED"}
        row = rows[self.index]
        suggestions.place(mesh, row.signature, row.picks())
        return {"FINISHED"}


CLASSES = (MESH_OT_orbifold_suggest_cones, MESH_OT_orbifold_place_suggestion)
