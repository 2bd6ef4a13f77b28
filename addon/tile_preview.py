# SPDX-License-Identifier: GPL-3.0-or-later
"""An object that shows a layout's tile among its copies. Its mesh is the tile, and beside it a loose vertex for each
copy, with the motion as attributes; a modifier of geometry nodes sets instances of the tile there. In the Poincaré
disk motions are no motions of space: there the nodes move the points of the instances."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Matrix, Vector
from mathutils.geometry import delaunay_2d_cdt

from . import blender_mesh, layouts, tile_copies
from .core.charts import to_complex

TILE_OF = "orbifold_tile_of"  # custom property of the preview: the name of the object
IS_COPY, TURN, SCALE, MIDDLE = "orbifold_copy", "orbifold_turn", "orbifold_scale", "orbifold_middle"
MOVED = "orbifold_moved"  # MIDDLE, on the instances
TRIANGLES = 1_500_000  # of all copies in the Poincaré disk, where each has its own when it is drawn
INSIDE = 1500  # vertices inside the tile that is made coarser for this
SIZE = 1.6  # of the preview, in sizes of the object
GAP = 0.25


@dataclass(frozen=True)
class Tile:
    places: np.ndarray  # (n, 3) in space
    triangles: np.ndarray  # (m, 3)
    uv: np.ndarray  # (n, 2)
    slots: np.ndarray  # (m,) of materials


def make_preview(context: bpy.types.Context, obj: bpy.types.Object, arrays: blender_mesh.MeshArrays,
                 layout: layouts.Layout) -> tuple[bpy.types.Object, int]:
    """The preview of this object, new or brought up to date, and the number of copies. In object mode."""
    corners = layout.points[np.isin(arrays.triangles, _corner_vertices(obj.data, layout))]
    usable = np.isfinite(layout.points).all((1, 2))  # beyond the rim of the disk in single precision
    points = layout.points[usable].reshape(-1, 3)
    elements = tile_copies.copies_of(
        layout.generators, layout.curvature, points, _distinct(corners), layout.euler, layout.to_cells
    )
    tile = _tile_of(obj.data, arrays, layout, usable)
    if layout.curvature < 0 and len(tile.triangles) * len(elements) > TRIANGLES:
        tile = _coarser(tile, layout)
    mesh = _mesh_of(f"{obj.name} Tile", tile, elements, layout.curvature)
    for slot in obj.material_slots:
        mesh.materials.append(slot.material)
    return _placed(context, obj, mesh, tile, elements, layout.curvature), len(elements)


def preview_of(context: bpy.types.Context, obj: bpy.types.Object) -> bpy.types.Object | None:
    """The one in the scene, if there is any."""
    return next((one for one in context.scene.objects if one.get(TILE_OF) == obj.name), None)


# ---------------------------------------------------------------------------------------------------- the tile


def _corner_vertices(mesh: bpy.types.Mesh, layout: layouts.Layout) -> np.ndarray:
    """Vertices at which more than two tiles meet, or a tile meets itself: cones, ends of the cut's paths."""
    _, edges, paths = layouts.read_cut(mesh)
    ends = [layout.cones]
    for path in range(int(paths.max(initial=-1)) + 1):
        vertices, count = np.unique(edges[paths == path], return_counts=True)
        ends.append(vertices[count != 2])
    return np.concatenate(ends)


def _distinct(points: np.ndarray) -> np.ndarray:
    points = points[np.isfinite(points).all(1)]
    return np.unique(np.round(points, 6), axis=0) if len(points) else points


def _drawn(points: np.ndarray, curvature: int) -> np.ndarray:
    """(n, 3) places in space: plane and Poincaré disk at z = 0, the unit sphere."""
    if curvature > 0:
        return points
    z = to_complex(points, curvature) * (2 if curvature == 0 else 1)
    return np.column_stack([z.real, z.imag, np.zeros(len(z))])


def _tile_of(mesh: bpy.types.Mesh, arrays: blender_mesh.MeshArrays, layout: layouts.Layout,
             usable: np.ndarray) -> Tile:
    """A vertex for each place that a vertex of the mesh has in the layout."""
    triangles, uv = arrays.triangles[usable], np.float32(layout.uv[usable])
    rows = np.column_stack([triangles.ravel(), uv.reshape(-1, 2).view(np.int32)])
    _, first, place = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    slots = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("material_index", slots)
    return Tile(
        _drawn(layout.points[usable].reshape(-1, 3)[first], layout.curvature), place.reshape(-1, 3),
        uv.reshape(-1, 2)[first].astype(float), slots[arrays.polygons[usable]],
    )


def _coarser(tile: Tile, layout: layouts.Layout) -> Tile:
    """The same region in fewer triangles: all vertices of its border, on which copies meet, and some of those inside.
    Texture coordinates are a function of the place, so that materials look the same."""
    edges = tile.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    keys = edges.min(1).astype(np.int64) * len(tile.places) + edges.max(1)
    _, first, count = np.unique(keys, return_index=True, return_counts=True)
    border = edges[first[count == 1]]
    on_border = np.zeros(len(tile.places), bool)
    on_border[border.ravel()] = True
    inside = np.flatnonzero(~on_border)
    kept = np.concatenate([np.flatnonzero(on_border), inside[:: max(1, len(inside) // INSIDE)]])
    number = np.full(len(tile.places), -1)
    number[kept] = np.arange(len(kept))
    found = delaunay_2d_cdt(
        [Vector(place[:2]) for place in tile.places[kept].tolist()], number[border].tolist(), [], 1, 1e-9
    )
    places = np.column_stack([np.array(found[0]).reshape(-1, 2), np.zeros(len(found[0]))])
    triangles = np.array(found[2]).reshape(-1, 3)
    z = places[:, 0] + 1j * places[:, 1]
    scale = 1 / (1 - np.abs(z) ** 2)
    points = np.stack([2 * z.real * scale, 2 * z.imag * scale, (1 + np.abs(z) ** 2) * scale], -1)
    uv = layout.chart.to_uv(points[None])[0]
    slot = np.bincount(tile.slots).argmax()
    return Tile(places, triangles, uv, np.full(len(triangles), slot, np.int32))


# ------------------------------------------------------------------------------------------- mesh and object


def _mesh_of(name: str, tile: Tile, elements: np.ndarray, curvature: int) -> bpy.types.Mesh:
    places, turns, scales, middles = motions(elements, curvature)
    n, m = len(tile.places), len(tile.triangles)
    mesh = bpy.data.meshes.new(name)
    mesh.vertices.add(n + len(elements))
    mesh.vertices.foreach_set("co", np.concatenate([tile.places, places]).astype(np.float32).ravel())
    blender_mesh.add_triangles(mesh, tile.triangles)
    mesh.polygons.foreach_set("material_index", np.ascontiguousarray(tile.slots, np.int32))
    if curvature > 0:
        mesh.polygons.foreach_set("use_smooth", np.ones(m, bool))
    mesh.update(calc_edges=True)
    blender_mesh.write_uv(mesh, blender_mesh.read_mesh(mesh), tile.uv[tile.triangles])
    flags = np.concatenate([np.zeros(n, bool), np.ones(len(elements), bool)])
    mesh.attributes.new(IS_COPY, "BOOLEAN", "POINT").data.foreach_set("value", flags)
    for attribute, values in ((TURN, turns), (SCALE, scales), (MIDDLE, middles)):
        rows = np.concatenate([np.zeros((n, 3)), values]).astype(np.float32)
        mesh.attributes.new(attribute, "FLOAT_VECTOR", "POINT").data.foreach_set("vector", rows.ravel())
    return mesh


def motions(elements: np.ndarray, curvature: int) -> tuple[np.ndarray, ...]:
    """(g, 3) each: place, rotation (Euler angles), scale of the instances, and where, in the disk, the middle goes, c:
    z becomes w = exp(i turn) z, with z conjugate where the element reflects, and then (w + c) / (1 + conj(c) w)."""
    g = len(elements)
    places, turns, scales, middles = np.zeros((g, 3)), np.zeros((g, 3)), np.ones((g, 3)), np.zeros((g, 3))
    reflects = np.linalg.det(elements) < 0
    if curvature > 0:
        scales[reflects, 2] = -1
        for number, rotation in enumerate(elements * scales[:, None, :]):
            turns[number] = Matrix(rotation.tolist()).to_euler("XYZ")
        return places, turns, scales, middles
    scales[reflects, 1] = -1
    if curvature == 0:
        places[:, :2] = elements[:, :2, 2]
        turns[:, 2] = np.arctan2(elements[:, 1, 0], elements[:, 0, 0])
        return places, turns, scales, middles
    middle = to_complex(elements[:, :, 2], -1)
    probe = np.array([2 * 0.5, 0.0, 1.25]) / 0.75  # z = 1/2
    seen = to_complex(elements @ probe, -1)
    turns[:, 2] = np.angle((seen - middle) / (1 - middle.conj() * seen))
    middles[:, 0], middles[:, 1] = middle.real, middle.imag
    return places, turns, scales, middles


def _placed(context: bpy.types.Context, obj: bpy.types.Object, mesh: bpy.types.Mesh, tile: Tile,
            elements: np.ndarray, curvature: int) -> bpy.types.Object:
    """The preview with this mesh: where it was, or beside the object."""
    low, high = _extent(tile, elements, curvature)
    corners = np.array([obj.matrix_world @ Vector(corner) for corner in obj.bound_box])
    size = max(float(np.ptp(corners, axis=0).max()), 1e-6)
    scale = SIZE * size / max(float((high - low).max()), 1e-9)
    preview = preview_of(context, obj)
    if preview is None:
        preview = bpy.data.objects.new(mesh.name, mesh)
        preview[TILE_OF] = obj.name
        (obj.users_collection or (context.scene.collection,))[0].objects.link(preview)
        if curvature <= 0:
            preview.rotation_euler = (np.pi / 2, 0.0, 0.0)  # upright, as the object is seen from the front
            low, high = low[[0, 2, 1]] * (1, -1, 1), high[[0, 2, 1]] * (1, -1, 1)
        middle = (corners.min(0) + corners.max(0)) / 2
        middle[0] = corners[:, 0].max() + GAP * size + SIZE * size / 2
        preview.location = middle - scale * (low + high) / 2
        preview.modifiers.new("Orbifold Copies", "NODES")
    else:
        old, preview.data = preview.data, mesh
        if not old.users:
            bpy.data.meshes.remove(old)
    preview.scale = (scale, scale, scale)
    modifier = next((one for one in preview.modifiers if one.type == "NODES"), None)
    modifier = modifier or preview.modifiers.new("Orbifold Copies", "NODES")
    modifier.node_group = _nodes(curvature < 0)
    return preview


def _extent(tile: Tile, elements: np.ndarray, curvature: int) -> tuple[np.ndarray, np.ndarray]:
    if curvature:
        size = np.array([1.0, 1.0, 1.0 if curvature > 0 else 0.0])
        return -size, size
    some = tile.places[:: max(1, len(tile.places) // 500)]
    images = (elements @ np.column_stack([some[:, :2], np.ones(len(some))]).T)[:, :2].transpose(0, 2, 1).reshape(-1, 2)
    return np.append(images.min(0), 0.0), np.append(images.max(0), 0.0)


# ---------------------------------------------------------------------------------------------------- the nodes


def _nodes(disk: bool) -> bpy.types.NodeTree:
    """The group of geometry nodes; one for all previews of a kind."""
    name = "Orbifold Disk Copies" if disk else "Orbifold Copies"
    tree = bpy.data.node_groups.get(name)
    if tree is not None and tree.bl_idname == "GeometryNodeTree":
        return tree
    tree = bpy.data.node_groups.new(name, "GeometryNodeTree")
    if hasattr(tree, "is_modifier"):
        tree.is_modifier = True
    blender_mesh.group_socket(tree, "Geometry", "INPUT", "NodeSocketGeometry")
    blender_mesh.group_socket(tree, "Geometry", "OUTPUT", "NodeSocketGeometry")
    build = _Builder(tree)
    entry, end = build.node("NodeGroupInput"), build.node("NodeGroupOutput")
    parts = build.node(
        "GeometryNodeSeparateGeometry", Geometry=entry.outputs[0], Selection=build.named(IS_COPY, "BOOLEAN")
    )
    copies = build.node(
        "GeometryNodeInstanceOnPoints", Points=parts.outputs[0], Instance=parts.outputs[1],
        Rotation=build.named(TURN, "FLOAT_VECTOR"), Scale=build.named(SCALE, "FLOAT_VECTOR"),
    )
    made = copies.outputs[0]
    if disk:
        made = _moved_in_disk(build, made)
    tree.links.new(made, end.inputs[0])
    return tree


def _moved_in_disk(build: "_Builder", instances: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
    """Realized, each point w of a copy at (w + c) / (1 + conj(c) w)."""
    store = build.node("GeometryNodeStoreNamedAttribute")
    store.data_type, store.domain = "FLOAT_VECTOR", "INSTANCE"
    store.inputs["Name"].default_value = MOVED
    build.link(instances, store.inputs["Geometry"])
    build.link(build.named(MIDDLE, "FLOAT_VECTOR"), next(s for s in store.inputs if s.name == "Value" and s.enabled))
    real = build.node("GeometryNodeRealizeInstances", Geometry=store.outputs[0])
    w = build.node("ShaderNodeSeparateXYZ", Vector=build.node("GeometryNodeInputPosition").outputs[0]).outputs
    c = build.node("ShaderNodeSeparateXYZ", Vector=build.named(MOVED, "FLOAT_VECTOR")).outputs
    math = build.math
    top = math("ADD", w[0], c[0]), math("ADD", w[1], c[1])
    under = (
        math("ADD", 1.0, math("ADD", math("MULTIPLY", c[0], w[0]), math("MULTIPLY", c[1], w[1]))),
        math("SUBTRACT", math("MULTIPLY", c[0], w[1]), math("MULTIPLY", c[1], w[0])),
    )
    square = math("ADD", math("MULTIPLY", under[0], under[0]), math("MULTIPLY", under[1], under[1]))
    x = math("ADD", math("MULTIPLY", top[0], under[0]), math("MULTIPLY", top[1], under[1]))
    y = math("SUBTRACT", math("MULTIPLY", top[1], under[0]), math("MULTIPLY", top[0], under[1]))
    place = build.node("ShaderNodeCombineXYZ", X=math("DIVIDE", x, square), Y=math("DIVIDE", y, square))
    return build.node("GeometryNodeSetPosition", Geometry=real.outputs[0], Position=place.outputs[0]).outputs[0]


class _Builder:
    """Adds nodes to a tree, from left to right."""

    def __init__(self, tree: bpy.types.NodeTree) -> None:
        self.tree, self.count = tree, 0

    def node(self, kind: str, **inputs: bpy.types.NodeSocket) -> bpy.types.Node:
        node = self.tree.nodes.new(kind)
        node.location = (180 * self.count, -40 * (self.count % 5))
        self.count += 1
        for name, source in inputs.items():
            self.link(source, node.inputs[name])
        return node

    def link(self, source: bpy.types.NodeSocket, target: bpy.types.NodeSocket) -> None:
        self.tree.links.new(source, target)

    def named(self, name: str, kind: str) -> bpy.types.NodeSocket:
        node = self.node("GeometryNodeInputNamedAttribute")
        node.data_type = kind
        node.inputs["Name"].default_value = name
        return next(socket for socket in node.outputs if socket.enabled)

    def math(self, operation: str, *values: float | bpy.types.NodeSocket) -> bpy.types.NodeSocket:
        node = self.node("ShaderNodeMath")
        node.operation = operation
        for socket, value in zip(node.inputs, values):
            if isinstance(value, float):
                socket.default_value = value
            else:
                self.link(value, socket)
        return node.outputs[0]
