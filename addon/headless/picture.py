# SPDX-License-Identifier: GPL-3.0-or-later
"""NAME.png: the textured object beside its tile among the tile's images, rendered by Cycles on the CPU.

Everything is built in a scene of its own, in units in which the picture is WIDTH wide at the origin: x to the right,
y away from the camera, z up. The floor is z = 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Sequence

import bpy
import numpy as np
from mathutils import Matrix, Vector

from .. import blender_mesh
from .tiling import Tiling, drawn

RESOLUTION = (960, 540)
SAMPLES = 16
WIDTH = 4.7
HEIGHT = WIDTH * RESOLUTION[1] / RESOLUTION[0]
LENS = 85.0  # millimetres; the sensor is 36 wide
TILT = np.radians(10.0)  # the camera looks down by this much, so that the floor fills the background
TURN = np.radians(38.0)  # the object is seen from front and side
OBJECT_BOX = (2.15, 2.15)  # widest and highest that the object is drawn
PANEL_RADIUS = 1.04
PALENESS = 0.45
OBJECT_X, PANEL_X = -1.13, 1.20
WINDOW = 1.45  # in the plane: the radius of the round window on the tiling, in radii of the tile

CONE_COLOURS = ((0.90, 0.16, 0.10), (0.05, 0.35, 0.85), (0.98, 0.75, 0.05), (0.05, 0.60, 0.30), (0.55, 0.15, 0.75),
                (0.95, 0.45, 0.05), (0.02, 0.60, 0.70), (0.85, 0.15, 0.50))
FLOOR = (0.42, 0.43, 0.45)


@dataclass(frozen=True)
class Subject:
    obj: bpy.types.Object  # textured
    vertices: np.ndarray  # (n, 3) in the object's coordinates
    cones: Sequence[int]
    tiling: Tiling
    cone_of_corner: Sequence[int]  # which cone (0, 1, ...) each of tiling.cones is a copy of
    material: bpy.types.Material
    paint: Callable[[bpy.types.Mesh], None]  # texture coordinates and attributes for a mesh of the tile's triangles


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
    c, s = np.cos(TURN), np.sin(TURN)
    turned = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ standing
    seen = subject.vertices @ turned.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    size = np.maximum(high - low, 1e-30)
    scale = min(OBJECT_BOX[0] / size[0], OBJECT_BOX[1] / size[2], OBJECT_BOX[0] * 1.3 / size[1])
    origin = np.array([OBJECT_X, 0, 0]) - scale * np.array([(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2]])
    shown = subject.obj.copy()
    shown.matrix_world = Matrix.Translation(origin) @ Matrix((scale * turned).tolist()).to_4x4()
    scene.collection.objects.link(shown)
    for number, cone in enumerate(subject.cones):
        _add_ball(scene, origin + scale * seen[cone], 0.032, number)


# ------------------------------------------------------------------------------------------------- the panel


def _place_panel(scene: bpy.types.Scene, subject: Subject) -> None:
    """The tile and its images, turned towards the camera."""
    tiling = subject.tiling
    face = np.array(Matrix.Rotation(np.pi / 2 - TILT, 3, "X"))
    centre = np.array([PANEL_X, 0.0, _middle_height()])
    to_view = _centring(tiling)
    images = [to_view @ element for element in tiling.group]
    radius = 1.0  # of the sphere and of the disk
    if tiling.curvature == 0:
        tile_radius = _tile_radius(tiling, images[0])
        radius = WINDOW * tile_radius
        images = _images_within(tiling, images, radius + tile_radius)
    scale = PANEL_RADIUS / radius
    faded = _faded(subject.material, centre)
    for number, image in enumerate(images):
        _add_image(scene, subject, image, face * scale, centre, faded if number else subject.material,
                   lift=0.0 if number else 0.012)
    towards_camera = -np.array([0, np.cos(TILT), -np.sin(TILT)]) * 0.03
    tile = centre + drawn(tiling.curvature, tiling.points @ images[0].T) @ (face * scale).T
    for corner, number in zip(tiling.cones, subject.cone_of_corner):
        _add_ball(scene, tile[corner] + towards_camera, 0.03, number)
    _add_outline(scene, tile + towards_camera * 0.6, tiling.triangles)


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
    return np.array([[1 + x * x / (1 + z), x * y / (1 + z), -x], [x * y / (1 + z), 1 + y * y / (1 + z), -y], [-x, -y, z]])


def _tile_radius(tiling: Tiling, image: np.ndarray) -> float:
    return float(np.hypot(*(tiling.points[tiling.cones] @ image.T)[:, :2].T).max())


def _images_within(tiling: Tiling, images: list[np.ndarray], reach: float) -> list[np.ndarray]:
    """Those whose middle is within `reach` of the tile's middle, which is the origin of images[0]."""
    middle = np.linalg.inv(images[0])[:, 2]
    return [image for image in images if np.hypot(*(image @ middle)[:2]) <= reach]


def _add_image(scene: bpy.types.Scene, subject: Subject, image: np.ndarray, view: np.ndarray, centre: np.ndarray,
               material: bpy.types.Material, lift: float) -> None:
    """One image of the tile. In the plane and on the sphere it is an instance of one mesh, moved; in the Poincaré
    disk, where isometries are not linear, a mesh of its own."""
    tiling = subject.tiling
    if tiling.curvature < 0:
        mesh = _tile_mesh(subject, drawn(-1, tiling.points @ image.T))
        motion = np.eye(4)
    else:
        mesh = bpy.data.meshes.get("Orbifold Tile") or _tile_mesh(subject, drawn(tiling.curvature, tiling.points))
        motion = np.eye(4)
        motion[:3, :3] = image
        if tiling.curvature == 0:  # homogeneous coordinates: the last column is the translation
            motion[:3, :3] = [[*image[0, :2], 0], [*image[1, :2], 0], [0, 0, 1]]
            motion[:2, 3] = image[:2, 2]
    obj = bpy.data.objects.new("Orbifold Tile", mesh)
    scene.collection.objects.link(obj)
    place = np.eye(4)
    place[:3, :3] = view * (1 + lift if tiling.curvature > 0 else 1)
    place[:3, 3] = centre + (0 if tiling.curvature > 0 else 1) * lift * view[:, 2] / np.linalg.norm(view[:, 2])
    obj.matrix_world = Matrix((place @ motion).tolist())
    obj.material_slots[0].link = "OBJECT"
    obj.material_slots[0].material = material


def _tile_mesh(subject: Subject, places: np.ndarray) -> bpy.types.Mesh:
    mesh = bpy.data.meshes.new("Orbifold Tile")
    mesh.from_pydata(places.tolist(), [], subject.tiling.triangles.tolist())
    mesh.polygons.foreach_set("use_smooth", np.ones(len(mesh.polygons), bool))
    mesh.materials.append(subject.material)
    subject.paint(mesh)
    return mesh


def _add_outline(scene: bpy.types.Scene, tile: np.ndarray, triangles: np.ndarray) -> None:
    """A thin line along the tile's boundary: the edges of a single triangle."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    keys = np.sort(edges, axis=1)
    _, first, count = np.unique(keys, axis=0, return_index=True, return_counts=True)
    follows = {int(a): int(b) for a, b in edges[first[count == 1]]}
    curve = bpy.data.curves.new("Orbifold Outline", "CURVE")
    curve.dimensions, curve.bevel_depth, curve.bevel_resolution = "3D", 0.006, 2
    while follows:
        start, at = follows.popitem()
        loop = [start]
        while at in follows:
            loop.append(at)
            at = follows.pop(at)
        spline = curve.splines.new("POLY")
        spline.points.add(len(loop) - 1)
        spline.points.foreach_set("co", np.column_stack([tile[loop], np.ones(len(loop))]).ravel())
        spline.use_cyclic_u = True
    curve.materials.append(_plain_material("Orbifold Outline", (0.03, 0.03, 0.04), 0.6))
    scene.collection.objects.link(bpy.data.objects.new("Orbifold Outline", curve))


# ------------------------------------------------------------------------------------------ small things, light


def _add_ball(scene: bpy.types.Scene, place: np.ndarray, radius: float, number: int) -> None:
    mesh = bpy.data.meshes.get("Orbifold Cone") or _ball_mesh()
    ball = bpy.data.objects.new("Orbifold Cone", mesh)
    ball.matrix_world = Matrix.Translation(Vector(place)) @ Matrix.Scale(radius, 4)
    scene.collection.objects.link(ball)
    ball.material_slots[0].link = "OBJECT"
    name = f"Orbifold Cone {number % len(CONE_COLOURS)}"
    ball.material_slots[0].material = bpy.data.materials.get(name) or _plain_material(
        name, CONE_COLOURS[number % len(CONE_COLOURS)], 0.25)


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


def _faded(material: bpy.types.Material, centre: np.ndarray) -> bpy.types.Material:
    """A copy of the material, paler, and not there outside the round window about `centre`."""
    faded = material.copy()
    faded.name = f"{material.name} Faded"
    nodes, links = faded.node_tree.nodes, faded.node_tree.links
    output = next(node for node in nodes if node.type == "OUTPUT_MATERIAL" and node.is_active_output)
    source = output.inputs["Surface"].links[0].from_socket
    pale, paler = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeMixShader")
    pale.inputs["Color"].default_value = (0.75, 0.75, 0.76, 1.0)
    paler.inputs[0].default_value = PALENESS
    links.new(source, paler.inputs[1])
    links.new(pale.outputs[0], paler.inputs[2])
    position, distance = nodes.new("ShaderNodeNewGeometry"), nodes.new("ShaderNodeVectorMath")
    outside, window = nodes.new("ShaderNodeMath"), nodes.new("ShaderNodeMixShader")
    distance.operation, outside.operation = "DISTANCE", "GREATER_THAN"
    distance.inputs[1].default_value, outside.inputs[1].default_value = centre, PANEL_RADIUS * 1.001
    links.new(position.outputs["Position"], distance.inputs[0])
    links.new(distance.outputs["Value"], outside.inputs[0])
    links.new(outside.outputs[0], window.inputs[0])
    links.new(paler.outputs[0], window.inputs[1])
    links.new(nodes.new("ShaderNodeBsdfTransparent").outputs[0], window.inputs[2])
    links.new(window.outputs[0], output.inputs["Surface"])
    return faded


def _light(scene: bpy.types.Scene) -> None:
    world = bpy.data.worlds.new("Orbifold Picture")
    if world.node_tree is None:
        world.use_nodes = True
    background = next(node for node in world.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs["Color"].default_value = (0.95, 0.97, 1.0, 1.0)
    background.inputs["Strength"].default_value = 0.45
    scene.world = world
    sun = bpy.data.lights.new("Orbifold Sun", "SUN")
    sun.energy, sun.angle = 2.1, np.radians(8)
    lamp = bpy.data.objects.new("Orbifold Sun", sun)
    lamp.rotation_euler = Vector((0.45, 0.75, -1.0)).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(lamp)
    floor = bpy.data.meshes.new("Orbifold Floor")
    floor.from_pydata([(-900, -900, 0), (900, -900, 0), (900, 900, 0), (-900, 900, 0)], [], [(0, 1, 2, 3)])
    floor.materials.append(_plain_material("Orbifold Floor", FLOOR, 0.9))
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
    cycles.use_adaptive_sampling, cycles.seed, cycles.max_bounces = False, 0, 3
    scene.view_settings.view_transform = "Standard"
    render.resolution_x, render.resolution_y = RESOLUTION
    render.resolution_percentage = 100
    render.image_settings.file_format, render.image_settings.color_mode = "PNG", "RGB"
    render.image_settings.compression = 100
    render.use_file_extension = False
    render.filepath = str(path)
    bpy.ops.render.render(write_still=True, scene=scene.name)
