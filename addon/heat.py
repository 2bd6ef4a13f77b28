# SPDX-License-Identifier: GPL-3.0-or-later
"""Heat maps: a measure of distortion as attributes of the mesh (its values, and colours that the viewport shows), and
how to take them off again without a trace."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Optional

import bpy
import numpy as np

from . import blender_mesh

SMALL, LARGE = (0.02, 0.13, 0.75), (0.75, 0.03, 0.03)  # blue, red; linear


@dataclass(frozen=True)
class Measure:
    title: str  # of the legend
    attribute: str  # the values
    colour: str
    gain: float  # from the values to the scale of `colours_of`
    ticks: tuple[tuple[float, str], ...]  # values, ascending, and what the legend writes beside them


STRETCH = Measure(
    *("Predicted length factor", "orbifold_stretch", "Orbifold Stretch", 1.0),
    tuple((float(np.log(factor)), text)
          for factor, text in ((0.125, "1/8"), (0.5, "1/2"), (1, "1"), (2, "2"), (8, "8"))),
)
AREA = Measure(
    *("Area factor", "orbifold_area", "Orbifold Area", 0.5),
    tuple((float(np.log(factor)), text)
          for factor, text in ((1 / 64, "1/64"), (0.25, "1/4"), (1, "1"), (4, "4"), (64, "64"))),
)
ANGLE = Measure(
    *("Angle distortion", "orbifold_angle", "Orbifold Angle", 5.0),
    tuple((float(np.log(factor)), f"{factor:g}") for factor in (1, 1.05, 1.15, 1.3, 1.6)),
)
MAP = Measure("Angle distortion of the map", "orbifold_map", "Orbifold Map", ANGLE.gain, ANGLE.ticks)
MAP_AREA = Measure(
    *("Area factor of the map", "orbifold_map_area", "Orbifold Map Area", 2.0),
    tuple((float(np.log(factor)), text)
          for factor, text in ((0.25, "1/4"), (0.5, "1/2"), (1, "1"), (2, "2"), (4, "4"))),
)
MEASURES = (STRETCH, AREA, ANGLE, MAP, MAP_AREA)


def colours_of(scale: np.ndarray) -> np.ndarray:
    """(n, 4) linear: white where the scale is 0, blue below, red above; half the colour at minus and plus log 2."""
    amount = 1 - np.exp(-np.abs(scale))[:, None]
    full = np.where(scale[:, None] < 0, SMALL, LARGE)
    return np.column_stack([1 + amount * (full - 1), np.ones(len(scale))])


# ---------------------------------------------------------------------------------------------- on the mesh


def shown(mesh: bpy.types.Mesh) -> Optional[Measure]:
    """The measure whose colours are the mesh's active ones; cheap, in any mode."""
    active = mesh.color_attributes.active_color
    return next((one for one in MEASURES if active is not None and one.colour == active.name), None)


def check(mesh: bpy.types.Mesh, measure: Measure) -> None:
    """Raise BlenderMeshError where `write` would overwrite attributes that are not ours."""
    for name, kind in ((measure.attribute, "FLOAT"), (measure.colour, "FLOAT_COLOR")):
        blender_mesh.check_attribute(mesh, name, kind)


def write(mesh: bpy.types.Mesh, measure: Measure, values: np.ndarray) -> None:
    """The values (n,) of the vertices and their colours, which become the active ones. In object mode."""
    blender_mesh.write_float_attribute(mesh, measure.attribute, values)
    blender_mesh.write_vertex_colour(mesh, measure.colour, colours_of(measure.gain * values))


def show(context: bpy.types.Context, mesh: bpy.types.Mesh, measure: Measure, values: np.ndarray) -> None:
    """Write, remember what was shown before, and let solid shading show the colours. In object mode."""
    active = mesh.color_attributes.active_color
    if shown(mesh) is None:
        mesh.orbifold.colour_before = active.name if active is not None else ""
    write(mesh, measure, values)
    _show_attributes(context)


def hide(context: bpy.types.Context, mesh: bpy.types.Mesh) -> None:
    """Take all measures off the mesh; the colours and the shading from before are back. In object mode."""
    for measure in MEASURES:
        for name in (measure.attribute, measure.colour):
            if name in mesh.attributes:
                mesh.attributes.remove(mesh.attributes[name])
    before = mesh.orbifold.colour_before
    if before in mesh.color_attributes:
        mesh.color_attributes.active_color = mesh.color_attributes[before]
    mesh.orbifold.property_unset("colour_before")
    if not any(other is not mesh and shown(other) for other in bpy.data.meshes):
        _show_as_before(context)
    mesh.update()


# ---------------------------------------------------------------------------------------------- in the views


def views(context: bpy.types.Context) -> list[tuple[str, bpy.types.SpaceView3D]]:
    """All 3D views, each with a name that stays."""
    return [
        (f"{screen.name} {number}", area.spaces.active)
        for screen in bpy.data.screens
        for number, area in enumerate(screen.areas) if area.type == "VIEW_3D"
    ]


def _show_attributes(context: bpy.types.Context) -> None:
    """In the window's 3D views with solid shading; other kinds of shading are left as they are."""
    here = {space.as_pointer() for area in context.screen.areas if area.type == "VIEW_3D"
            for space in (area.spaces.active,)} if context.screen is not None else set()
    settings = context.scene.orbifold_view
    before = json.loads(settings.colour_types or "{}")
    for name, space in views(context):
        if space.as_pointer() in here and space.shading.type == "SOLID" and space.shading.color_type != "VERTEX":
            before[name] = space.shading.color_type
            space.shading.color_type = "VERTEX"
    settings.colour_types = json.dumps(before)


def _show_as_before(context: bpy.types.Context) -> None:
    settings = context.scene.orbifold_view
    before = json.loads(settings.colour_types or "{}")
    for name, space in views(context):
        if name in before and space.shading.color_type == "VERTEX":
            space.shading.color_type = before[name]
    settings.property_unset("colour_types")


# ------------------------------------------------------------------------------------------------- measuring


def distortion(arrays: blender_mesh.MeshArrays, points: np.ndarray, curvature: int) -> tuple[np.ndarray, np.ndarray]:
    """(m,) each of the triangles' maps from the mesh to the corners `points` (m, 3, 3): the logarithms of the ratio of
    its singular values, and of its area factor, which is 1 for the mesh as a whole."""
    grams = []
    for corners, form in ((arrays.vertices[arrays.triangles], np.ones(3)), (points, np.array([1.0, 1.0, curvature]))):
        one, other = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        grams.append([(a * b * form).sum(1) for a, b in ((one, one), (one, other), (other, other))])
    (a, b, c), (p, q, r) = grams
    with np.errstate(divide="ignore", invalid="ignore"):
        squares = [np.maximum(x * z - y * y, 0.0) for x, y, z in grams]
        half = (a * r - 2 * b * q + c * p) / (2 * np.sqrt(squares[0] * squares[1]))  # of the ratio and its inverse
        ratio = np.arccosh(np.maximum(half, 1.0))
        area = np.log(np.sqrt(squares[1]) / np.sqrt(squares[1]).sum() * np.sqrt(squares[0]).sum() / np.sqrt(squares[0]))
    return np.nan_to_num(ratio, posinf=0.0), np.nan_to_num(area, posinf=0.0, neginf=0.0)


def areas_of(arrays: blender_mesh.MeshArrays) -> np.ndarray:
    """(m,) of the triangles."""
    p, q, r = arrays.vertices[arrays.triangles].transpose(1, 0, 2)
    return np.linalg.norm(np.cross(q - p, r - p), axis=1) / 2


def at_vertices(arrays: blender_mesh.MeshArrays, values: np.ndarray) -> np.ndarray:
    """(n,) the mean of the triangles' values (m,) around each vertex, weighted by their areas."""
    areas = np.repeat(areas_of(arrays) + 1e-30, 3)
    total = np.bincount(arrays.triangles.ravel(), areas, len(arrays.vertices))
    sums = np.bincount(arrays.triangles.ravel(), areas * np.repeat(values, 3), len(arrays.vertices))
    return sums / np.maximum(total, 1e-30)
