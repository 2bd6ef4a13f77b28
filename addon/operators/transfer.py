# SPDX-License-Identifier: GPL-3.0-or-later
"""Orbifold Transfer: data of the active object's mesh -> the other selected ones (transferring.py). Suggest Order: the
landmarks of all in the sequence of a short walk on the first mesh."""

from __future__ import annotations

from typing import Optional

import bpy
from bpy.props import BoolProperty, EnumProperty, StringProperty

from .. import blender_mesh, cones, core, properties, transfer_settings
from ..transferring import Transferring, Wishes, mismatch
from .embedding import WEIGHTS
from .jobs import JobOperator, mesh_problem, report_failure, select_culprits

EXPECTED = (core.OrbifoldError, blender_mesh.BlenderMeshError)


def targets_of(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The selected mesh objects that are not the active one, by name."""
    found = [obj for obj in context.selected_objects if obj.type == "MESH" and obj != context.active_object]
    return sorted(found, key=lambda obj: obj.name)


def transfer_problem(context: bpy.types.Context) -> Optional[str]:
    """Why nothing can be transferred; None where it can."""
    problem = mesh_problem(context)
    if problem is None and context.active_object.mode != "OBJECT":
        problem = "Go to object mode first"
    targets = targets_of(context) if problem is None else []
    if problem is None and not targets:
        problem = "Select the meshes that are to get something too; the active object is the source"
    if problem is None:
        objects = [context.active_object, *targets]
        problem = mismatch([(obj.name, len(obj.data.orbifold.cones)) for obj in objects])
    return problem


class OBJECT_OT_orbifold_transfer(JobOperator, bpy.types.Operator):
    bl_idname = "object.orbifold_transfer"
    bl_label = "Orbifold Transfer"
    bl_description = (
        "Give the other selected meshes what the active one has: each point of theirs is mapped to a point of the "
        "active mesh, one to one and without a seam, landmarks to landmarks. The landmarks are the cones, which "
        "correspond by their places in the lists"
    )
    bl_options = {"REGISTER", "UNDO"}

    problem = staticmethod(transfer_problem)

    groups: BoolProperty(**transfer_settings.GROUPS)
    colours: BoolProperty(**transfer_settings.COLOURS)
    attributes: BoolProperty(**transfer_settings.ATTRIBUTES)
    uv_maps: BoolProperty(**transfer_settings.UV_MAPS)
    cut_seams: BoolProperty(**transfer_settings.CUT_SEAMS)
    texture: BoolProperty(**transfer_settings.TEXTURE)
    form: BoolProperty(**transfer_settings.FORM)
    form_back: BoolProperty(**transfer_settings.FORM_BACK)
    shape_keys: BoolProperty(**transfer_settings.SHAPE_KEYS)
    heat: BoolProperty(**transfer_settings.HEAT)
    heat_area: BoolProperty(**transfer_settings.HEAT_AREA)
    signature: StringProperty(**transfer_settings.SIGNATURE)
    weights: EnumProperty(**WEIGHTS)

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        for name in (*transfer_settings.NAMES, "weights"):
            transfer_settings.draw(layout, self, name)

    # ------------------------------------------------------------------- the stages, of all meshes instead of one

    def wishes(self) -> Wishes:
        return Wishes(weights=self.weights, **{name: getattr(self, name) for name in transfer_settings.NAMES})

    def _start(self, context: bpy.types.Context) -> bool:
        self._work = Transferring(context.active_object, targets_of(context), self.wishes())
        try:
            self._job = self._work.start()
        except EXPECTED as error:
            self._fail(context, error)
            return False
        return True

    def _proceed(self, context: bpy.types.Context) -> Optional[set[str]]:
        job, self._job = self._job, None
        try:
            self._job = self._work.proceed(job)
        except EXPECTED as error:
            self._fail(context, error)
            return {"CANCELLED"}
        if self._job is not None:
            return None
        self._work.write()
        if any(len(outcome.crossing) for outcome in self._work.outcomes):  # they are selected
            context.tool_settings.mesh_select_mode = (False, False, True)
        self.report({"WARNING" if self._work.warned else "INFO"}, self._work.message())
        return {"FINISHED"}

    def _fail(self, context: bpy.types.Context, error: Exception) -> None:
        """Elements that are the reason are selected on the mesh that has them."""
        obj, named = self._work.at, isinstance(error, core.OrbifoldError) and error.status != "ORB_CANCELLED"
        if named and obj != context.active_object:
            select_culprits(context, obj, blender_mesh.read_mesh(obj.data), error)
            error = blender_mesh.BlenderMeshError(str(error))
        report_failure(self, context, blender_mesh.read_mesh(context.active_object.data), error)


class OBJECT_OT_orbifold_suggest_order(bpy.types.Operator):
    bl_idname = "object.orbifold_suggest_order"
    bl_label = "Suggest Order"
    bl_description = (
        "Put the landmarks of the active mesh into the sequence of a short walk through them, and those of the other "
        "selected meshes likewise. In what way the map winds around the landmarks follows from this sequence"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        problem = transfer_problem(context)
        if problem is None and not len(context.active_object.data.orbifold.cones):
            problem = "The mesh has no cones: select vertices in edit mode and use Add Cones"
        if problem is not None:
            cls.poll_message_set(problem)
        return problem is None

    def execute(self, context: bpy.types.Context) -> set[str]:
        objects = [context.active_object, *targets_of(context)]
        arrays = blender_mesh.read_mesh(objects[0].data)
        lists = [cones.read_cones(obj.data) for obj in objects]
        try:
            sequence = core.landmark_sequence(arrays.vertices, arrays.triangles, [one.vertex for one in lists[0]])
        except core.OrbifoldError as error:
            report_failure(self, context, arrays, error)
            return {"CANCELLED"}
        for obj, own in zip(objects, lists):
            chosen = [own[place] for place in sequence.tolist()]
            properties.set_cones(obj.data, [cone.vertex for cone in chosen], [cone.order for cone in chosen])
        if sequence.tolist() == sorted(sequence.tolist()):
            self.report({"INFO"}, "The landmarks are in the sequence of a short walk already.")
        return {"FINISHED"}


CLASSES = (OBJECT_OT_orbifold_transfer, OBJECT_OT_orbifold_suggest_order)
