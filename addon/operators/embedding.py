# SPDX-License-Identifier: GPL-3.0-or-later
"""What every operator that computes an embedding does: read the mesh, run the library's job (modal, or waiting for
it), write the result or select what is wrong. Subclasses say what to write."""

from __future__ import annotations

import time
from typing import Optional

import bpy
import numpy as np

from .. import arrangement, blender_mesh, cones, core, properties

INTERVAL = 0.05  # seconds between two looks at the job


def mesh_problem(context: bpy.types.Context, modes: tuple[str, ...] = ("EDIT", "OBJECT")) -> Optional[str]:
    """Why no operator of ours can run here; None where it can."""
    obj = context.active_object
    if obj is None or obj.type != "MESH":
        return "Make a mesh object active first"
    if obj.mode not in modes:
        return "Go to edit mode first" if modes == ("EDIT",) else "Go to edit mode or object mode first"
    if obj.data.library is not None or (obj.library is not None and obj.override_library is None):
        return "The mesh is linked from another file: make it local first"
    return None


def select_culprits(context: bpy.types.Context, arrays: blender_mesh.MeshArrays, error: core.OrbifoldError) -> bool:
    """Select the elements that the error names, and only them, so that edit mode shows them. False: it names none."""
    obj = context.active_object
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


class EmbeddingOperator:
    """Mix-in. `signature` and the settings of the computation; see unwrap.py and sphere.py."""

    signature: bpy.props.StringProperty(
        name="Signature",
        description="Conway's notation, as 442, 22(12), *632 or 4*2: one order for each cone, in the sequence of the "
        "list, and for each mirror corner, along the border. Empty: that of the mesh",
        options={"SKIP_SAVE"},
    )
    weights: bpy.props.EnumProperty(
        name="Weights",
        description="How strongly each edge of the mesh pulls",
        items=(
            ("conformal", "Conformal", "Cotangents of the target's own metric: least angle distortion"),
            ("cotan", "Cotangent", "Those of the mesh, negative ones clamped: the papers' weights, and faster"),
            ("mean-value", "Mean Value", "Positive by themselves, no clamping"),
            ("uniform", "Uniform", "All edges alike: ignores the shape of the triangles"),
            ("delaunay", "Delaunay", "Cotangents on the intrinsic Delaunay triangulation, positive by themselves"),
            ("mean-value-exact", "Mean Value, Exact", "Floater's weights as they stand, not symmetric: plane only"),
        ),
        default="conformal",
    )
    clamp: bpy.props.FloatProperty(
        name="Clamp",
        description="Least cotangent weight. Smaller is more conformal, but thin triangles may collapse",
        default=0.01,
        min=1e-6,
        max=1.0,
        precision=4,
    )

    holes: bpy.props.EnumProperty(
        name="Holes",
        description="What to do with borders of the mesh that the signature has no mirror for",
        items=(("mesh", "As in the Sidebar", "The choice that is kept with the mesh"), *properties.HOLES),
        default="mesh",
        options={"SKIP_SAVE"},
    )

    # ----------------------------------------------------------------------------- what subclasses provide

    problem = staticmethod(mesh_problem)  # of a context: the sentence why the operator cannot run; None where it can

    def prepare(self, context: bpy.types.Context) -> None:
        """Checks before a long computation; raises BlenderMeshError."""

    def compute(self, result: core.Result) -> object:
        """What can fail or take long, before anything is written: OrbifoldError leaves the mesh as it is."""
        return None

    def write(self, context: bpy.types.Context, result: core.Result, computed: object) -> str:
        """Writes to the object (in object mode) and returns the sentence to report."""
        raise NotImplementedError

    # ------------------------------------------------------------------------------------------ the stages

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        problem = cls.problem(context)
        if problem is not None:
            cls.poll_message_set(problem)
        return problem is None

    def _start(self, context: bpy.types.Context) -> bool:
        obj = context.active_object
        with blender_mesh.object_mode(obj):
            self._arrays = blender_mesh.read_mesh(obj.data)
        self._surface = core.topology_of(self._arrays.triangles)
        try:
            self.prepare(context)
            self._job = self.start(obj.data)
        except (core.OrbifoldError, blender_mesh.BlenderMeshError) as error:
            self._fail(context, error)
            return False
        return True

    def start(self, mesh: bpy.types.Mesh) -> core.EmbeddingJob:
        """The orbifold of the mesh's cones; with its corners in turn along the border."""
        picked = cones.read_cones(mesh)
        self._cones = [cone.vertex for cone in picked]
        self._text = self.signature or properties.default_signature(mesh)
        self._changed = self._text != mesh.orbifold.signature
        read = core.parse_signature(self._text)
        places = arrangement.arrange(self._cones, self._surface, read.n_mirrors == len(self._surface.loops))
        sequence = places.matched(read) or range(len(picked))
        holes = mesh.orbifold.holes if self.holes == "mesh" else self.holes
        self._extra_borders = len(self._surface.loops) - read.n_mirrors
        return core.start_embedding(
            self._arrays.vertices, self._arrays.triangles, self._text, [self._cones[place] for place in sequence],
            weights=self.weights, clamp=self.clamp, holes=holes,
        )

    def _fail(self, context: bpy.types.Context, error: Exception) -> None:
        sentence = str(error).rstrip(".")
        if isinstance(error, core.OrbifoldError):
            if error.status == "ORB_CANCELLED":
                self.report({"INFO"}, "Orbifold: cancelled, nothing was changed.")
                return
            if select_culprits(context, self._arrays, error) and context.active_object.mode != "EDIT":
                sentence += "; edit mode shows it selected"
        self.report({"ERROR"}, f"{sentence[:1].upper()}{sentence[1:]}.")

    def _finish(self, context: bpy.types.Context) -> set[str]:
        job, self._job = self._job, None
        obj = context.active_object
        try:
            result = job.finish()
            computed = self.compute(result)
            with blender_mesh.object_mode(obj):
                if self._changed:
                    self._write_orders(obj.data, result)
                message = self.write(context, result, computed)
        except (core.OrbifoldError, blender_mesh.BlenderMeshError) as error:
            self._fail(context, error)
            return {"CANCELLED"}
        self.report({"INFO"}, message)
        return {"FINISHED"}

    def _write_orders(self, mesh: bpy.types.Mesh, result: core.Result) -> None:
        orders = dict(zip(result.cones.tolist(), result.orders.tolist()))
        cones.write_cones(mesh, [cones.Cone(vertex, orders[vertex]) for vertex in self._cones])
        properties.write_signature(mesh, self._text)

    # ------------------------------------------------------------------------- waiting: scripts and redo

    def execute(self, context: bpy.types.Context) -> set[str]:
        if not self._start(context):
            return {"CANCELLED"}
        window_manager = context.window_manager
        window_manager.progress_begin(0, 100)
        try:
            done = False
            while not done:
                _, fraction, done = self._job.poll()
                window_manager.progress_update(100 * fraction)
                if not done:
                    time.sleep(0.2 * INTERVAL)
        finally:
            window_manager.progress_end()
        return self._finish(context)

    # -------------------------------------------------------------------------- modal: a person at a window

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        mesh = context.active_object.data
        if not self.signature:
            self.signature = properties.default_signature(mesh)
        if self.holes == "mesh":
            self.holes = mesh.orbifold.holes
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
        if not done and event.type != "ESC":
            return {"RUNNING_MODAL"}
        self._close(context)
        return self._finish(context)

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender ends the operator (another file is loaded, the window closes)."""
        self._job = None  # dropping a job cancels it
        self._close(context)

    def _close(self, context: bpy.types.Context) -> None:
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)
