# SPDX-License-Identifier: GPL-3.0-or-later
"""NAME.png: the textured object beside its tile among the tile's images, rendered by Cycles on the CPU.

Everything is built in a scene of its own, in units in which the picture is WIDTH wide at the origin: x to the right,
y away from the camera, z up. The floor is z = 0.
"""

from __future__ import annotations

import contextlib
from dataclasses import dataclass
from pathlib import Path
from typing import Iterator, Sequence

import bpy
import numpy as np
from mathutils import Matrix, Vector

from .. import blender_mesh
from .clip import clip_to_disk
from .tiling import Tiling, drawn

RESOLUTION = (960, 540)
SAMPLES = 16
WIDTH = 4.7
HEIGHT = WIDTH * RESOLUTION[1] / RESOLUTION[0]
LENS = 85.0  # millimetres; the sensor is 36 wide
TILT = np.radians(10.0)  # the camera looks down by this much, so that the floor fills the background
TURNS = (38, -38, 70, -70, 142, -142, 110, -110)  # degrees: ways to see the object, from front and side first
OBJECT_BOX = (2.15, 2.15)  # widest and highest that the object is drawn
PANEL_RADIUS = 1.04
PALENESS = 0.45
OBJECT_X, PANEL_X = -1.13, 1.20
WINDOW = 1.45  # in the plane: the radius of the round window on the tiling, in radii of the tile
DISK_WINDOW = 2.2  # the same in the Poincaré disk, unless all of it can be shown

MIRROR_LINE = 0.014  # half the thickness

FLOOR = (0.52, 0.53, 0.55)


@dataclass(frozen=True)
class Subject:
    obj: bpy.types.Object  # textured
    vertices: np.ndarray  # (n, 3) in the object's coordinates
    cones: Sequence[int]
    tiling: Tiling
    cone_of_corner: Sequence[int]  # which cone (0, 1, ...) each of tiling.cones is a copy of
    colours: np.ndarray  # (cones, 3)
    material: bpy.types.Material
    uv: np.ndarray  # (m, 3, 2) texture coordinates of tiling.triangles


def render_picture(subject: Subject, path: Path) -> None:
    scene = bpy.data.scenes.new("Orbifold Picture")
    _place_object(scene, subject)
    _place_panel(scene, subject)
    _light(scene)
    _aim_camera(scene)
    _render(scene, path)


# ------------------------------------------------------------------------------------------------ the object


def _place_object(scene: bpy.types.Scene, subject: Subject) -> None:
    """The object turned, standing on the floor, as large as its box allows, with a ball at each cone."""
    standing = np.array(subject.obj.matrix_world.to_3x3())
    turned = _best_turn(subject, standing) @ standing
    seen = subject.vertices @ turned.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    size = np.maximum(high - low, 1e-30)
    scale = min(OBJECT_BOX[0] / size[0], OBJECT_BOX[1] / size[2], OBJECT_BOX[0] * 1.3 / size[1])
    origin = np.array([OBJECT_X, 0, 0]) - scale * np.array([(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2]])
    shown = subject.obj.copy()
    shown.matrix_world = Matrix.Translation(origin) @ Matrix((scale * turned).tolist()).to_4x4()
    scene.collection.objects.link(shown)
    for slot in shown.material_slots:
        slot.link = "OBJECT"
        slot.material = _object_material(subject.material)
    for number, cone in enumerate(subject.cones):
        _add_ball(scene, origin + scale * seen[cone], 0.036, subject.colours[number])


def _best_turn(subject: Subject, standing: np.ndarray) -> np.ndarray:
    """The rotation about the vertical that turns most cones towards the camera; the first of TURNS among equals."""
    if not len(subject.cones):
        return np.array(Matrix.Rotation(np.radians(TURNS[0]), 3, "Z"))
    normals = np.array([subject.obj.data.vertices[int(cone)].normal for cone in subject.cones])
    normals = normals @ np.linalg.inv(standing)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True) + 1e-30
    eye = np.array([0, -np.cos(TILT), np.sin(TILT)])
    turns = [np.array(Matrix.Rotation(np.radians(turn), 3, "Z")) for turn in TURNS]
    facing = [int((normals @ turn.T @ eye > 0.1).sum()) for turn in turns]
    return turns[int(np.argmax(facing))]


# ------------------------------------------------------------------------------------------------- the panel


def _place_panel(scene: bpy.types.Scene, subject: Subject) -> None:
    """The tile and its images, turned towards the camera."""
    tiling = subject.tiling
    face = np.array(Matrix.Rotation(np.pi / 2 - TILT, 3, "X"))
    centre = np.array([PANEL_X, 0.0, _middle_height()])
    to_view = _centring(tiling)
    images = [to_view @ element for element in tiling.group]
    radius = 1.0  # of the sphere and of the whole Poincaré disk
    if tiling.curvature <= 0:
        tile_radius = _tile_radius(tiling, images[0])
        radius = WINDOW * tile_radius if tiling.curvature == 0 else min(1.0, DISK_WINDOW * tile_radius)
        furthest = np.linalg.norm(drawn(tiling.curvature, tiling.points @ images[0].T), axis=1).max()
        images = _images_within(tiling, images, radius + furthest)
        _add_backing(scene, centre, face)
    scale = PANEL_RADIUS / radius
    glows = tiling.curvature <= 0
    plain, pale = (_panel_material(subject.material, paleness, glows) for paleness in (0.0, PALENESS))
    for number, image in enumerate(images):
        _add_image(scene, subject, image, face * scale, centre, radius, pale if number else plain,
                   lift=0.0 if number else 0.012)
    towards_camera = -np.array([0, np.cos(TILT), -np.sin(TILT)]) * 0.03
    tile = centre + drawn(tiling.curvature, tiling.points @ images[0].T) @ (face * scale).T
    for corner, number in zip(tiling.cones, subject.cone_of_corner):
        _add_ball(scene, tile[corner] + towards_camera, 0.032, subject.colours[number])
    for on_mirror, thickness in ((False, 0.006), (True, MIRROR_LINE)):
        _add_outline(scene, tile + towards_camera * 0.6, tiling.outline[tiling.mirrors == on_mirror], thickness)


def _middle_height() -> float:
    return HEIGHT / 2 - 0.28


def _centring(tiling: Tiling) -> np.ndarray:
    """The isometry that brings the tile's middle to the origin, or on the sphere to the side that faces the viewer."""
    middle = tiling.points[tiling.triangles].mean(axis=(0, 1))
    if tiling.curvature == 0:
        return np.array([[1, 0, -middle[0]], [0, 1, -middle[1]], [0, 0, 1.0]])
    if tiling.curvature == 1:
        third = middle / np.linalg.norm(middle)
        first = np.cross([0, 1.0, 0] if abs(third[1]) < 0.9 else [1.0, 0, 0], third)
        first /= np.linalg.norm(first)
        return np.stack([first, np.cross(third, first), third])
    x, y, z = middle / np.sqrt(middle[2] ** 2 - middle[0] ** 2 - middle[1] ** 2)
    slant = x * y / (1 + z)
    return np.array([[1 + x * x / (1 + z), slant, -x], [slant, 1 + y * y / (1 + z), -y], [-x, -y, z]])


def _tile_radius(tiling: Tiling, image: np.ndarray) -> float:
    """As drawn: how far the tile's corners are from its middle; all of its points, where there are fewer than three."""
    corners = tiling.cones if len(tiling.cones) >= 3 else np.unique(tiling.outline)
    return float(np.linalg.norm(drawn(tiling.curvature, tiling.points[corners] @ image.T), axis=1).max())


def _images_within(tiling: Tiling, images: list[np.ndarray], reach: float) -> list[np.ndarray]:
    """Those whose middle is drawn within `reach` of the tile's middle, which images[0] takes to the origin."""
    middle = np.linalg.inv(images[0])[:, 2]
    return [image for image in images if np.linalg.norm(drawn(tiling.curvature, (image @ middle)[None])) <= reach]


def _add_backing(scene: bpy.types.Scene, centre: np.ndarray, face: np.ndarray) -> None:
    """A pale disk behind the tiling, seen where no image of the tile was drawn."""
    angles = np.linspace(0, 2 * np.pi, 256, endpoint=False)
    rim = np.stack([np.cos(angles), np.sin(angles), np.full(256, -0.01)], 1) * PANEL_RADIUS
    mesh = bpy.data.meshes.new("Orbifold Backing")
    mesh.from_pydata((centre + rim @ face.T).tolist(), [], [list(range(256))])
    mesh.materials.append(_plain_material("Orbifold Backing", (0.52, 0.52, 0.54), 0.9))
    scene.collection.objects.link(bpy.data.objects.new("Orbifold Backing", mesh))


def _add_image(scene: bpy.types.Scene, subject: Subject, image: np.ndarray, view: np.ndarray, centre: np.ndarray,
               window: float, material: bpy.types.Material, lift: float) -> None:
    """One image of the tile. On the sphere all are instances of one mesh; in the plane and in the Poincaré disk each
    has its own, cut off at the window."""
    tiling = subject.tiling
    if tiling.curvature > 0:
        mesh = bpy.data.meshes.get("Orbifold Tile") or _mesh(
            drawn(1, tiling.points), tiling.triangles, subject.uv, subject.material)
        motion = view @ image * (1 + lift)
        place = centre
    else:
        corners = drawn(tiling.curvature, tiling.points @ image.T)[tiling.triangles][..., :2]
        corners, uv = clip_to_disk(corners, subject.uv, window)
        if len(corners) == 0:
            return
        flat = np.column_stack([corners.reshape(-1, 2), np.zeros(3 * len(corners))])
        mesh = _mesh(flat, np.arange(3 * len(corners)).reshape(-1, 3), uv, material)
        motion = view
        place = centre + lift * view[:, 2] / np.linalg.norm(view[:, 2])
    obj = bpy.data.objects.new("Orbifold Tile", mesh)
    scene.collection.objects.link(obj)
    obj.matrix_world = Matrix.Translation(place) @ Matrix(motion.tolist()).to_4x4()
    obj.material_slots[0].link = "OBJECT"
    obj.material_slots[0].material = material


def _mesh(points: np.ndarray, triangles: np.ndarray, uv: np.ndarray, material: bpy.types.Material) -> bpy.types.Mesh:
    """points (n, 3), triangles (m, 3), uv (m, 3, 2)."""
    mesh = bpy.data.meshes.new("Orbifold Tile")
    n = len(triangles)
    mesh.vertices.add(len(points))
    mesh.vertices.foreach_set("co", np.asarray(points, np.float32).ravel())
    mesh.loops.add(3 * n)
    mesh.loops.foreach_set("vertex_index", np.asarray(triangles, np.int32).ravel())
    mesh.polygons.add(n)
    mesh.polygons.foreach_set("loop_start", np.arange(0, 3 * n, 3, dtype=np.int32))
    with contextlib.suppress(AttributeError, RuntimeError, TypeError):  # read-only from version 4 on, needed before
        mesh.polygons.foreach_set("loop_total", np.full(n, 3, np.int32))
    mesh.polygons.foreach_set("use_smooth", np.ones(n, bool))
    mesh.update(calc_edges=True)
    mesh.materials.append(material)
    blender_mesh.write_uv(mesh, blender_mesh.read_mesh(mesh), uv)
    return mesh


def _add_outline(scene: bpy.types.Scene, tile: np.ndarray, edges: np.ndarray, thickness: float) -> None:
    """A line along these edges (s, 2) of the tile's boundary."""
    curve = bpy.data.curves.new("Orbifold Outline", "CURVE")
    curve.dimensions, curve.bevel_depth, curve.bevel_resolution = "3D", thickness, 2
    for chain in _chains(edges):
        closed = chain[0] == chain[-1]
        places = tile[chain[:-1] if closed else chain]
        spline = curve.splines.new("POLY")
        spline.points.add(len(places) - 1)
        spline.points.foreach_set("co", np.column_stack([places, np.ones(len(places))]).ravel())
        spline.use_cyclic_u = closed
    name = "Orbifold Outline"
    curve.materials.append(bpy.data.materials.get(name) or _plain_material(name, (0.03, 0.03, 0.04), 0.6))
    scene.collection.objects.link(bpy.data.objects.new(name, curve))


def _chains(edges: np.ndarray) -> Iterator[list[int]]:
    """Directed edges joined to lines, the open ones first; a closed one ends where it begins."""
    follows = {int(a): int(b) for a, b in edges}
    starts = sorted(set(follows) - set(follows.values()))
    while follows:
        at = starts.pop() if starts else next(iter(follows))
        chain = [at]
        while at in follows:
            at = follows.pop(at)
            chain.append(at)
        yield chain


# ------------------------------------------------------------------------------------------ small things, light


def _add_ball(scene: bpy.types.Scene, place: np.ndarray, radius: float, colour: np.ndarray) -> None:
    mesh = bpy.data.meshes.get("Orbifold Cone") or _ball_mesh()
    ball = bpy.data.objects.new("Orbifold Cone", mesh)
    ball.matrix_world = Matrix.Translation(Vector(place)) @ Matrix.Scale(radius, 4)
    scene.collection.objects.link(ball)
    ball.material_slots[0].link = "OBJECT"
    name = f"Orbifold Cone {tuple(colour)}"
    ball.material_slots[0].material = bpy.data.materials.get(name) or _plain_material(name, colour, 0.25)


def _ball_mesh() -> bpy.types.Mesh:
    import bmesh

    mesh = bpy.data.meshes.new("Orbifold Cone")
    ball = bmesh.new()
    bmesh.ops.create_icosphere(ball, subdivisions=4, radius=1.0)
    for face in ball.faces:
        face.smooth = True
    ball.to_mesh(mesh)
    ball.free()
    mesh.materials.append(None)
    return mesh


def _plain_material(name: str, colour: Sequence[float], roughness: float) -> bpy.types.Material:
    material = bpy.data.materials.new(name)
    blender_mesh.enable_nodes(material)
    node = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    blender_mesh.principled_input(node, "Base Color").default_value = (*colour, 1.0)
    blender_mesh.principled_input(node, "Roughness").default_value = roughness
    return material


def _floor_material() -> bpy.types.Material:
    """Half diffuse, half glowing: shadows stay soft and the noise of few samples low."""
    material = bpy.data.materials.new("Orbifold Floor")
    blender_mesh.enable_nodes(material)
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    output, both = nodes.new("ShaderNodeOutputMaterial"), nodes.new("ShaderNodeAddShader")
    diffuse, glow = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeEmission")
    for node, part in ((diffuse, 0.45), (glow, 0.68)):
        node.inputs["Color"].default_value = (*(part * value for value in FLOOR), 1.0)
        links.new(node.outputs[0], both.inputs[0 if node is diffuse else 1])
    links.new(both.outputs[0], output.inputs["Surface"])
    return material


def _object_material(material: bpy.types.Material) -> bpy.types.Material:
    """A copy that glows a little in its own colours: light from all sides, without the noise of sampling it."""
    shown = material.copy()
    lit = next(node for node in shown.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    colour = blender_mesh.principled_input(lit, "Base Color").links[0].from_socket
    shown.node_tree.links.new(colour, blender_mesh.principled_input(lit, "Emission Color", "Emission"))
    blender_mesh.principled_input(lit, "Emission Strength").default_value = 0.25
    return shown


def _panel_material(material: bpy.types.Material, paleness: float, glows: bool) -> bpy.types.Material:
    """The colours of the object's material, mixed with grey; glowing by themselves (no shading, no noise) or lit."""
    shown = material.copy()
    shown.name = f"{material.name} Panel"
    nodes, links = shown.node_tree.nodes, shown.node_tree.links
    output = next(node for node in nodes if node.type == "OUTPUT_MATERIAL" and node.is_active_output)
    lit = next(node for node in nodes if node.type == "BSDF_PRINCIPLED")
    colour = blender_mesh.principled_input(lit, "Base Color").links[0].from_socket
    shaders = [nodes.new("ShaderNodeEmission" if glows else "ShaderNodeBsdfDiffuse") for _ in range(2)]
    mix = nodes.new("ShaderNodeMixShader")
    mix.inputs[0].default_value = paleness
    links.new(colour, shaders[0].inputs["Color"])
    shaders[1].inputs["Color"].default_value = (0.72, 0.72, 0.74, 1.0)
    links.new(shaders[0].outputs[0], mix.inputs[1])
    links.new(shaders[1].outputs[0], mix.inputs[2])
    links.new(mix.outputs[0], output.inputs["Surface"])
    return shown


def _light(scene: bpy.types.Scene) -> None:
    world = bpy.data.worlds.new("Orbifold Picture")
    if world.node_tree is None:
        world.use_nodes = True
    background = next(node for node in world.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs["Color"].default_value = (0.95, 0.97, 1.0, 1.0)
    background.inputs["Strength"].default_value = 0.2
    scene.world = world
    sun = bpy.data.lights.new("Orbifold Sun", "SUN")
    sun.energy, sun.angle = 2.1, np.radians(5)
    lamp = bpy.data.objects.new("Orbifold Sun", sun)
    lamp.rotation_euler = Vector((0.45, 0.75, -1.0)).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(lamp)
    floor = bpy.data.meshes.new("Orbifold Floor")
    floor.from_pydata([(-900, -900, 0), (900, -900, 0), (900, 900, 0), (-900, 900, 0)], [], [(0, 1, 2, 3)])
    floor.materials.append(_floor_material())
    scene.collection.objects.link(bpy.data.objects.new("Orbifold Floor", floor))


def _aim_camera(scene: bpy.types.Scene) -> None:
    camera = bpy.data.cameras.new("Orbifold Camera")
    camera.lens, camera.sensor_width = LENS, 36.0
    distance = WIDTH * LENS / camera.sensor_width
    eye = bpy.data.objects.new("Orbifold Camera", camera)
    eye.location = (0.0, -distance * np.cos(TILT), _middle_height() + distance * np.sin(TILT))
    eye.rotation_euler = (np.pi / 2 - TILT, 0.0, 0.0)
    scene.collection.objects.link(eye)
    scene.camera = eye


def _render(scene: bpy.types.Scene, path: Path) -> None:
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    cycles.device, cycles.samples, cycles.use_denoising = "CPU", SAMPLES, False
    cycles.use_adaptive_sampling, cycles.seed, cycles.max_bounces = False, 0, 0
    scene.view_settings.view_transform = "Standard"
    render.resolution_x, render.resolution_y = RESOLUTION
    render.resolution_percentage = 100
    render.image_settings.file_format, render.image_settings.color_mode = "PNG", "RGB"
    render.image_settings.compression = 100
    render.use_file_extension, render.dither_intensity = False, 0.0  # dither is noise that PNG cannot pack
    render.filepath = str(path)
    bpy.ops.render.render(write_still=True, scene=scene.name)
