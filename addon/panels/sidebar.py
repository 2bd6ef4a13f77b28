# SPDX-License-Identifier: GPL-3.0-or-later
"""The tab `Orbifold` in the sidebars of the 3D view and the UV editor."""

from __future__ import annotations

from dataclasses import dataclass

import bpy

from .. import core
from ..operators.embedding import mesh_problem
from .menus import MESH_MT_orbifold_signatures


@dataclass(frozen=True)
class SignatureState:
    text: str  # which geometry it is, or what is wrong
    good: bool


def signature_state(signature: str, n_cones: int) -> SignatureState:
    """What the panel says below the signature field."""
    if not signature:
        return SignatureState("Type the orders of the cones, or pick cones", False)
    try:
        read = core.parse_signature(signature)
    except core.OrbifoldError as error:
        sentence = str(error)
        return SignatureState(sentence[:1].upper() + sentence[1:], False)
    if not read.supported:
        return SignatureState("This version maps spheres with cones only, without mirrors or handles", False)
    wanted = len(read.orders)
    name = f"{read.geometry.capitalize()} orbifold"
    if n_cones != wanted:
        difference = wanted - n_cones
        task = f"add {difference}" if difference > 0 else f"remove {-difference}"
        return SignatureState(f"{name} of {wanted} cones: {task}", False)
    if read.curvature > 0:
        return SignatureState(f"{name}, {round(2 / read.euler)} copies cover the sphere", True)
    return SignatureState(name, True)


class MESH_UL_orbifold_cones(bpy.types.UIList):
    bl_idname = "MESH_UL_orbifold_cones"

    def draw_item(self, _context, layout, _data, item, _icon, _active_data, _active_property, index=0) -> None:
        row = layout.row(align=True)
        split = row.split(factor=0.6)
        split.label(text=f"{index + 1}.  {item.vertex}", icon="VERTEXSEL")
        split.prop(item, "order", text="")
        jump = row.operator("mesh.orbifold_jump_to_cone", text="", icon="RESTRICT_SELECT_OFF", emboss=False)
        jump.index = index


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
        settings = context.active_object.data.orbifold
        draw_cones(layout, settings)
        draw_signature(layout, settings, context.region.width)
        column = layout.column(align=True)
        column.scale_y = 1.3
        column.operator("uv.orbifold_unwrap")
        column.operator("object.orbifold_sphere")


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


def draw_signature(layout: bpy.types.UILayout, settings, width: float) -> None:
    state = signature_state(settings.signature, len(settings.cones))
    layout.label(text="Signature")
    row = layout.row(align=True)
    row.alert = bool(settings.signature) and not state.good
    row.prop(settings, "signature", text="")
    row.menu(MESH_MT_orbifold_signatures.bl_idname, text="", icon="DOWNARROW_HLT")
    column = layout.column(align=True)
    icon = "CHECKMARK" if state.good else "INFO"
    scale = bpy.context.preferences.system.ui_scale
    for number, line in enumerate(wrapped(state.text, max(16, int(width / (7.5 * scale)) - 4))):
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


CLASSES = (MESH_UL_orbifold_cones, VIEW3D_PT_orbifold, IMAGE_PT_orbifold)
