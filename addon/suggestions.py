# SPDX-License-Identifier: GPL-3.0-or-later
"""The suggested cones of a mesh: a table that is kept on it, saved with it, and shown in the sidebar.

A row names vertices by their indices, so the table is stale once the mesh has other vertices, edges or faces than when
it was made; undoing that makes it good again. Which row is placed is not kept but read from the cones, whatever undo
and redo do to these. Undo in edit mode restores the cones, which are vertex data, but not the signature (cones.py);
`signature_for` says what it must have been.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Optional

import bpy
import numpy as np
from bpy.props import BoolProperty, CollectionProperty, FloatProperty, IntProperty, IntVectorProperty, StringProperty

from . import blender_mesh, cones, core, surface


class OrbifoldSuggestion(bpy.types.PropertyGroup):
    """A row of the table."""

    signature: StringProperty(name="Signature")
    cones: StringProperty()  # vertices, in the signature's sequence
    orders: StringProperty()
    predicted: FloatProperty(name="Area Spread")
    measured: BoolProperty()
    symmetric: BoolProperty()

    def picks(self) -> list[cones.Cone]:
        return [cones.Cone(*pair) for pair in zip(_numbers(self.cones), _numbers(self.orders))]


def _active_row(table: "OrbifoldSuggestions") -> int:
    return placed_row(table.id_data)


def _keep_row(_table: "OrbifoldSuggestions", _row: int) -> None:
    """A click beside the buttons of a row: the list shows which one is placed, and nothing else."""


class OrbifoldSuggestions(bpy.types.PropertyGroup):
    rows: CollectionProperty(type=OrbifoldSuggestion)
    active: IntProperty(name="Suggestion", get=_active_row, set=_keep_row, options={"HIDDEN"})
    made_for: IntVectorProperty(size=3)  # numbers of vertices, edges, faces
    fixed: StringProperty()  # vertices that were picked by hand and are cones of every row
    replaced: StringProperty()  # the signature of the mesh while it had no cones, before a row was placed
    has_replaced: BoolProperty()  # `replaced` is in force: no one has typed a signature since


CLASSES = (OrbifoldSuggestion, OrbifoldSuggestions)


def _numbers(text: str) -> list[int]:
    return [int(word) for word in text.split()]


def _text(numbers: Iterable[int]) -> str:
    return " ".join(str(number) for number in numbers)


# -------------------------------------------------------------------------------------------------- the table


def keep(mesh: bpy.types.Mesh, found: Sequence[core.Suggestion], fixed: Sequence[int]) -> None:
    """Replace the table."""
    table = mesh.orbifold.suggestions
    table.rows.clear()
    for suggestion in found:
        row = table.rows.add()
        row.signature, row.cones, row.orders = suggestion.signature, _text(suggestion.cones), _text(suggestion.orders)
        row.predicted, row.measured, row.symmetric = suggestion.predicted, suggestion.measured, suggestion.symmetric
    table.made_for = surface.counts(mesh)
    table.fixed = _text(fixed)


def is_stale(mesh: bpy.types.Mesh) -> bool:
    return tuple(mesh.orbifold.suggestions.made_for) != surface.counts(mesh)


def placed_row(mesh: bpy.types.Mesh) -> int:
    """The row whose cones and signature the mesh has; -1: none."""
    settings = mesh.orbifold
    here = [cones.Cone(item.vertex, item.order) for item in settings.cones]
    for number, row in enumerate(settings.suggestions.rows):
        if row.signature == settings.signature and row.picks() == here:
            return -1 if is_stale(mesh) else number
    return -1


def signature_for(mesh: bpy.types.Mesh, picks: Sequence[cones.Cone]) -> Optional[str]:
    """After undo or redo, where the mesh's signature is not one of these cones: that of the row that they come from,
    or, without cones, the one before any row was placed. None: the table does not know."""
    settings = mesh.orbifold
    table = settings.suggestions
    if not picks:
        ours = table.has_replaced and any(row.signature == settings.signature for row in table.rows)
        return table.replaced if ours else None
    return next((row.signature for row in table.rows if row.picks() == list(picks)), None)


def picked_by_hand(mesh: bpy.types.Mesh) -> list[int]:
    """The mesh's cones; where they are those of a row, only the ones that it had to keep."""
    if placed_row(mesh) >= 0:
        return _numbers(mesh.orbifold.suggestions.fixed)
    return [cone.vertex for cone in cones.read_cones(mesh)]


def place(mesh: bpy.types.Mesh, signature: str, picks: Sequence[cones.Cone]) -> None:
    """Give the mesh these cones, in the signature's sequence, and the signature; in any mode."""
    settings = mesh.orbifold
    if not cones.read_cones(mesh):
        settings.suggestions.replaced, settings.suggestions.has_replaced = settings.signature, True
    cones.write_cones(mesh, picks)
    with cones.writing():
        settings.signature = signature
    settings.active_cone = 0


def forget_replaced(mesh: bpy.types.Mesh) -> None:
    """The signature is the user's own from now on."""
    mesh.orbifold.suggestions.has_replaced = False


# --------------------------------------------------------------------------------------------------- keep away


def keep_away(obj: bpy.types.Object) -> Optional[np.ndarray]:
    """(n,) what a cone costs at each vertex, from the vertex group that was chosen: a weight w in [0, 1] becomes
    w / (1 - w), so that 1 means never. None: no group is chosen. Not in edit mode."""
    name = obj.data.orbifold.keep_away
    if not name:
        return None
    group = obj.vertex_groups.get(name)
    if group is None:
        raise blender_mesh.BlenderMeshError(
            f'There is no vertex group "{name}" to keep cones away from: choose another one, or none'
        )
    weights = np.clip(blender_mesh.read_group_weights(obj.data, group.index), 0.0, 1.0)
    with np.errstate(divide="ignore"):
        return weights / (1.0 - weights)
