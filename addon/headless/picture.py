# SPDX-License-Identifier: GPL-3.0-or-later
"""NAME.png: the textured object beside its tile among the tile's images, rendered by Cycles on the CPU.

Everything is built in a scene of its own (stage.py).
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Iterator, Sequence

import bpy
import numpy as np
from mathutils import Matrix

from .. import blender_mesh
from .clip import clip_to_disk
from .stage import (
    TILT, Figure, add_ball, aim_camera, facing, light, middle_height, place_object, plain_material, render,
    triangle_mesh, turns,
)
from .tiling import Tiling, drawn

PANEL_RADIUS = 1.04
PALENESS = 0.45
OBJECT_X, PANEL_X = -1.13, 1.20
OBJECT_WIDTH = 2.15  # at most
WINDOW = 1.45  # in the plane: the radius of the round window on the tiling, in radii of the tile
DISK_WINDOW = 2.2  # the same in the Poincaré disk, unless all of it can be shown

MIRROR_LINE = 0.014  # half the thickness

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
    figure = Figure(subject.obj, subject.vertices, subject.cones, subject.colours, subject.material)
    place_object(scene, figure, turns()[int(facing(figure).sum(1).argmax())], OBJECT_X, OBJECT_WIDTH)
    _place_panel(scene, subject)
    light(scene)
    aim_camera(scene)
    render(scene, path)


# ------------------------------------------------------------------------------------------------- the panel


def _place_panel(scene: bpy.types.Scene, subject: Subject) -> None:
    """The tile and its images, turned towards the camera."""
    tiling = subject.tiling
    face = np.array(Matrix.Rotation(np.pi / 2 - TILT, 3, "X"))
    centre = np.array([PANEL_X, 0.0, middle_height()])
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
        add_ball(scene, tile[corner] + towards_camera, 0.032, subject.colours[number])
    for on_mirror, thickness in ((False, 0.006), (True, MIRROR_LINE)):
        _add_outline(scene, tile + towards_camera * 0.6, tiling.outline[tiling.mirrors == on_mirror], thickness)


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
    mesh.materials.append(plain_material("Orbifold Backing", (0.52, 0.52, 0.54), 0.9))
    scene.collection.objects.link(bpy.data.objects.new("Orbifold Backing", mesh))


def _add_image(scene: bpy.types.Scene, subject: Subject, image: np.ndarray, view: np.ndarray, centre: np.ndarray,
               window: float, material: bpy.types.Material, lift: float) -> None:
    """One image of the tile. On the sphere all are instances of one mesh; in the plane and in the Poincaré disk each
    has its own, cut off at the window."""
    tiling = subject.tiling
    if tiling.curvature > 0:
        mesh = bpy.data.meshes.get("Orbifold Tile") or triangle_mesh(
            drawn(1, tiling.points), tiling.triangles, subject.uv, subject.material)
        motion = view @ image * (1 + lift)
        place = centre
    else:
        corners = drawn(tiling.curvature, tiling.points @ image.T)[tiling.triangles][..., :2]
        corners, uv = clip_to_disk(corners, subject.uv, window)
        if len(corners) == 0:
            return
        flat = np.column_stack([corners.reshape(-1, 2), np.zeros(3 * len(corners))])
        mesh = triangle_mesh(flat, np.arange(3 * len(corners)).reshape(-1, 3), uv, material)
        motion = view
        place = centre + lift * view[:, 2] / np.linalg.norm(view[:, 2])
    obj = bpy.data.objects.new("Orbifold Tile", mesh)
    scene.collection.objects.link(obj)
    obj.matrix_world = Matrix.Translation(place) @ Matrix(motion.tolist()).to_4x4()
    obj.material_slots[0].link = "OBJECT"
    obj.material_slots[0].material = material


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
    curve.materials.append(bpy.data.materials.get(name) or plain_material(name, (0.03, 0.03, 0.04), 0.6))
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


