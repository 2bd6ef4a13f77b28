# SPDX-License-Identifier: GPL-3.0-or-later
"""The signatures that fit, and our entries in Blender's UV menus."""

from __future__ import annotations

import bpy

from .. import core
from ..operators.unwrap import UV_OT_orbifold_unwrap

GEOMETRIES = (("euclidean", "Euclidean"), ("spherical", "Spherical"), ("hyperbolic", "Hyperbolic"))


class MESH_MT_orbifold_signatures(bpy.types.Menu):
    bl_idname = "MESH_MT_orbifold_signatures"
    bl_label = "Signatures"
    bl_description = "Signatures that fit the number of cones"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        orders = [cone.order for cone in context.active_object.data.orbifold.cones]
        try:
            offers = core.suggest_signatures(len(orders) or 3)
        except core.OrbifoldError as error:
            layout.label(text=str(error), icon="ERROR")
            return
        if not offers:
            layout.label(text="One cone alone has no orbifold: add another")
        if orders:  # any order can be typed in the list, which writes it into the signature at once
            own = core.format_signature(orders)
            layout.operator("mesh.orbifold_set_signature", text=f"Orders of the List: {own}").signature = own
            layout.separator()
        row = layout.row()
        for geometry, title in GEOMETRIES:
            fitting = [offer for offer in offers if offer.geometry == geometry]
            if fitting:
                column = row.column()
                column.label(text=title)
                column.separator()
                for offer in fitting:
                    entry = column.operator("mesh.orbifold_set_signature", text=offer.signature)
                    entry.signature = offer.signature


def draw_unwrap_entry(self, _context: bpy.types.Context) -> None:
    self.layout.separator()
    self.layout.operator(UV_OT_orbifold_unwrap.bl_idname)


UV_MENUS = ("VIEW3D_MT_uv_map", "IMAGE_MT_uvs")
CLASSES = (MESH_MT_orbifold_signatures,)


def register() -> None:
    for name in UV_MENUS:
        getattr(bpy.types, name).append(draw_unwrap_entry)


def unregister() -> None:
    for name in UV_MENUS:
        getattr(bpy.types, name).remove(draw_unwrap_entry)
