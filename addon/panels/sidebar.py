# SPDX-License-Identifier: GPL-3.0-or-later
"""The tab `Orbifold` in the sidebars of the 3D view and the UV editor."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

import bpy

from .. import core, properties, suggestions, surface
from ..operators.jobs import mesh_problem
from .menus import MESH_MT_orbifold_signatures


@dataclass(frozen=True)
class SignatureState:
    text: str  # which geometry it is, or what is wrong
    good: bool


def signature_state(signature: str, n_cones: int, n_corners: int = 0) -> SignatureState:
    """What the panel says below the signature field, where so many cones and mirror corners are picked."""
    if not signature:
        return SignatureState("Orbifold Unwrap will choose the cones and their signature", False)
    try:
        read = core.parse_signature(signature)
        words = core.describe(signature).partition(": ")[2]
    except core.OrbifoldError as error:
        sentence = str(error)
        return SignatureState(sentence[:1].upper() + sentence[1:], False)
    if not read.supported:
        return SignatureState(f"This version does not map a mesh onto this orbifold: {words}", False)
    tasks = _tasks(read.n_interior - n_cones, "cone", "inside", n_corners)
    tasks += _tasks(len(read.orders) - read.n_interior - n_corners, "mirror corner", "on the border", n_cones)
    name = f"{read.geometry.capitalize()}: {words}"
    if tasks:
        unaided = "; or unwrap, and they will be suggested" if not n_cones + n_corners else ""
        return SignatureState(f"{name}; {' and '.join(tasks)}{unaided}", False)
    if read.curvature > 0:
        return SignatureState(f"{name}; {round(2 / read.euler)} copies cover the sphere", True)
    return SignatureState(name, True)


def _tasks(missing: int, what: str, where: str, others: int) -> list[str]:
    """How to come to the right number; where there are both kinds of picks, what tells them apart is said too."""
    if missing == 0:
        return []
    ending = "" if abs(missing) == 1 else "s"
    kind = f" {what}{ending} {where}" if others or what != "cone" else ""
    return [f"add {missing}{kind}" if missing > 0 else f"remove {-missing}{kind}"]


def surface_problem(signature: str, seen: core.Topology, holes: str) -> Optional[str]:
    """Why this surface is not that of a signature that parses; None where it is, or will be with this choice for
    holes."""
    read = core.parse_signature(signature)
    crosscaps = read.n_crosscaps + 2 * read.n_handles if read.n_crosscaps else 0
    wanted = (crosscaps, False) if crosscaps else (read.n_handles, True)
    if seen.components != 1:
        return f"The mesh is in {seen.components} components: those with cones are unwrapped, each by its own orders"
    if (seen.genus, seen.orientable) != wanted or len(seen.loops) < read.n_mirrors:
        genus = max(seen.genus, 0)
        name = core.surface_name(*((genus, 0) if seen.orientable else (0, genus)), len(seen.loops))
        return f"The signature is not of this mesh, which is a {name}: choose one from the menu"
    if len(seen.loops) > read.n_mirrors and holes == "refuse":
        return "Choose what to do with the borders that the signature has no mirror for"
    return None


class MESH_UL_orbifold_cones(bpy.types.UIList):
    bl_idname = "MESH_UL_orbifold_cones"

    def draw_item(self, _context, layout, _data, item, _icon, _active_data, _active_property, index=0) -> None:
        row = layout.row(align=True)
        split = row.split(factor=0.64)
        icon = "MOD_MIRROR" if item.mirror else "NONE"  # no icon at all: room for digits
        split.label(text=f"{index + 1}.  {item.vertex}", icon=icon)
        split.prop(item, "order", text="")
        jump = row.operator("mesh.orbifold_jump_to_cone", text="", icon="RESTRICT_SELECT_OFF", emboss=False)
        jump.index = index


class MESH_UL_orbifold_suggestions(bpy.types.UIList):
    """Rows are buttons: a click anywhere places the cones, as one undo step."""

    bl_idname = "MESH_UL_orbifold_suggestions"

    def draw_item(self, context, layout, _data, item, _icon, _active_data, _active_property, index=0) -> None:
        placed = suggestions.placed_row(context.active_object.data) == index
        icons = ("CHECKMARK" if placed else "BLANK1", "NONE", "NONE")
        for cell, text, icon in zip(table_columns(layout), table_texts(item), icons):
            cell.operator("mesh.orbifold_place_suggestion", text=text, icon=icon, emboss=False).index = index


def table_columns(layout: bpy.types.UILayout) -> tuple[bpy.types.UILayout, ...]:
    """Places for signature, spread and number of cones in a row of the table."""
    row = layout.split(factor=0.45, align=True)
    signature, others = row.row(), row.split(factor=0.56, align=True)
    return signature, others.row(), others.row()


def table_texts(row) -> tuple[str, str, str]:
    """Signature, spread, number of cones of a suggestion."""
    return row.signature, f"{'~' if row.measured else ''}{row.predicted:.2f}", str(len(row.picks()))


class OrbifoldPanel:
    """Mix-in: one sidebar tab in two editors."""

    bl_label = "Orbifold UV"
    bl_category = "Orbifold"
    bl_region_type = "UI"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        problem = mesh_problem(context)
        if problem is not None:
            layout.label(text=problem, icon="INFO")
            return
        mesh = context.active_object.data
        draw_cones(layout, mesh.orbifold)
        draw_suggestions(layout, context.active_object)
        draw_signature(layout, mesh, context.region.width)
        column = layout.column(align=True)
        column.scale_y = 1.3
        column.operator("uv.orbifold_unwrap")
        column.operator("object.orbifold_sphere")
        if surface.glance(mesh).loops:
            layout.operator("uv.orbifold_fixed_boundary")
        layout.operator("mesh.orbifold_show_stretch")


def draw_cones(layout: bpy.types.UILayout, settings) -> None:
    layout.operator("mesh.orbifold_add_cones", icon="ADD")
    titles = layout.split(factor=0.5)
    titles.label(text="Cone, Vertex")
    titles.label(text="Order")
    row = layout.row()
    row.template_list(MESH_UL_orbifold_cones.bl_idname, "", settings, "cones", settings, "active_cone", rows=4)
    side = row.column(align=True)
    side.operator("mesh.orbifold_remove_cone", text="", icon="REMOVE").index = -1
    side.separator()
    side.operator("mesh.orbifold_move_cone", text="", icon="TRIA_UP").direction = "UP"
    side.operator("mesh.orbifold_move_cone", text="", icon="TRIA_DOWN").direction = "DOWN"
    side.separator()
    side.operator("mesh.orbifold_clear_cones", text="", icon="X")


def draw_suggestions(layout: bpy.types.UILayout, obj: bpy.types.Object) -> None:
    settings = obj.data.orbifold
    column = layout.column()
    column.operator("mesh.orbifold_suggest_cones", icon="LIGHT")
    column.label(text="Keep cones away from:")
    row = column.row()
    row.alert = bool(settings.keep_away) and settings.keep_away not in obj.vertex_groups
    row.prop_search(settings, "keep_away", obj, "vertex_groups", text="")
    table = settings.suggestions
    if not len(table.rows):
        return
    stale = suggestions.is_stale(obj.data)
    if stale:
        column.label(text="The mesh has changed: suggest again", icon="ERROR")
    column = column.column()
    column.active = not stale
    for cell, text in zip(table_columns(column), ("Signature", "Spread", "Cones")):
        cell.label(text=text)
    name = MESH_UL_orbifold_suggestions.bl_idname
    column.template_list(name, "", table, "rows", table, "active", rows=min(5, len(table.rows)), sort_lock=True)


def draw_signature(layout: bpy.types.UILayout, mesh: bpy.types.Mesh, width: float) -> None:
    settings, seen = mesh.orbifold, surface.around(mesh, [item.vertex for item in mesh.orbifold.cones])
    signature = properties.default_signature(mesh)
    n_corners = sum(item.mirror for item in settings.cones)
    state = signature_state(signature, len(settings.cones) - n_corners, n_corners)
    if state.good:
        problem = surface_problem(signature, seen, settings.holes)
        state = state if problem is None else SignatureState(problem, False)
    layout.label(text="Signature")
    row = layout.row(align=True)
    row.alert = bool(settings.signature) and not state.good
    row.prop(settings, "signature", text="")
    row.menu(MESH_MT_orbifold_signatures.bl_idname, text="", icon="DOWNARROW_HLT")
    read = properties.read_signature(signature)
    extra = len(seen.loops) - (read.n_mirrors if read is not None else 0)
    if extra > 0:
        layout.label(text=f"{extra} border{'s' if extra > 1 else ''} without a mirror:")
        layout.prop(settings, "holes", text="")
    column = layout.column(align=True)
    icon = "CHECKMARK" if state.good else "INFO"
    scale = bpy.context.preferences.system.ui_scale or 1.0  # 0 without a window
    text = state.text if settings.signature or not signature else f"{signature}: {state.text}"
    for number, line in enumerate(wrapped(text, max(16, int(width / (7.5 * scale)) - 4))):
        column.label(text=line, icon=icon if number == 0 else "BLANK1")


def wrapped(text: str, width: int) -> list[str]:
    """Lines of at most `width` characters, broken at spaces: labels do not wrap by themselves."""
    lines = [""]
    for word in text.split():
        if lines[-1] and len(lines[-1]) + 1 + len(word) > width:
            lines.append("")
        lines[-1] = f"{lines[-1]} {word}".strip()
    return lines


class VIEW3D_PT_orbifold(OrbifoldPanel, bpy.types.Panel):
    bl_idname = "VIEW3D_PT_orbifold"
    bl_space_type = "VIEW_3D"


class IMAGE_PT_orbifold(OrbifoldPanel, bpy.types.Panel):
    bl_idname = "IMAGE_PT_orbifold"
    bl_space_type = "IMAGE_EDITOR"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.space_data.mode == "UV" or context.space_data.show_uvedit


CLASSES = (MESH_UL_orbifold_cones, MESH_UL_orbifold_suggestions, VIEW3D_PT_orbifold, IMAGE_PT_orbifold)
