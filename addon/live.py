# SPDX-License-Identifier: GPL-3.0-or-later
"""Orbifold Live: while it is on, the active mesh's UV map follows its cones, orders and signature.

An action first gets the fast weights (cotangents), and if that is done within PATIENCE, before Blender makes the
action's undo step. After a pause the weights of the last unwrap follow. Whatever takes longer, and the pause, is waited
for by one timer, which ends when there is nothing left to wait for.

Nothing here changes modes: a timer may fire while the user drags something. In edit mode values are written to the
layers that an unwrap has made.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Optional

import bpy
import numpy as np
from bpy.app.handlers import persistent

from . import arrangement, blender_mesh, core, cut_paths, faces, layouts, overlay, properties, surface
from .core.charts import DISCONTINUOUS

FAST = "cotan"
PATIENCE = 0.5  # seconds that an action waits for its UVs
LARGE = 60_000  # vertices; above, it does not wait
PAUSE = 0.7  # seconds without an action, before the chosen weights are computed
TICK = 0.03


@dataclass
class _Computing:
    mesh: str  # name_full
    key: tuple  # the state that it is for
    weights: str
    job: core.EmbeddingJob
    arrays: blender_mesh.MeshArrays
    edges: np.ndarray  # (edges, 2)
    progress: float = 0.0


@dataclass
class _Known:
    """Of one mesh."""

    counts: tuple
    arrays: blender_mesh.MeshArrays
    edges: np.ndarray  # (edges, 2)
    surface: core.Topology
    prepared: Optional[core.PreparedMesh]  # None: it is large, and preparing would be waited for


class _State:
    computing: Optional[_Computing] = None
    settle_at: Optional[float] = None  # when to compute with the chosen weights
    due: bool = False  # the state has changed, and nothing was computed yet
    handled: dict[str, tuple] = {}  # mesh -> the state whose UVs it has, or for which there are none
    problems: dict[str, str] = {}  # mesh -> why it has no UVs of its present state
    known: dict[str, _Known] = {}
    expected: set[str] = set()  # meshes that we have just written to: their next update is no change of the surface


def is_on() -> bool:
    return getattr(bpy.context.window_manager, "orbifold_live", False)


def problem(mesh: bpy.types.Mesh) -> Optional[str]:
    """Why the UVs are those of an earlier state; for the panel."""
    return _State.problems.get(mesh.name_full) if is_on() else None


def progress(mesh: bpy.types.Mesh) -> Optional[float]:
    """Of what is computed for the mesh, in [0, 1]; None: nothing is."""
    computing = _State.computing
    return computing.progress if computing is not None and computing.mesh == mesh.name_full else None


# -------------------------------------------------------------------------------------------------- actions


def act(mesh: bpy.types.Mesh) -> None:
    """The mesh's cones, orders or signature have changed: compute, and wait a little for it."""
    obj = _object()
    if not is_on() or obj is None or obj.data != mesh or _state_of(mesh) == _State.handled.get(mesh.name_full):
        return
    _State.due = False
    _start(obj, FAST)
    end = time.perf_counter() + (PATIENCE if surface.counts(mesh)[0] <= LARGE else 0.0)
    while _State.computing is not None and time.perf_counter() < end:
        if not _finish_if_over(obj):
            time.sleep(0.002)
    _wake()


def expect(mesh: bpy.types.Mesh) -> None:
    """What is written to the mesh now leaves its surface as it is."""
    _State.expected.add(mesh.name_full)


def note_written(mesh: bpy.types.Mesh) -> None:
    """The UVs are those of the present state: an operator has written them."""
    _State.computing = _State.settle_at = None
    _State.handled[mesh.name_full] = _state_of(mesh)
    _State.problems.pop(mesh.name_full, None)


def cancel() -> None:
    """Give up what is computed; the UVs stay as they are until the next action."""
    if _State.computing is not None:
        _State.problems[_State.computing.mesh] = "Cancelled: the UVs are those from before"
    _State.computing = _State.settle_at = None


def _object() -> Optional[bpy.types.Object]:
    view_layer = getattr(bpy.context, "view_layer", None)  # none while Blender starts or renders
    obj = view_layer.objects.active if view_layer is not None else None
    return obj if obj is not None and obj.type == "MESH" and obj.mode in ("OBJECT", "EDIT") else None


def _state_of(mesh: bpy.types.Mesh) -> tuple:
    settings = mesh.orbifold
    picked = tuple((item.vertex, item.order) for item in settings.cones)
    return picked, settings.signature, settings.holes


def _weights_of(mesh: bpy.types.Mesh) -> str:
    latest = layouts.latest(mesh)
    return latest.weights if latest is not None else "conformal"


def _start(obj: bpy.types.Object, weights: str) -> None:
    """Start computing for the present state. Where that cannot be, note why."""
    mesh = obj.data
    name, key = mesh.name_full, _state_of(mesh)
    _State.computing = _State.settle_at = None  # dropping a job cancels it
    _State.handled[name] = key
    try:
        signature = properties.default_signature(mesh)
        if not signature:
            raise blender_mesh.BlenderMeshError("There are no cones yet")
        if mesh.is_editmode and blender_mesh.UV_MAP not in mesh.uv_layers:
            raise blender_mesh.BlenderMeshError("Use Orbifold Unwrap once: it makes the UV map that Live updates")
        if not mesh.is_editmode:
            blender_mesh.check_uv_space(mesh)
        known = _read(obj)
        picked = [vertex for vertex, _ in key[0]]
        _State.computing = _Computing(
            name, key, weights,
            core.start_embedding(
                *(known.arrays.vertices, known.arrays.triangles, signature),
                arrangement.in_sequence(picked, known.surface, signature), weights=weights, holes=mesh.orbifold.holes,
                prepared=known.prepared,
            ),
            *(known.arrays, known.edges),
        )
    except (core.OrbifoldError, blender_mesh.BlenderMeshError) as error:
        _fail(name, error)


def _fail(name: str, error: Exception) -> None:
    sentence = str(error).rstrip(".")
    _State.problems[name] = sentence[:1].upper() + sentence[1:]
    overlay.redraw()


def _read(obj: bpy.types.Object) -> _Known:
    """The mesh's arrays and surface: those from before, unless it has changed since (`notice`)."""
    mesh = obj.data
    known, counts = _State.known.get(mesh.name_full), surface.counts(mesh)
    if known is None or known.counts != counts:
        if mesh.is_editmode:
            obj.update_from_editmode()
        arrays = blender_mesh.read_mesh(mesh)
        known = _Known(
            *(counts, arrays, blender_mesh.read_edges(mesh), core.topology_of(arrays.triangles)),
            core.prepare(arrays.vertices, arrays.triangles) if len(arrays.vertices) <= LARGE else None,
        )
        _State.known = {mesh.name_full: known}  # of one mesh only, for it may be large
    return known


# -------------------------------------------------------------------------------------------------- results


def _finish_if_over(obj: bpy.types.Object) -> bool:
    """Write what has been computed for this object, if that is over."""
    computing = _State.computing
    _, computing.progress, over = computing.job.poll()
    if not over:
        return False
    _State.computing = None
    chosen = _weights_of(obj.data)
    if computing.weights == FAST != chosen:
        _State.settle_at = time.perf_counter() + PAUSE
    try:
        result = computing.job.finish()
        _write(obj, computing, result)
    except (core.OrbifoldError, blender_mesh.BlenderMeshError) as error:
        _fail(computing.mesh, error)
        return True
    _State.problems.pop(computing.mesh, None)
    overlay.redraw()
    return True


def _write(obj: bpy.types.Object, computing: _Computing, result: core.Result) -> None:
    mesh, arrays = obj.data, computing.arrays
    latest = layouts.latest(mesh)
    chart = latest.chart if latest is not None and latest.geometry == result.geometry else result.chart
    if arrays.all_triangles and result.refined_from is None and chart not in DISCONTINUOUS:
        embedding = result.embedding[result.corner_copies]
        layout = faces.FaceLayout(chart, result.uv_chart(chart), embedding, result.seams, 0, 0)
    else:
        layout = faces.layout_of(result, arrays, chart)
    paths = cut_paths.number_paths(layout.seams, result.cones)
    mark = latest is None or latest.seams
    expect(mesh)
    if mesh.is_editmode:
        blender_mesh.write_uv_in_edit_mode(mesh, arrays, layout.uv)
        layouts.keep_cut_in_edit_mode(mesh, layout.seams, paths, mark)
    else:
        blender_mesh.write_uv(mesh, arrays, layout.uv)
        if mark:
            blender_mesh.mark_seams(mesh, layout.seams, edges=computing.edges)
        layouts.keep_cut(mesh, layout.seams, paths, computing.edges)
    if computing.weights == FAST != _weights_of(mesh):
        mesh.orbifold.unwraps = (mesh.orbifold.unwraps + 1) % 2**30
    else:
        layouts.keep(mesh, arrays, result, layout, computing.weights, mark)


# --------------------------------------------------------------------------------------------- the one timer


def _wake() -> None:
    if _is_waiting() and not bpy.app.timers.is_registered(_tick):
        bpy.app.timers.register(_tick, first_interval=TICK)


def _is_waiting() -> bool:
    return _State.due or _State.computing is not None or _State.settle_at is not None


def _tick() -> Optional[float]:
    obj = _object()
    if not is_on() or obj is None:
        stop()
        return None
    computing = _State.computing
    if computing is not None and computing.mesh != obj.data.name_full:
        _State.computing = computing = None  # another object is active
    if _State.due:
        act(obj.data)
        _State.due = False
    elif computing is not None:
        if computing.key != _state_of(obj.data):
            act(obj.data)
        else:
            _finish_if_over(obj)
            overlay.redraw()
    elif _State.settle_at is not None and time.perf_counter() >= _State.settle_at:
        _start(obj, _weights_of(obj.data))
    return TICK if _is_waiting() else None


def stop() -> None:
    """Nothing is computed any more, and nothing waits."""
    _State.computing = _State.settle_at = None
    _State.due = False
    if bpy.app.timers.is_registered(_tick):
        bpy.app.timers.unregister(_tick)


# --------------------------------------------------------------------------------------------- what happens


@persistent
def notice(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """Cones may have changed in any way, as by an operator."""
    for update in depsgraph.updates:
        if update.is_updated_geometry and isinstance(update.id, bpy.types.Mesh):
            name = update.id.name_full
            if name in _State.expected:
                _State.expected.discard(name)
            else:
                _State.known.pop(name, None)
    _check()


def _check() -> None:
    obj = _object() if is_on() else None
    if obj is None or _state_of(obj.data) == _State.handled.get(obj.data.name_full):
        return
    _State.due = True
    _wake()


@persistent
def forget(*_arguments: object) -> None:
    """After undo, redo, loading: everything may be different."""
    stop()
    for there in (_State.handled, _State.problems, _State.known, _State.expected):
        there.clear()
    _check()


def _switched(window_manager: bpy.types.WindowManager, _context: bpy.types.Context) -> None:
    forget()
    if not window_manager.orbifold_live:
        overlay.redraw()


HANDLERS = (
    ("depsgraph_update_post", notice),
    ("undo_post", forget),
    ("redo_post", forget),
    ("load_post", forget),
)


def register() -> None:
    bpy.types.WindowManager.orbifold_live = bpy.props.BoolProperty(
        name="Orbifold Live",
        description="The UV map Orbifold of the active mesh follows its cones, their orders and the signature as they "
        "are changed: with cotangent weights at once, with those of the last unwrap after a pause",
        options={"SKIP_SAVE"},
        update=_switched,
    )
    properties.CHANGED.append(act)
    for name, handler in HANDLERS:
        getattr(bpy.app.handlers, name).append(handler)


def unregister() -> None:
    stop()
    for name, handler in HANDLERS:
        getattr(bpy.app.handlers, name).remove(handler)
    properties.CHANGED.remove(act)
    for there in (_State.handled, _State.problems, _State.known, _State.expected):
        there.clear()
    del bpy.types.WindowManager.orbifold_live
