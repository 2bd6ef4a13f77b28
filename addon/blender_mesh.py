# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender meshes <-> NumPy arrays, with the fast calls; the only file that knows how Blender's versions differ.

Everything here reads and writes the mesh of an object that is *not* in edit mode (attribute arrays have length 0
there): wrap it in `object_mode(obj)`. Features are tested for, never version numbers.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import Optional

import bmesh
import bpy
import numpy as np

UV_MAP = "Orbifold"
SHAPE_KEY = "Orbifold Sphere"
# Edges that we, not the user, made seams: they are taken back when the object is unwrapped anew.
CUT_ATTRIBUTE = "orbifold_cut"
# Of edges: 2 p + s for the path p = 1, 2, ... of the cut, s = 1 where the user has made it a seam; 0: not on the cut.
PATH_ATTRIBUTE = "orbifold_path"
MAX_UV_MAPS = 8


class BlenderMeshError(Exception):
    """The mesh cannot take what is to be written; the message says what to do."""


@dataclass(frozen=True)
class MeshArrays:
    """A mesh as triangles, and where each triangle's corners are in it."""

    vertices: np.ndarray  # (n, 3) float64, in the object's own coordinates
    triangles: np.ndarray  # (m, 3) int32 vertices
    loops: np.ndarray  # (m, 3) int32 face corners ("loops")
    polygons: np.ndarray  # (m,) int32 the face that each triangle is a part of
    n_loops: int

    @property
    def all_triangles(self) -> bool:
        return self.n_loops == 3 * len(self.triangles) == 3 * (int(self.polygons.max(initial=-1)) + 1)


# ---------------------------------------------------------------------------------------------------- modes


@contextmanager
def object_mode(obj: bpy.types.Object) -> Iterator[None]:
    """Leave edit mode (and paint modes) for a while and come back, with all objects that are in it together. `obj` need
    not be the active one, but in the view layer where it is in another mode."""
    mode = obj.mode
    if mode == "OBJECT":
        yield
        return
    objects = bpy.context.view_layer.objects
    active = objects.active
    together = [other for other in objects if other.mode == mode and other.type == obj.type]
    if active not in together:
        objects.active = obj
    leader = objects.active
    bpy.ops.object.mode_set(mode="OBJECT")
    try:
        yield
    finally:
        if objects.active is leader:
            _enter(mode, together)
            objects.active = active
        elif objects.active.mode != mode:  # a copy was made and took its place
            bpy.ops.object.mode_set(mode=mode)


def _enter(mode: str, together: list[bpy.types.Object]) -> None:
    """These objects, the active one among them; others that are selected stay as they are, and selected."""
    objects = bpy.context.view_layer.objects
    chosen = {obj: obj in together for obj in objects if (obj in together) != obj.select_get()}
    for obj, wanted in chosen.items():
        obj.select_set(wanted)
    bpy.ops.object.mode_set(mode=mode)
    for obj, wanted in chosen.items():
        obj.select_set(not wanted)


def edited(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The mesh objects in edit mode, of those that share a mesh one only, the active one first; in other modes the
    active object."""
    active = context.active_object
    if active is None or active.mode != "EDIT":
        return [active] if active is not None and active.type == "MESH" else []
    found = {active.data: active} if active.type == "MESH" else {}
    for obj in context.view_layer.objects:
        if obj.type == "MESH" and obj.mode == "EDIT":
            found.setdefault(obj.data, obj)
    return list(found.values())


# -------------------------------------------------------------------------------------------------- reading


def read_vertices(mesh: bpy.types.Mesh) -> np.ndarray:
    """(n, 3) float64; with shape keys, of the one that the others are relative to."""
    if mesh.shape_keys is not None:
        return _key_points(mesh.shape_keys.reference_key, len(mesh.vertices)).astype(np.float64)
    coordinates = np.empty(len(mesh.vertices) * 3, np.float32)
    position = mesh.attributes.get("position")
    if position is not None and len(position.data) == len(mesh.vertices):
        position.data.foreach_get("vector", coordinates)
    else:
        mesh.vertices.foreach_get("co", coordinates)
    return coordinates.reshape(-1, 3).astype(np.float64)


def read_loop_vertices(mesh: bpy.types.Mesh) -> np.ndarray:
    """(loops,) int32: the vertex of each face corner."""
    vertices = np.empty(len(mesh.loops), np.int32)
    corner = mesh.attributes.get(".corner_vert")
    if corner is not None and len(corner.data) == len(mesh.loops):
        corner.data.foreach_get("value", vertices)
    else:
        mesh.loops.foreach_get("vertex_index", vertices)
    return vertices


def read_edges(mesh: bpy.types.Mesh) -> np.ndarray:
    """(edges, 2) int32."""
    edges = np.empty(len(mesh.edges) * 2, np.int32)
    attribute = mesh.attributes.get(".edge_verts")
    if attribute is not None:
        attribute.data.foreach_get("value", edges)
    else:
        mesh.edges.foreach_get("vertices", edges)
    return edges.reshape(-1, 2)


def read_faces(mesh: bpy.types.Mesh) -> tuple[np.ndarray, np.ndarray]:
    """The vertices of all faces, one face after the other (loops,), and how many each has (faces,); in edit mode
    those that were there when it was last left or updated."""
    sizes = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("loop_total", sizes)
    return read_loop_vertices(mesh), sizes


def boundary_vertices(mesh: bpy.types.Mesh) -> np.ndarray:
    """(n,) bool: vertices on an edge of one face only. Not in edit mode."""
    edges = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("edge_index", edges)
    single = np.bincount(edges, minlength=len(mesh.edges)) == 1
    found = np.zeros(len(mesh.vertices), bool)
    found[read_edges(mesh)[single].ravel()] = True
    return found


def read_mesh(mesh: bpy.types.Mesh) -> MeshArrays:
    """Triangles of the whole mesh, hidden faces included. Quads and n-gons are triangulated; the mesh stays."""
    n_loops, n_polygons = len(mesh.loops), len(mesh.polygons)
    loop_vertices = read_loop_vertices(mesh)
    loops, polygons = _triangle_loops(mesh, n_loops, n_polygons)
    return MeshArrays(read_vertices(mesh), loop_vertices[loops], loops, polygons, n_loops)


def _triangle_loops(mesh: bpy.types.Mesh, n_loops: int, n_polygons: int) -> tuple[np.ndarray, np.ndarray]:
    sizes = np.empty(n_polygons, np.int32)
    mesh.polygons.foreach_get("loop_total", sizes)
    if n_loops == 3 * n_polygons and (sizes == 3).all():
        starts = np.empty(n_polygons, np.int32)
        mesh.polygons.foreach_get("loop_start", starts)
        return starts[:, None] + np.arange(3, dtype=np.int32), np.arange(n_polygons, dtype=np.int32)
    if hasattr(mesh, "calc_loop_triangles"):
        mesh.calc_loop_triangles()
    n_triangles = len(mesh.loop_triangles)
    loops = np.empty(n_triangles * 3, np.int32)
    polygons = np.empty(n_triangles, np.int32)
    mesh.loop_triangles.foreach_get("loops", loops)
    mesh.loop_triangles.foreach_get("polygon_index", polygons)
    return loops.reshape(-1, 3), polygons


# -------------------------------------------------------------------------------------------------- writing


def write_uv(
    mesh: bpy.types.Mesh, arrays: MeshArrays, uv: np.ndarray, name: str = UV_MAP, keep_others: bool = False
) -> None:
    """`uv` (m, 3, 2) per triangle corner -> the UV map `name`, created or replaced, and made the active one.

    `keep_others`: corners of other triangles keep what they have in this map or, where it is new, in the active one.
    The triangles of one face must agree at the corners that they share (faces.py sees to it).
    """
    layer = _uv_layer(mesh, name, keep_others)
    corners = _at_loops(arrays, uv)
    if keep_others:
        others = np.ones(arrays.n_loops, bool)
        others[arrays.loops.ravel()] = False
        corners[others] = read_uv(mesh, name)[others]
    _set_uv(layer, corners)
    mesh.uv_layers.active = mesh.uv_layers[name]
    mesh.update()


def write_uv_of_loops(mesh: bpy.types.Mesh, uv: np.ndarray, among: np.ndarray, name: str) -> None:
    """`uv` (loops, 2) of the corners `among` (loops,) bool -> the UV map `name`, created or replaced; the active one
    stays active, and other corners have what they had."""
    active = mesh.uv_layers.active.name if mesh.uv_layers.active is not None else name
    layer = _uv_layer(mesh, name)
    _set_uv(layer, np.where(among[:, None], uv, read_uv(mesh, name)).astype(np.float32))
    mesh.uv_layers.active = mesh.uv_layers[active]
    mesh.update()


def _set_uv(layer: bpy.types.MeshUVLoopLayer, corners: np.ndarray) -> None:
    if hasattr(layer, "uv"):
        if len(corners):
            layer.data[0]  # version 4.3 would write to the map of the mesh that this one was copied from, too
        layer.uv.foreach_set("vector", corners.ravel())
    else:
        layer.data.foreach_set("uv", corners.ravel())


def _at_loops(arrays: MeshArrays, uv: np.ndarray) -> np.ndarray:
    """(loops, 2) float32 of `uv` (m, 3, 2)."""
    corners = np.zeros((arrays.n_loops, 2), np.float32)
    corners[arrays.loops.ravel()] = uv.reshape(-1, 2)
    return corners


def write_uv_in_edit_mode(mesh: bpy.types.Mesh, arrays: MeshArrays, uv: np.ndarray, name: str = UV_MAP) -> None:
    """As `write_uv`, to a UV map that is there, without leaving edit mode. `arrays` were read after the last edit."""
    bm = bmesh.from_edit_mesh(mesh)
    layer = bm.loops.layers.uv.get(name)
    if layer is None:
        raise BlenderMeshError(f"The UV map {name} is gone: use Orbifold Unwrap, which makes it anew")
    corners = _at_loops(arrays, uv)
    pairs = zip(corners[:, 0].tolist(), corners[:, 1].tolist())  # no lists of two, which the garbage collector visits
    for face in bm.faces:
        for loop, pair in zip(face.loops, pairs):
            loop[layer].uv = pair
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)


def add_triangles(mesh: bpy.types.Mesh, triangles: np.ndarray) -> None:
    """Faces (m, 3) of the vertices of a mesh that has none yet; `mesh.update(calc_edges=True)` is the caller's."""
    mesh.loops.add(3 * len(triangles))
    mesh.loops.foreach_set("vertex_index", np.ascontiguousarray(triangles, np.int32).ravel())
    mesh.polygons.add(len(triangles))
    mesh.polygons.foreach_set("loop_start", np.arange(0, 3 * len(triangles), 3, dtype=np.int32))
    with suppress(AttributeError, RuntimeError, TypeError):  # read-only from version 4 on, needed before
        mesh.polygons.foreach_set("loop_total", np.full(len(triangles), 3, np.int32))


def check_uv_space(mesh: bpy.types.Mesh, name: str = UV_MAP) -> None:
    """Raise BlenderMeshError where write_uv could not create its UV map."""
    if name in mesh.uv_layers:
        return
    if len(mesh.uv_layers) >= MAX_UV_MAPS:
        raise BlenderMeshError(f"The mesh has {MAX_UV_MAPS} UV maps, which is all that Blender allows: remove one")
    if name in mesh.attributes:
        raise BlenderMeshError(f'The mesh has an attribute "{name}" that is not a UV map: rename it')


def _uv_layer(mesh: bpy.types.Mesh, name: str, as_active: bool = False):
    check_uv_space(mesh, name)
    if name not in mesh.uv_layers:
        mesh.uv_layers.new(name=name, do_init=as_active)
    return mesh.uv_layers[name]


def read_uv(mesh: bpy.types.Mesh, name: str = UV_MAP) -> np.ndarray:
    """(loops, 2) float32 of one UV map."""
    layer = mesh.uv_layers[name]
    uv = np.empty(len(mesh.loops) * 2, np.float32)
    if hasattr(layer, "uv"):
        layer.uv.foreach_get("vector", uv)
    else:
        layer.data.foreach_get("uv", uv)
    return uv.reshape(-1, 2)


def is_safe_to_edit(mesh: bpy.types.Mesh) -> bool:
    """False where an edge joins a vertex to itself: Blender 5.2 hangs when such a mesh goes to edit mode."""
    edges = read_edges(mesh)
    return not (edges[:, 0] == edges[:, 1]).any()


def edge_indices(mesh: bpy.types.Mesh, pairs: np.ndarray, edges: Optional[np.ndarray] = None) -> np.ndarray:
    """(k,) int64 the edge between each pair of vertices, -1 where there is none. `pairs` (k, 2); `edges`: of
    `read_edges`, where they are at hand."""
    pairs = np.asarray(pairs, np.int64).reshape(-1, 2)
    edges = read_edges(mesh) if edges is None else edges
    named = np.zeros(len(mesh.vertices), bool)
    named[pairs] = True
    among = np.flatnonzero(named[edges[:, 0]] & named[edges[:, 1]])
    if not len(among):
        return np.full(len(pairs), -1, np.int64)
    keys, wanted = _edge_keys(edges[among], len(mesh.vertices)), _edge_keys(pairs, len(mesh.vertices))
    order = np.argsort(keys, kind="stable")
    keys = keys[order]
    place = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
    return np.where(keys[place] == wanted, among[order][place], -1)


def _edge_keys(edges: np.ndarray, n_vertices: int) -> np.ndarray:
    low = np.minimum(edges[:, 0], edges[:, 1]).astype(np.int64)
    high = np.maximum(edges[:, 0], edges[:, 1]).astype(np.int64)
    return low * np.int64(max(n_vertices, 1)) + high


def read_seams(mesh: bpy.types.Mesh) -> np.ndarray:
    """(edges,) bool."""
    seams = np.empty(len(mesh.edges), bool)
    mesh.edges.foreach_get("use_seam", seams)
    return seams


def mark_seams(
    mesh: bpy.types.Mesh,
    pairs: Optional[np.ndarray],
    among: Optional[np.ndarray] = None,
    edges: Optional[np.ndarray] = None,
) -> None:
    """Make the edges between these pairs of vertices seams, and take back those of an earlier call, all of them or
    those between the vertices `among`; the user's own seams stay. None only takes back. `edges`: of `read_edges`, where
    they are at hand."""
    edges = read_edges(mesh) if edges is None else edges
    seams, kept = read_seams(mesh), np.zeros(len(mesh.edges), bool)
    inside = np.full(len(mesh.vertices), among is None)
    inside[among if among is not None else []] = True
    treated = inside[edges[:, 0]] & inside[edges[:, 1]]
    old = mesh.attributes.get(CUT_ATTRIBUTE)
    if old is not None and (old.domain != "EDGE" or old.data_type != "BOOLEAN"):
        mesh.attributes.remove(old)
        old = None
    if old is not None:
        ours = np.empty(len(mesh.edges), bool)
        old.data.foreach_get("value", ours)
        kept = ours & ~treated
        seams &= ~(ours & treated)
    path = read_int_attribute(mesh, PATH_ATTRIBUTE, "EDGE")
    if path is not None:  # the cut may have been changed in edit mode, where the other attribute is out of reach
        seams &= (path == 0) | (path % 2 == 1) | ~treated
    cut = np.zeros(len(mesh.edges), bool)
    if pairs is not None and len(pairs):
        found = edge_indices(mesh, pairs, edges)
        cut[found[found >= 0]] = True
    mesh.edges.foreach_set("use_seam", seams | cut)
    attribute = mesh.attributes.get(CUT_ATTRIBUTE) or mesh.attributes.new(CUT_ATTRIBUTE, "BOOLEAN", "EDGE")
    attribute.data.foreach_set("value", (cut & ~seams) | kept)
    mesh.update()


def read_our_seams(mesh: bpy.types.Mesh) -> np.ndarray:
    """(edges,) bool: seams that `mark_seams` has made."""
    ours, attribute = np.zeros(len(mesh.edges), bool), mesh.attributes.get(CUT_ATTRIBUTE)
    if attribute is not None and attribute.domain == "EDGE" and attribute.data_type == "BOOLEAN":
        attribute.data.foreach_get("value", ours)
    return ours


def split_edges(mesh: bpy.types.Mesh, pairs: np.ndarray) -> None:
    """Cut the mesh open along the edges between these pairs of vertices. Faces and corners keep their sequence."""
    found = edge_indices(mesh, pairs)
    bm = bmesh.new()
    try:
        bm.from_mesh(mesh)
        bm.edges.ensure_lookup_table()
        bmesh.ops.split_edges(bm, edges=[bm.edges[edge] for edge in found[found >= 0].tolist()])
        bm.to_mesh(mesh)
    finally:
        bm.free()
    mesh.update()


def write_shape_key(obj: bpy.types.Object, positions: np.ndarray, name: str = SHAPE_KEY) -> bpy.types.ShapeKey:
    """`positions` (n, 3) in the object's coordinates -> a shape key, created (with the value 0, so that the object
    looks as before) or replaced."""
    mesh = obj.data
    if mesh.shape_keys is None:
        obj.shape_key_add(name="Basis", from_mix=False)
    key = mesh.shape_keys.key_blocks.get(name)
    if key is None:
        key = obj.shape_key_add(name=name, from_mix=False)
        key.value = 0.0  # Blender 5 begins with 1
    flat = np.ascontiguousarray(positions, np.float32).ravel()
    if hasattr(key, "points"):
        key.points.foreach_set("co", flat)
    else:
        key.data.foreach_set("co", flat)
    mesh.update()
    return key


def read_shape_key(obj: bpy.types.Object, name: str = SHAPE_KEY) -> np.ndarray:
    """(n, 3) float32."""
    return _key_points(obj.data.shape_keys.key_blocks[name], len(obj.data.vertices))


def _key_points(key: bpy.types.ShapeKey, n: int) -> np.ndarray:
    flat = np.empty(n * 3, np.float32)
    (key.points if hasattr(key, "points") else key.data).foreach_get("co", flat)
    return flat.reshape(-1, 3)


# ------------------------------------------------------------------------------------------------ attributes


def read_int_attribute(mesh: bpy.types.Mesh, name: str, domain: str = "POINT") -> Optional[np.ndarray]:
    """(n,) int32 of a whole-number attribute of the vertices, or of the edges; None where the mesh has none of this
    name."""
    attribute = mesh.attributes.get(name)
    if attribute is None or attribute.domain != domain or attribute.data_type != "INT":
        return None
    values = np.empty(len(mesh.edges if domain == "EDGE" else mesh.vertices), np.int32)
    attribute.data.foreach_get("value", values)
    return values


def write_int_attribute(mesh: bpy.types.Mesh, name: str, values: np.ndarray, domain: str = "POINT") -> None:
    attribute = mesh.attributes.get(name)
    if attribute is not None and (attribute.domain != domain or attribute.data_type != "INT"):
        mesh.attributes.remove(attribute)
        attribute = None
    if attribute is None:
        attribute = mesh.attributes.new(name, "INT", domain)
    attribute.data.foreach_set("value", np.ascontiguousarray(values, np.int32))


def read_group_weights(mesh: bpy.types.Mesh, group: int) -> np.ndarray:
    """(n,) float64 the weight of each vertex in a vertex group, by the group's index; 0 where it is not a member. There
    is no fast call for these."""
    return np.fromiter(
        (next((member.weight for member in v.groups if member.group == group), 0.0) for v in mesh.vertices),
        np.float64, len(mesh.vertices),
    )


def read_all_group_weights(mesh: bpy.types.Mesh, count: int) -> np.ndarray:
    """(n, count) float64 the weight of each vertex in each of so many vertex groups; 0 where it is not a member."""
    weights = np.zeros((len(mesh.vertices), count))
    for number, vertex in enumerate(mesh.vertices):
        for member in vertex.groups:
            if member.group < count:
                weights[number, member.group] = member.weight
    return weights


def write_group_weights(obj: bpy.types.Object, name: str, weights: np.ndarray, among: np.ndarray) -> None:
    """`weights` (n,) of the vertices `among` (n,) bool -> a vertex group, created or changed; where they are 0 a vertex
    is no member."""
    group = obj.vertex_groups.get(name) or obj.vertex_groups.new(name=name)
    members = among & (weights > 0)
    group.remove(np.flatnonzero(among & ~members).tolist())
    for vertex in np.flatnonzero(members).tolist():
        group.add((vertex,), weights[vertex], "REPLACE")


def check_attribute(mesh: bpy.types.Mesh, name: str, data_type: str, domain: str = "POINT") -> None:
    """Raise BlenderMeshError where there is an attribute of this name that is not of this domain and type."""
    attribute = mesh.attributes.get(name)
    if attribute is not None and (attribute.domain != domain or attribute.data_type != data_type):
        raise BlenderMeshError(f'The mesh has another attribute "{name}": rename it')


# Of types of attributes: what their elements call the value, its width, and what foreach_get takes.
_VALUES = {
    "FLOAT": ("value", 1, np.float32),
    "FLOAT2": ("vector", 2, np.float32),
    "FLOAT_VECTOR": ("vector", 3, np.float32),
    "FLOAT_COLOR": ("color", 4, np.float32),
    "BYTE_COLOR": ("color", 4, np.float32),
    "INT": ("value", 1, np.int32),
    "BOOLEAN": ("value", 1, bool),
}
_OF_BLENDER = {"position", "material_index", "shade_smooth", "sharp_edge", "sharp_face", "custom_normal"}


def plain_attributes(mesh: bpy.types.Mesh) -> list[tuple[str, str, str]]:
    """(name, domain, type) of the attributes of vertices, corners and faces that a person or a tool has made, of the
    types that can be read here: no UV maps, nothing of Blender's own."""
    found = [(attribute.name, attribute.domain, attribute.data_type) for attribute in mesh.attributes]
    return [
        (name, domain, kind) for name, domain, kind in found
        if domain in ("POINT", "CORNER", "FACE") and kind in _VALUES and not name.startswith(".")
        and name not in _OF_BLENDER and name not in mesh.uv_layers
    ]


def read_attribute(mesh: bpy.types.Mesh, name: str) -> np.ndarray:
    """(elements, width) of an attribute; colours are linear."""
    attribute = mesh.attributes[name]
    what, width, kind = _VALUES[attribute.data_type]
    values = np.empty(len(attribute.data) * width, kind)
    attribute.data.foreach_get(what, values)
    return values.reshape(-1, width)


def write_attribute(
    mesh: bpy.types.Mesh, name: str, domain: str, data_type: str, values: np.ndarray, among: np.ndarray
) -> None:
    """`values` (elements, width) of the elements `among` (elements,) bool -> an attribute, created or changed
    (check_attribute)."""
    if name not in mesh.attributes:
        mesh.attributes.new(name, data_type, domain)
    what, _, kind = _VALUES[data_type]
    mixed = np.where(among[:, None], values, read_attribute(mesh, name)).astype(kind)
    mesh.attributes[name].data.foreach_set(what, np.ascontiguousarray(mixed).ravel())
    if what == "color" and mesh.color_attributes.active_color is None:
        mesh.color_attributes.active_color = mesh.color_attributes[name]
    mesh.update()


def write_float_attribute(mesh: bpy.types.Mesh, name: str, values: np.ndarray) -> None:
    """`values` (n,) per vertex -> an attribute, created or replaced (check_attribute)."""
    attribute = mesh.attributes.get(name) or mesh.attributes.new(name, "FLOAT", "POINT")
    attribute.data.foreach_set("value", np.ascontiguousarray(values, np.float32))


def write_vertex_colour(mesh: bpy.types.Mesh, name: str, colour: np.ndarray) -> None:
    """`colour` (n, 4), linear, per vertex -> a colour attribute, created or replaced (check_attribute), and made the
    active one, which the viewport shows."""
    if name not in mesh.attributes:
        mesh.color_attributes.new(name, "FLOAT_COLOR", "POINT")
    mesh.attributes[name].data.foreach_set("color", np.ascontiguousarray(colour, np.float32).ravel())
    mesh.color_attributes.active_color = mesh.color_attributes[name]
    mesh.update()


def write_corner_colour(mesh: bpy.types.Mesh, arrays: MeshArrays, colour: np.ndarray, name: str) -> None:
    """`colour` (m, 3, 4) per triangle corner -> a colour attribute on face corners."""
    corners = np.ones((arrays.n_loops, 4), np.float32)
    corners[arrays.loops.ravel()] = colour.reshape(-1, 4)
    attribute = mesh.attributes.get(name)
    if attribute is not None and (attribute.domain != "CORNER" or attribute.data_type != "FLOAT_COLOR"):
        mesh.attributes.remove(attribute)
        attribute = None
    if attribute is None:
        attribute = mesh.attributes.new(name, "FLOAT_COLOR", "CORNER")
    attribute.data.foreach_set("color", corners.ravel())
    mesh.update()


# ------------------------------------------------------------------------------------------------- selection


def select_elements(mesh: bpy.types.Mesh, vertices: np.ndarray, edges: np.ndarray, polygons: np.ndarray) -> None:
    """Select these and nothing else, uncovering them where they are hidden. Indices of vertices, edges, polygons."""
    chosen = np.zeros(len(mesh.polygons), bool)
    chosen[polygons] = True
    edge_chosen = np.zeros(len(mesh.edges), bool)
    edge_chosen[edges] = True
    loop_total = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("loop_total", loop_total)
    in_chosen = np.repeat(chosen, loop_total)
    loop_edges = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("edge_index", loop_edges)
    edge_chosen[loop_edges[in_chosen]] = True
    vertex_chosen = np.zeros(len(mesh.vertices), bool)
    vertex_chosen[vertices] = True
    vertex_chosen[read_edges(mesh)[edge_chosen].ravel()] = True
    for elements, flags in ((mesh.vertices, vertex_chosen), (mesh.edges, edge_chosen), (mesh.polygons, chosen)):
        hidden = np.empty(len(elements), bool)
        elements.foreach_get("hide", hidden)
        elements.foreach_set("hide", hidden & ~flags)
        elements.foreach_set("select", flags)
    mesh.update()


# ---------------------------------------------------------------------------------------------------- nodes


def principled_input(node: bpy.types.Node, *names: str):
    """The first of the sockets `names` that this version's Principled node has, or None."""
    for name in names:
        if name in node.inputs:
            return node.inputs[name]
    return None


def enable_nodes(material: bpy.types.Material) -> None:
    """From version 5 on a material always has nodes and the switch is deprecated."""
    if material.node_tree is None:
        material.use_nodes = True


def group_socket(tree: bpy.types.NodeTree, name: str, direction: str, socket: str):
    """Add an input or output (`direction` "INPUT" or "OUTPUT") to a node group."""
    if hasattr(tree, "interface"):
        return tree.interface.new_socket(name=name, in_out=direction, socket_type=socket)
    return (tree.inputs if direction == "INPUT" else tree.outputs).new(socket, name)
