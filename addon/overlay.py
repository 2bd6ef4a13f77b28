# SPDX-License-Identifier: GPL-3.0-or-later
"""Cones and the cut, drawn in the 3D view and (in edit mode) in the UV editor.

What is drawn is read from a mesh when it has changed, not at each redraw: a handler notes which meshes were changed
(`notice_changes`), and only the vertices and edges that are drawn are read again. Undo, redo and loading forget all.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Optional

import blf
import bmesh
import bpy
import gpu
import numpy as np
from bpy.app.handlers import persistent
from bpy_extras.view3d_utils import location_3d_to_region_2d
from gpu_extras.batch import batch_for_shader
from mathutils import Matrix, Vector

from . import layouts, legend, pattern, surface

RADIUS, ACTIVE_RADIUS = 6.5, 8.5  # of a cone, in points of the interface
RIM = 1.5
LINE = 3.0  # width of a path
HIDDEN = 0.22  # opacity of what lies behind something
NEARER, CONES_NEARER = 0.004, 0.015  # by which part of its distance a thing is drawn nearer, lest the surface hide it
TEXT_SIZE = 13
CORNERS = 20  # of a drawn disk


@dataclass
class _Drawn:
    """What is known of one object."""

    cones: tuple = ()  # (vertex, order) of each
    places: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))  # of the cones, in the object's coordinates
    normals: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))
    colours: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))  # of the cones
    hues: int = 0  # from which these were taken
    cut_key: Optional[tuple] = None
    edges: np.ndarray = field(default_factory=lambda: np.zeros((0, 2), int))  # (s, 2) vertices, the cut's
    edge_indices: list = field(default_factory=list)  # (s,)
    paths: np.ndarray = field(default_factory=lambda: np.zeros(0, int))  # (s,)
    segments: np.ndarray = field(default_factory=lambda: np.zeros((0, 2, 3)))
    sides: Optional[tuple] = None  # in the UV editor: (2 s, 2, 2) ends, (2 s,) paths; cones' places (., 2), numbers
    batch: Optional[dict[float, gpu.types.GPUBatch]] = None  # of the segments, for each opacity


class _State:
    handles: list = []
    known: dict = {}  # name of the object -> _Drawn
    changed: set = set()  # names of objects and meshes
    lists: dict = {}  # (scene, view layer) -> names of the objects with cones


# ------------------------------------------------------------------------------------------------ what changed


@persistent
def notice_changes(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    _State.lists.clear()
    for update in depsgraph.updates:
        if update.is_updated_geometry:
            _State.changed.add((type(update.id.original).__name__, update.id.name_full))


@persistent
def forget(*_arguments: object) -> None:
    _State.known.clear()
    _State.changed.clear()
    _State.lists.clear()


def redraw() -> None:
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in ("VIEW_3D", "IMAGE_EDITOR"):
                area.tag_redraw()


def _objects(context: bpy.types.Context) -> Iterator[bpy.types.Object]:
    """Those with cones, or a cut, that this 3D view shows."""
    key = (context.scene.name_full, context.view_layer.name)
    if key not in _State.lists:
        _State.lists[key] = [
            obj.name for obj in context.view_layer.objects
            if obj.type == "MESH" and (len(obj.data.orbifold.cones) or layouts.has_layout(obj.data))
        ]
        for name in set(_State.known) - {name for names in _State.lists.values() for name in names}:
            del _State.known[name]
    space = context.space_data
    for name in _State.lists[key]:
        obj = context.view_layer.objects.get(name)
        if obj is None or obj.type != "MESH" or not obj.visible_get(view_layer=context.view_layer):
            continue
        if space.type == "VIEW_3D" and not obj.visible_in_viewport_get(space):
            continue
        yield obj


def _compared(objects: list[bpy.types.Object]) -> tuple[list[bpy.types.Object], int]:
    """Of the objects those that are selected and have cones, where they are several, as for Orbifold Transfer; and how
    many cones the one with the most has."""
    found = [obj for obj in objects if obj.select_get() and len(obj.data.orbifold.cones)]
    return (found, max(len(obj.data.orbifold.cones) for obj in found)) if len(found) > 1 else ([], 0)


def _drawn(context: bpy.types.Context, obj: bpy.types.Object, hues: int = 0) -> _Drawn:
    """What is to be drawn for an object, up to date. `hues`: the colours of its cones are the first ones of at least so
    many."""
    known = _State.known.get(obj.name)
    mesh = obj.data
    cones = tuple((item.vertex, item.order) for item in mesh.orbifold.cones)
    counts = surface.counts(mesh)
    cut_key = (counts, len(mesh.orbifold.layouts), mesh.orbifold.unwraps)
    names = {("Object", obj.name_full), ("Mesh", mesh.name_full)}
    if known is not None and known.cones == cones and known.cut_key == cut_key and not names & _State.changed:
        if known.hues != hues:
            known.colours, known.hues = _cone_colours(mesh, known.cones, hues), hues
        return known
    if known is None or known.cut_key != cut_key or not mesh.is_editmode:
        known = _Drawn(cut_key=cut_key)
        known.edge_indices, known.edges, known.paths = _read_cut(mesh)
    known.cones = cones if all(vertex < counts[0] for vertex, _ in cones) else ()
    known.colours, known.hues = _cone_colours(mesh, known.cones, hues), hues
    _read_places(context, obj, known)
    known.sides = known.batch = None
    _State.known[obj.name] = known
    for name in names:
        _State.changed.discard(name)
    return known


def _cone_colours(mesh: bpy.types.Mesh, cones: tuple, hues: int) -> np.ndarray:
    """Those of the pattern, which follow the sequence of the signature: that of the list, but for corners. After a
    change of the list it is no more that of the last unwrap. Of at least so many hues, for another mesh may have more
    cones: equal places have equal colours."""
    colours = pattern.palette(max(len(cones), hues, pattern.LEAST_CENTRES))
    latest = layouts.latest(mesh)
    places = layouts.cone_places(latest) if latest is not None else {}
    inside = [places.get(item.vertex, -1) for item in mesh.orbifold.cones if not item.mirror]
    if set(places) != {vertex for vertex, _ in cones} or inside != sorted(inside):
        return colours[: len(cones)]
    return np.array([colours[places[vertex]] for vertex, _ in cones]).reshape(-1, 3)


def path_colours(count: int) -> np.ndarray:
    """(count, 3) between the hues of the cones, paler."""
    return 0.25 + 0.75 * pattern.palette(2 * count)[1::2]


def _read_cut(mesh: bpy.types.Mesh) -> tuple[list, np.ndarray, np.ndarray]:
    """Indices (s,), vertices (s, 2) and paths (s,) of the cut's edges."""
    if not mesh.is_editmode:
        return layouts.read_cut(mesh)
    bm = bmesh.from_edit_mesh(mesh)
    layer = bm.edges.layers.int.get(layouts.PATH_ATTRIBUTE)
    if layer is None:
        return [], np.zeros((0, 2), int), np.zeros(0, int)
    found = [(number, edge.verts[0].index, edge.verts[1].index, layouts.path_of(edge[layer]))
             for number, edge in enumerate(bm.edges) if edge[layer]]
    rows = np.array(found, int).reshape(-1, 4)
    return rows[:, 0].tolist(), rows[:, 1:3], rows[:, 3]


def _read_places(context: bpy.types.Context, obj: bpy.types.Object, known: _Drawn) -> None:
    """As the object is seen: with its shape keys and those modifiers that keep the vertices."""
    if obj.mode == "EDIT" and obj.data.is_editmode:
        bm = bmesh.from_edit_mesh(obj.data)
        bm.verts.ensure_lookup_table()
        vertices = bm.verts
    else:
        evaluated = obj.evaluated_get(context.evaluated_depsgraph_get()).data
        same = evaluated is not None and len(evaluated.vertices) == len(obj.data.vertices)
        vertices = (evaluated if same else obj.data).vertices
    known.places = np.array([vertices[vertex].co for vertex, _ in known.cones]).reshape(-1, 3)
    known.normals = np.array([vertices[vertex].normal for vertex, _ in known.cones]).reshape(-1, 3)
    known.segments = np.array([vertices[vertex].co for vertex in known.edges.ravel().tolist()]).reshape(-1, 2, 3)


# --------------------------------------------------------------------------------------------- the 3D view


def _settings(context: bpy.types.Context):
    """None: nothing is to be drawn in this view."""
    space = context.space_data
    if space is None or (space.type == "VIEW_3D" and not space.overlay.show_overlays):
        return None
    return context.scene.orbifold_view


def draw_places() -> None:
    """Paths and cones, in space: dim where something hides them."""
    context = bpy.context
    settings = _settings(context)
    if settings is None or not (settings.show_cones or settings.show_cut):
        return
    objects = list(_objects(context))
    compared, hues = _compared(objects)
    shown = [(obj, _drawn(context, obj, hues if obj in compared else 0)) for obj in objects]
    if not shown:
        return
    seen_from = gpu.matrix.get_model_view_matrix()
    gpu.state.blend_set("ALPHA")
    for depth, opacity in (("NONE", HIDDEN), ("LESS_EQUAL", 1.0)):
        gpu.state.depth_test_set(depth)
        parts = (settings.show_cut, NEARER, _draw_cut), (settings.show_cones, CONES_NEARER, _draw_cones)
        for wanted, part, draw in parts:
            if wanted:
                with gpu.matrix.push_pop():
                    gpu.matrix.load_matrix(_nearer(context, part) @ seen_from)
                    for obj, drawn in shown:
                        draw(context, obj, drawn, opacity)
    gpu.state.depth_test_set("NONE")
    gpu.state.blend_set("NONE")


def _nearer(context: bpy.types.Context, part: float) -> Matrix:
    """To be applied in the viewer's coordinates: to the viewer by this part of the distance, the picture as it was."""
    view = context.region_data
    if view.window_matrix[3][3] == 0:  # in perspective
        return Matrix.Scale(1 - part, 4)
    return Matrix.Translation((0.0, 0.0, part * view.view_distance))


def _draw_cut(context: bpy.types.Context, obj: bpy.types.Object, drawn: _Drawn, opacity: float) -> None:
    if not len(drawn.segments):
        return
    shader = gpu.shader.from_builtin("POLYLINE_FLAT_COLOR")
    if drawn.batch is None:
        drawn.batch = {}
        colours = path_colours(int(drawn.paths.max()) + 1)[drawn.paths]
        for level in (HIDDEN, 1.0):
            levels = np.column_stack([np.repeat(colours, 2, axis=0), np.full(2 * len(colours), level)])
            data = {"pos": _rows(drawn.segments.reshape(-1, 3)), "color": _rows(levels)}
            drawn.batch[level] = batch_for_shader(shader, "LINES", data)
    with gpu.matrix.push_pop():
        gpu.matrix.multiply_matrix(obj.matrix_world)
        shader.bind()
        shader.uniform_float("viewportSize", (context.region.width, context.region.height))
        shader.uniform_float("lineWidth", LINE * _scale(context))
        drawn.batch[opacity].draw(shader)


def _draw_cones(context: bpy.types.Context, obj: bpy.types.Object, drawn: _Drawn, opacity: float) -> None:
    """Disks that face the viewer, of the same size on the screen wherever they are."""
    if not len(drawn.places):
        return
    world = np.array(obj.matrix_world)
    places = drawn.places @ world[:3, :3].T + world[:3, 3]
    view = context.region_data
    sideways = np.array(view.view_matrix.inverted().to_3x3())[:, :2].T  # right and up, in the world
    projection = np.array(view.perspective_matrix)
    depth = places @ projection[3, :3] + projection[3, 3]
    pixel = 2 * np.abs(depth) / (context.region.width * np.linalg.norm(projection[0, :3]))
    active = _active(obj)
    for grown, dark in ((RIM, True), (0.0, False)):
        radii = np.array([ACTIVE_RADIUS if k == active else RADIUS for k in range(len(places))]) + grown
        rims = np.array([[0.96] * 3 if k == active else [0.05] * 3 for k in range(len(places))])
        size = radii * _scale(context) * pixel
        _draw_disks(places, size[:, None, None] * sideways, rims if dark else drawn.colours, opacity)


def _active(obj: bpy.types.Object) -> int:
    """The cone that is highlighted: that of the list, on the mesh that is edited."""
    return obj.data.orbifold.active_cone if obj.mode == "EDIT" else -1


def _draw_disks(places: np.ndarray, axes: np.ndarray, colours: np.ndarray, opacity: float) -> None:
    """About places (k, 3) with half axes (k, 2, 3)."""
    angles = np.linspace(0, 2 * np.pi, CORNERS, endpoint=False)
    ring = np.stack([np.cos(angles), np.sin(angles)], 1)  # (c, 2)
    rim = places[:, None] + ring @ axes  # (k, c, 3)
    fans = np.stack([np.broadcast_to(places[:, None], rim.shape), rim, np.roll(rim, -1, axis=1)], 2)
    rows = np.repeat(np.column_stack([colours, np.full(len(colours), opacity)]), 3 * CORNERS, axis=0)
    shader = gpu.shader.from_builtin("FLAT_COLOR")
    batch_for_shader(shader, "TRIS", {"pos": _rows(fans.reshape(-1, 3)), "color": _rows(rows)}).draw(shader)


def _rows(values: np.ndarray) -> np.ndarray:
    return np.ascontiguousarray(values, np.float32)


def _scale(context: bpy.types.Context) -> float:
    return context.preferences.system.ui_scale or 1.0


def draw_texts() -> None:
    """Orders beside the cones, and where several meshes with cones are selected, for Orbifold Transfer, their places in
    the list; the legend of a heat map."""
    context = bpy.context
    settings = _settings(context)
    if settings is None:
        return
    legend.draw(context)
    if not settings.show_cones:
        return
    view = np.array(context.region_data.view_matrix)
    objects = list(_objects(context))
    compared, hues = _compared(objects)
    for obj in objects:
        drawn = _drawn(context, obj, hues if obj in compared else 0)
        turned = (view[:3, :3] @ np.array(obj.matrix_world)[:3, :3]) @ drawn.normals.T
        for number, (_, order) in enumerate(drawn.cones):
            place = obj.matrix_world @ Vector(drawn.places[number])
            at = location_3d_to_region_2d(context.region, context.region_data, place)
            if at is not None:
                text = f"{number + 1}." if obj in compared else str(order)
                _write(context, at, text, 1.0 if turned[2, number] >= 0 else 0.4)


def _write(context: bpy.types.Context, at: Vector, text: str, opacity: float) -> None:
    scale = _scale(context)
    blf.size(0, TEXT_SIZE * scale)
    blf.enable(0, blf.SHADOW)
    blf.shadow(0, 5, 0.0, 0.0, 0.0, opacity)
    blf.shadow_offset(0, 0, 0)
    blf.color(0, 1.0, 1.0, 1.0, opacity)
    blf.position(0, at[0] + 11 * scale, at[1] + 4 * scale, 0)
    blf.draw(0, text)
    blf.disable(0, blf.SHADOW)


# ------------------------------------------------------------------------------------------- the UV editor


def draw_layout() -> None:
    """Both sides of each path, and the cones, on the layout of the meshes that are edited."""
    context = bpy.context
    settings = _settings(context)
    space = context.space_data
    if settings is None or not space.show_uvedit or not (settings.show_cones or settings.show_cut):
        return
    for obj in context.objects_in_mode_unique_data:
        if obj.type != "MESH" or not obj.data.is_editmode:
            continue
        drawn = _drawn(context, obj)
        if drawn.sides is None:
            drawn.sides = _read_sides(obj.data, drawn)
        _draw_sides(context, settings, drawn)


def _read_sides(mesh: bpy.types.Mesh, drawn: _Drawn) -> tuple:
    bm = bmesh.from_edit_mesh(mesh)
    layer = bm.loops.layers.uv.get(layouts.UV_MAP)
    if layer is None or bm.loops.layers.uv.verify().name != layouts.UV_MAP:  # another UV map is shown
        return np.zeros((0, 2, 2)), np.zeros(0, int), np.zeros((0, 2)), np.zeros(0, int)
    bm.edges.ensure_lookup_table()
    bm.verts.ensure_lookup_table()
    ends, paths = [], []
    for index, path in zip(drawn.edge_indices, drawn.paths.tolist()):
        for loop in bm.edges[index].link_loops:
            ends.append((loop[layer].uv[:], loop.link_loop_next[layer].uv[:]))
            paths.append(path)
    spots = [(number, spot) for number, (vertex, _) in enumerate(drawn.cones)
             for spot in {loop[layer].uv[:] for loop in bm.verts[vertex].link_loops}]
    return (
        np.array(ends).reshape(-1, 2, 2), np.array(paths, int),
        np.array([spot for _, spot in spots]).reshape(-1, 2), np.array([number for number, _ in spots], int),
    )


def _draw_sides(context: bpy.types.Context, settings, drawn: _Drawn) -> None:
    ends, paths, spots, numbers = drawn.sides
    to_region = context.region.view2d.view_to_region
    origin = np.array(to_region(0.0, 0.0, clip=False), float)
    unit = np.array(to_region(1000.0, 1000.0, clip=False), float)  # whole pixels: far apart
    scale = (unit - origin) / 1000.0
    gpu.state.blend_set("ALPHA")
    if settings.show_cut and len(ends):
        shader = gpu.shader.from_builtin("POLYLINE_FLAT_COLOR")
        places = np.concatenate([(origin + ends * scale).reshape(-1, 2), np.zeros((2 * len(ends), 1))], 1)
        colours = np.repeat(path_colours(int(drawn.paths.max()) + 1)[paths], 2, axis=0)
        rows = _rows(np.column_stack([colours, np.ones(len(colours))]))
        shader.bind()
        shader.uniform_float("viewportSize", (context.region.width, context.region.height))
        shader.uniform_float("lineWidth", LINE * _scale(context))
        batch_for_shader(shader, "LINES", {"pos": _rows(places), "color": rows}).draw(shader)
    if settings.show_cones and len(spots):
        places = np.concatenate([origin + spots * scale, np.zeros((len(spots), 1))], 1)
        for grown, dark in ((RIM, True), (0.0, False)):
            axes = (RADIUS + grown) * _scale(context) * np.tile(np.eye(2, 3), (len(spots), 1, 1))
            colours = np.full((len(spots), 3), 0.05) if dark else drawn.colours[numbers]
            _draw_disks(places, axes, colours, 1.0)
        for place, number in zip(places, numbers.tolist()):
            _write(context, place, str(drawn.cones[number][1]), 1.0)
    gpu.state.blend_set("NONE")


# --------------------------------------------------------------------------------------------- registration

HANDLERS = (
    ("depsgraph_update_post", notice_changes),
    ("undo_post", forget),
    ("redo_post", forget),
    ("load_post", forget),
)


def register() -> None:
    for name, handler in HANDLERS:
        getattr(bpy.app.handlers, name).append(handler)
    for space, function, kind in (
        (bpy.types.SpaceView3D, draw_places, "POST_VIEW"),
        (bpy.types.SpaceView3D, draw_texts, "POST_PIXEL"),
        (bpy.types.SpaceImageEditor, draw_layout, "POST_PIXEL"),
    ):
        _State.handles.append((space, space.draw_handler_add(function, (), "WINDOW", kind)))


def unregister() -> None:
    for space, handle in _State.handles:
        space.draw_handler_remove(handle, "WINDOW")
    _State.handles.clear()
    for name, handler in HANDLERS:
        getattr(bpy.app.handlers, name).remove(handler)
    forget()
