# SPDX-License-Identifier: GPL-3.0-or-later
"""What every operator that runs jobs of the library does: read the mesh, start a job, wait for it (modal, with progress
and Esc, or in the background), and write what came out, or select what is wrong. Subclasses say which job and what to
write; they may start another job after the first."""

from __future__ import annotations

import time
from typing import Optional, Union

import bpy
import numpy as np

from .. import blender_mesh, core

INTERVAL = 0.05  # seconds between two looks at the job


ADVICE = {
    ("EDIT",): "Go to edit mode first",
    ("EDIT", "OBJECT"): "Go to edit mode or object mode first",
    ("OBJECT", "TEXTURE_PAINT"): "Go to object mode or texture paint mode first",
    ("EDIT", "OBJECT", "TEXTURE_PAINT"): "Go to edit mode, object mode or texture paint mode first",
}


def mesh_problem(context: bpy.types.Context, modes: tuple[str, ...] = ("EDIT", "OBJECT")) -> Optional[str]:
    """Why no operator of ours can run here; None where it can."""
    obj = context.active_object
    if obj is None or obj.type != "MESH":
        return "Make a mesh object active first"
    if obj.mode not in modes:
        return ADVICE[modes]
    if obj.data.library is not None or (obj.library is not None and obj.override_library is None):
        return "The mesh is linked from another file: make it local first"
    return None


def select_culprits(
    context: bpy.types.Context, obj: bpy.types.Object, arrays: blender_mesh.MeshArrays, error: core.OrbifoldError
) -> bool:
    """Select the elements that the error names, and only them, so that edit mode shows them. False: it names none."""
    if error.element not in ("vertex", "edge", "triangle") or not error.elements:
        return False
    nothing = np.zeros(0, np.int64)
    with blender_mesh.object_mode(obj):
        mesh = obj.data
        vertices, edges, polygons = nothing, nothing, nothing
        if error.element == "vertex":
            vertices = np.asarray(error.elements, np.int64)
            vertices = vertices[(vertices >= 0) & (vertices < len(mesh.vertices))]
        elif error.element == "edge":
            pairs = np.asarray(error.elements, np.int64).reshape(-1, 2)
            pairs = pairs[((pairs >= 0) & (pairs < len(mesh.vertices))).all(1)]
            found = blender_mesh.edge_indices(mesh, pairs)
            edges = found[found >= 0]
            if len(edges) < len(found):  # a diagonal inside a face: its two ends are shown
                vertices = pairs[found < 0].ravel()
        else:
            polygons = np.unique(arrays.polygons[np.asarray(error.elements, np.int64)])
        mode = (bool(len(vertices)), not len(vertices) and bool(len(edges)), bool(len(polygons)))
        context.tool_settings.mesh_select_mode = mode
        blender_mesh.select_elements(mesh, vertices, edges, polygons)
    return True


def report_failure(
    operator: bpy.types.Operator, context: bpy.types.Context, arrays: blender_mesh.MeshArrays, error: Exception
) -> None:
    """One sentence, and the culprits selected."""
    sentence = str(error).rstrip(".")
    if isinstance(error, core.OrbifoldError):
        if error.status == "ORB_CANCELLED":
            operator.report({"INFO"}, "Orbifold: cancelled, nothing was changed.")
            return
        obj = context.active_object
        if select_culprits(context, obj, arrays, error) and obj.mode != "EDIT":
            safe = blender_mesh.is_safe_to_edit(obj.data)
            sentence += "; edit mode shows it selected" if safe else "; Check Mesh lists it with a mend"
    operator.report({"ERROR"}, f"{sentence[:1].upper()}{sentence[1:]}.")


class WithProblem:
    """Mix-in: an operator that says why it is grey."""

    problem = staticmethod(mesh_problem)  # of a context: the sentence why the operator cannot run; None where it can

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        problem = cls.problem(context)
        if problem is not None:
            cls.poll_message_set(problem)
        return problem is None


class JobOperator(WithProblem):
    """Mix-in. The arrays and the topology of the mesh are in `self._arrays` and `self._surface` from the start on."""

    # ----------------------------------------------------------------------------- what subclasses provide

    def prepare(self, context: bpy.types.Context) -> None:
        """Checks before a long computation; raises BlenderMeshError."""

    def start(self, context: bpy.types.Context) -> core.Job:
        """The first job. Raises OrbifoldError or BlenderMeshError."""
        raise NotImplementedError

    def proceed(self, context: bpy.types.Context, job: core.Job) -> Union[core.Job, str]:
        """`job` is over: finish it, and give the next one, or write to the object and return the sentence to report.
        What it raises leaves the mesh as it is."""
        raise NotImplementedError

    # ------------------------------------------------------------------------------------------ the stages

    def _start(self, context: bpy.types.Context) -> bool:
        obj = context.active_object
        with blender_mesh.object_mode(obj):
            self._arrays = blender_mesh.read_mesh(obj.data)
        self._surface = core.topology_of(self._arrays.triangles)
        try:
            self.prepare(context)
            self._job = self.start(context)
        except (core.OrbifoldError, blender_mesh.BlenderMeshError) as error:
            report_failure(self, context, self._arrays, error)
            return False
        return True

    def _proceed(self, context: bpy.types.Context) -> Optional[set[str]]:
        """The job is over. None: there is another one to wait for."""
        job, self._job = self._job, None
        try:
            outcome = self.proceed(context, job)
        except (core.OrbifoldError, blender_mesh.BlenderMeshError) as error:
            report_failure(self, context, self._arrays, error)
            return {"CANCELLED"}
        if isinstance(outcome, core.Job):
            self._job = outcome
            return None
        self.report({"INFO"}, outcome)
        return {"FINISHED"}

    # ------------------------------------------------------------------------- waiting: scripts and redo

    def execute(self, context: bpy.types.Context) -> set[str]:
        if not self._start(context):
            return {"CANCELLED"}
        window_manager = context.window_manager
        window_manager.progress_begin(0, 100)
        try:
            ended = None
            while ended is None:
                _, fraction, done = self._job.poll()
                window_manager.progress_update(100 * fraction)
                if done:
                    ended = self._proceed(context)
                else:
                    time.sleep(0.2 * INTERVAL)
        finally:
            window_manager.progress_end()
        return ended

    # -------------------------------------------------------------------------- modal: a person at a window

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        if bpy.app.background or context.window is None:
            return self.execute(context)
        if not self._start(context):
            return {"CANCELLED"}
        window_manager = context.window_manager
        self._timer = window_manager.event_timer_add(INTERVAL, window=context.window)
        window_manager.progress_begin(0, 100)
        window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type == "ESC":
            self._job.cancel()
        elif event.type != "TIMER":
            return {"RUNNING_MODAL"}
        stage, fraction, done = self._job.poll()
        context.window_manager.progress_update(100 * fraction)
        context.workspace.status_text_set(f"{self.bl_label}: {stage}, {fraction:.0%}    Esc: Cancel")
        ended = self._proceed(context) if done or event.type == "ESC" else None
        if ended is None:
            return {"RUNNING_MODAL"}
        self._close(context)
        return ended

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender ends the operator (another file is loaded, the window closes)."""
        self._job = None  # dropping a job cancels it
        self._close(context)

    def _close(self, context: bpy.types.Context) -> None:
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)
        for area in context.screen.areas:  # the sidebars: nothing else tells them of our properties
            area.tag_redraw()
