# SPDX-License-Identifier: GPL-3.0-or-later
"""NAME.png of a map: source and target side by side (stage.py). The source wears the pattern of its layout, and the
target what the source has where its points go; the balls are the landmarks."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np

from .. import baking, core, faces, materials, pattern
from ..steps import Steps
from ..transfer_outcome import Member
from .stage import Figure, aim_camera, facing, light, place_object, render, triangle_mesh, turns

SOURCE_X, TARGET_X = -1.14, 1.14
WIDTH = 1.95  # of each, at most


def render_map(source: Member, target: Member, to_source: core.SurfaceMap, path: Path) -> None:
    scene = bpy.data.scenes.new("Orbifold Picture")
    layouts = [faces.plain_layout(member.result) for member in (source, target)]
    own = pattern.image(source.result, layouts[0], materials.image_size(layouts[0]))
    size = materials.image_size(layouts[1])
    baked = Steps(baking.bake(layouts[1].uv, size, size, to_source.evaluate, layouts[0].uv, own)).finish()
    figures = [_figure(*one) for one in zip((source, target), layouts, (own, baked))]
    for figure, turn, x in zip(figures, _views(figures), (SOURCE_X, TARGET_X)):
        place_object(scene, figure, turns()[turn], x, WIDTH)
    light(scene)
    aim_camera(scene)
    render(scene, path)


def _figure(member: Member, layout: faces.FaceLayout, pixels: np.ndarray) -> Figure:
    """With a mesh of its own, of the triangles that take part."""
    material = materials.image_material(f"Orbifold Map {member.obj.name}", pixels, layout.chart)
    used, triangles = np.unique(member.arrays.triangles, return_inverse=True)
    vertices, cones = member.arrays.vertices[used], np.searchsorted(used, member.result.cones)
    mesh = triangle_mesh(vertices, triangles.reshape(-1, 3), layout.uv, material)
    obj = bpy.data.objects.new("Orbifold Map", mesh)
    obj.matrix_world = member.obj.matrix_world
    colours = pattern.palette(max(len(cones), pattern.LEAST_CENTRES)) ** 2.2
    return Figure(obj, vertices, cones, colours, material)


def _views(figures: list[Figure]) -> tuple[int, int]:
    """Of turns(), one for each: those that show most landmarks on both, the same one if it does."""
    source, target = (facing(figure).astype(int) for figure in figures)
    common = source @ target.T + np.eye(len(source)) / 2
    return np.unravel_index(int(common.argmax()), common.shape)
