# SPDX-License-Identifier: GPL-3.0-or-later
"""Patterns of the plane as shader nodes: functions of the lattice's coordinates, in which the unit square is a period
(the layout `Periodic`), made of sines and cosines that the group leaves as they are.

Coordinates are u and v, or for the patterns of triangles and hexagons a = u - v, b = 2 v, c = -(u + v): there the unit
square is a rectangle 1 : 1.73 of the hexagonal lattice, and a third of a turn about its corner permutes a, b, c.
Which of the patterns a group leaves as it is is not looked up but tried: at many points, under each generator.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import bpy
import numpy as np

from . import blender_mesh
from .layouts import Layout

LIGHT, DARK = (0.90, 0.86, 0.78), (0.05, 0.16, 0.28)  # linear
POINTS = 400  # at which a pattern is tried


@dataclass(frozen=True)
class Pattern:
    name: str
    description: str
    waves: tuple[tuple[int, int, bool], ...]  # factors of u and v, in units of pi; whether it is a sine
    product: bool  # the waves' product, or their sum; its sign chooses the colour
    offset: float  # added to it


PATTERNS = {
    "CHECKER": Pattern(
        "Checker", "Squares in two colours, about every corner of the lattice",
        ((16, 0, False), (0, 16, False)), True, 0.0
    ),
    "STRIPES": Pattern(
        "Stripes", "For 2222: stripes, which half a turn leaves as they are", ((24, 0, False),), False, 0.0
    ),
    "TRIANGLES": Pattern(
        "Triangles", "For 333: triangles in two colours, which a third of a turn leaves as they are",
        ((16, -16, True), (0, 32, True), (-16, -16, True)), True, 0.0,
    ),
    "QUADS": Pattern(
        "Quads", "For 442: rounded quads, which a quarter of a turn leaves as they are",
        ((16, 0, False), (0, 16, False)), False, -0.25,
    ),
    "HEXAGONS": Pattern(
        "Hexagons", "For 632 and 333: rounded hexagons, which a sixth of a turn leaves as they are",
        ((16, -16, False), (0, 32, False), (-16, -16, False)), False, 0.8,
    ),
}


def value_at(pattern: Pattern, uv: np.ndarray) -> np.ndarray:
    """(k,) at points (k, 2) in the lattice's coordinates."""
    waves = [(np.sin if sine else np.cos)(np.pi * (a * uv[:, 0] + b * uv[:, 1])) for a, b, sine in pattern.waves]
    return (np.prod(waves, axis=0) if pattern.product else np.sum(waves, axis=0)) + pattern.offset


def fits(pattern: Pattern, moves: list[Callable[[np.ndarray], np.ndarray]]) -> bool:
    """Whether these motions, of points (k, 2) in the lattice's coordinates, leave the pattern as it is."""
    points = np.random.default_rng(0).uniform(-1, 1, (POINTS, 2))
    here = value_at(pattern, points)
    sure = np.abs(here) > 1e-3
    return all((np.sign(value_at(pattern, move(points))) == np.sign(here))[sure].all() for move in moves)


def moves_of(layout: Layout, to_cells: np.ndarray) -> list[Callable[[np.ndarray], np.ndarray]]:
    """The generators of the layout's group on the lattice's coordinates; `to_cells` (3, 2) takes (x, y, 1) there."""
    from_cells = np.linalg.inv(to_cells[:2])

    def moved_by(generator: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
        def move(points: np.ndarray) -> np.ndarray:
            plane = np.column_stack([(points - to_cells[2]) @ from_cells, np.ones(len(points))])
            return (plane @ generator.T) @ to_cells

        return move

    return [moved_by(generator) for generator in layout.generators]


def why_not(kind: str, layout: Layout, to_cells: np.ndarray | None) -> str | None:
    """Why a pattern would show the seams of this layout; None where it does not."""
    if to_cells is None:
        return "Stripes, checkers and the like are for orbifolds of the plane: use Rings"
    moves = moves_of(layout, to_cells)
    if fits(PATTERNS[kind], moves):
        return None
    others = [pattern.name for pattern in PATTERNS.values() if fits(pattern, moves)]
    return f"{PATTERNS[kind].name} do not fit the symmetry of {layout.signature}: use {' or '.join([*others, 'Rings'])}"


def make_material(obj: bpy.types.Object, kind: str, lattice: np.ndarray) -> bpy.types.Material:
    """A material with this pattern; `lattice` (3, 2) takes (u, v, 1) of the UV map to the lattice's coordinates. An
    earlier one of this object is replaced."""
    name = f"Orbifold {obj.name}"
    material = bpy.data.materials.get(name) or bpy.data.materials.new(name)
    blender_mesh.enable_nodes(material)
    tree = material.node_tree
    tree.nodes.clear()
    pattern, nodes = PATTERNS[kind], []

    def node(kind_of: str) -> bpy.types.Node:
        made = tree.nodes.new(kind_of)
        made.location = (190 * len(nodes), -60 * (len(nodes) % 4))
        nodes.append(made)
        return made

    def math(operation: str, *values) -> bpy.types.NodeSocket:
        made = node("ShaderNodeMath")
        made.operation = operation
        for socket, value in zip(made.inputs, values):
            if isinstance(value, bpy.types.NodeSocket):
                tree.links.new(value, socket)
            else:
                socket.default_value = value
        return made.outputs[0]

    coordinates = node("ShaderNodeUVMap")
    coordinates.uv_map = blender_mesh.UV_MAP
    waves = []
    for a, b, sine in pattern.waves:
        factors = np.pi * (lattice @ (a, b))
        dot = node("ShaderNodeVectorMath")
        dot.operation = "DOT_PRODUCT"
        tree.links.new(coordinates.outputs["UV"], dot.inputs[0])
        dot.inputs[1].default_value = (factors[0], factors[1], 0.0)
        shifted = math("ADD", dot.outputs["Value"], float(np.remainder(factors[2], 2 * np.pi)))
        waves.append(math("SINE" if sine else "COSINE", shifted))
    total = waves[0]
    for wave in waves[1:]:
        total = math("MULTIPLY" if pattern.product else "ADD", total, wave)
    chosen = math("GREATER_THAN", math("ADD", total, pattern.offset), 0.0)
    colour = node("ShaderNodeValToRGB")
    colour.color_ramp.interpolation = "CONSTANT"
    for element, place, shade in zip(colour.color_ramp.elements, (0.0, 0.5), (DARK, LIGHT)):
        element.position, element.color = place, (*shade, 1.0)
    tree.links.new(chosen, colour.inputs["Fac"])
    shader, output = node("ShaderNodeBsdfPrincipled"), node("ShaderNodeOutputMaterial")
    shader.inputs["Roughness"].default_value = 0.6
    tree.links.new(colour.outputs["Color"], shader.inputs["Base Color"])
    tree.links.new(shader.outputs["BSDF"], output.inputs["Surface"])
    return material
