# SPDX-License-Identifier: GPL-3.0-or-later
"""What the pictures of `run` have in common: objects with balls at their cones, on a floor; light, camera, rendering.

Everything is in units in which the picture is WIDTH wide at the origin: x to the right, y away from the camera, z up.
The floor is z = 0.
"""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import bmesh
import bpy
import numpy as np
from mathutils import Matrix, Vector

from .. import blender_mesh

RESOLUTION = (960, 540)
SAMPLES = 16
WIDTH = 4.7
HEIGHT = WIDTH * RESOLUTION[1] / RESOLUTION[0]
LENS = 85.0  # millimetres; the sensor is 36 wide
TILT = np.radians(10.0)  # the camera looks down by this much, so that the floor fills the background
TURNS = (38, -38, 70, -70, 142, -142, 110, -110)  # degrees: ways to see the object, from front and side first
HIGHEST = 2.15  # that an object is drawn

FLOOR = (0.52, 0.53, 0.55)


@dataclass(frozen=True)
class Figure:
    """An object as it is to be seen."""

    obj: bpy.types.Object
    vertices: np.ndarray  # (n, 3) in the object's coordinates
    cones: Sequence[int]
    colours: np.ndarray  # (cones, 3)
    material: bpy.types.Material


def place_object(scene: bpy.types.Scene, figure: Figure, turn: np.ndarray, x: float, width: float) -> None:
    """The object turned, standing on the floor, at most as wide as that, with a ball at each cone."""
    turned = turn @ np.array(figure.obj.matrix_world.to_3x3())
    seen = figure.vertices @ turned.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    size = np.maximum(high - low, 1e-30)
    scale = min(width / size[0], HIGHEST / size[2], width * 1.3 / size[1])
    origin = np.array([x, 0, 0]) - scale * np.array([(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2]])
    shown = figure.obj.copy()
    shown.matrix_world = Matrix.Translation(origin) @ Matrix((scale * turned).tolist()).to_4x4()
    scene.collection.objects.link(shown)
    for slot in shown.material_slots:
        slot.link = "OBJECT"
        slot.material = _object_material(figure.material)
    for number, cone in enumerate(figure.cones):
        add_ball(scene, origin + scale * seen[cone], 0.036, figure.colours[number])


def turns() -> list[np.ndarray]:
    """The rotations about the vertical of TURNS."""
    return [np.array(Matrix.Rotation(np.radians(turn), 3, "Z")) for turn in TURNS]


def facing(figure: Figure) -> np.ndarray:
    """(turns, cones) which of the cones each of the turns shows."""
    normals = np.array([figure.obj.data.vertices[int(cone)].normal for cone in figure.cones]).reshape(-1, 3)
    normals = normals @ np.linalg.inv(np.array(figure.obj.matrix_world.to_3x3()))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True) + 1e-30
    eye = np.array([0, -np.cos(TILT), np.sin(TILT)])
    return np.array([normals @ turn.T @ eye > 0.1 for turn in turns()])


def triangle_mesh(
    points: np.ndarray, triangles: np.ndarray, uv: np.ndarray, material: bpy.types.Material
) -> bpy.types.Mesh:
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


# ------------------------------------------------------------------------------------------ small things, light


def add_ball(scene: bpy.types.Scene, place: np.ndarray, radius: float, colour: np.ndarray) -> None:
    mesh = bpy.data.meshes.get("Orbifold Cone") or _ball_mesh()
    ball = bpy.data.objects.new("Orbifold Cone", mesh)
    ball.matrix_world = Matrix.Translation(Vector(place)) @ Matrix.Scale(radius, 4)
    scene.collection.objects.link(ball)
    ball.material_slots[0].link = "OBJECT"
    name = f"Orbifold Cone {tuple(colour)}"
    ball.material_slots[0].material = bpy.data.materials.get(name) or plain_material(name, colour, 0.25)


def _ball_mesh() -> bpy.types.Mesh:
    mesh = bpy.data.meshes.new("Orbifold Cone")
    ball = bmesh.new()
    bmesh.ops.create_icosphere(ball, subdivisions=4, radius=1.0)
    for face in ball.faces:
        face.smooth = True
    ball.to_mesh(mesh)
    ball.free()
    mesh.materials.append(None)
    return mesh


def plain_material(name: str, colour: Sequence[float], roughness: float) -> bpy.types.Material:
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


def middle_height() -> float:
    return HEIGHT / 2 - 0.28


def light(scene: bpy.types.Scene) -> None:
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


def aim_camera(scene: bpy.types.Scene) -> None:
    camera = bpy.data.cameras.new("Orbifold Camera")
    camera.lens, camera.sensor_width = LENS, 36.0
    distance = WIDTH * LENS / camera.sensor_width
    eye = bpy.data.objects.new("Orbifold Camera", camera)
    eye.location = (0.0, -distance * np.cos(TILT), middle_height() + distance * np.sin(TILT))
    eye.rotation_euler = (np.pi / 2 - TILT, 0.0, 0.0)
    scene.collection.objects.link(eye)
    scene.camera = eye


def render(scene: bpy.types.Scene, path: Path) -> None:
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
