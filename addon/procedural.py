# SPDX-License-Identifier: GPL-3.0-or-later
"""The patterns of formulas.py as shader nodes, and which of them fit a layout."""

from __future__ import annotations

from collections.abc import Callable

import bpy
import numpy as np

from . import blender_mesh
from .formulas import PATTERNS, fits
from .layouts import Layout

LIGHT, DARK = (0.90, 0.86, 0.78), (0.05, 0.16, 0.28)  # linear


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


class Nodes:
    """What formulas are made of, as nodes of a tree: sockets. `lattice` (3, 2) takes (u, v, 1) of the UV map to the
    lattice's coordinates."""

    def __init__(self, tree: bpy.types.NodeTree, lattice: np.ndarray) -> None:
        self._tree, self._lattice, self._made = tree, lattice, 0
        coordinates = self.node("ShaderNodeUVMap")
        coordinates.uv_map = blender_mesh.UV_MAP
        self._uv = coordinates.outputs["UV"]

    def node(self, kind: str) -> bpy.types.Node:
        made = self._tree.nodes.new(kind)
        made.location = (190 * self._made, -60 * (self._made % 4))
        self._made += 1
        return made

    def math(self, operation: str, *values) -> bpy.types.NodeSocket:
        made = self.node("ShaderNodeMath")
        made.operation = operation
        for socket, value in zip(made.inputs, values):
            if isinstance(value, bpy.types.NodeSocket):
                self._tree.links.new(value, socket)
            else:
                socket.default_value = value
        return made.outputs[0]

    def line(self, a: int, b: int) -> bpy.types.NodeSocket:
        factors = self._lattice @ (a, b)
        return self.math("ADD", self._dot(factors), float(factors[2]))

    def wave(self, a: int, b: int, sine: bool = False) -> bpy.types.NodeSocket:
        factors = np.pi * (self._lattice @ (a, b))
        shifted = self.math("ADD", self._dot(factors), float(np.remainder(factors[2], 2 * np.pi)))
        return self.math("SINE" if sine else "COSINE", shifted)

    def _dot(self, factors: np.ndarray) -> bpy.types.NodeSocket:
        dot = self.node("ShaderNodeVectorMath")
        dot.operation = "DOT_PRODUCT"
        self._tree.links.new(self._uv, dot.inputs[0])
        dot.inputs[1].default_value = (factors[0], factors[1], 0.0)
        return dot.outputs["Value"]


def make_material(obj: bpy.types.Object, kind: str, lattice: np.ndarray) -> bpy.types.Material:
    """A material with this pattern; `lattice` (3, 2) takes (u, v, 1) of the UV map to the lattice's coordinates. An
    earlier one of this object is replaced."""
    name = f"Orbifold {obj.name}"
    material = bpy.data.materials.get(name) or bpy.data.materials.new(name)
    blender_mesh.enable_nodes(material)
    tree = material.node_tree
    tree.nodes.clear()
    on = Nodes(tree, lattice)
    node = on.node
    chosen = on.math("GREATER_THAN", PATTERNS[kind].formula(on), 0.0)
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
