# SPDX-License-Identifier: GPL-3.0-or-later
"""The signatures that fit, and our entries in Blender's UV menus."""

from __future__ import annotations

import bpy

from .. import arrangement, core, previews, properties, surface
from ..operators.jobs import mesh_problem

GEOMETRIES = (("euclidean", "Euclidean"), ("spherical", "Spherical"), ("hyperbolic", "Hyperbolic"))


def fitting(mesh: bpy.types.Mesh) -> list[core.Signature]:
    """The signatures that fit the mesh's surface and the vertices in its list. Where holes are to be filled, also
    those with fewer mirrors. OrbifoldError where there is no native library."""
    vertices = [item.vertex for item in mesh.orbifold.cones]
    seen = surface.around(mesh, vertices)
    places = arrangement.arrange(vertices, seen, True)
    if seen.components != 1:
        return []
    counts = [len(border) for border in places.borders]
    picked = sum(1 for count in counts if count)
    fewest = picked if mesh.orbifold.holes == "fill" else len(counts)
    found: list[core.Signature] = []
    for mirrors in range(len(counts), fewest - 1, -1):
        euler = seen.euler + len(counts) - mirrors
        found += core.fitting_signatures(
            euler, mirrors, seen.genus, seen.orientable, len(places.cones), counts[:mirrors]
        )
    return found


class MESH_MT_orbifold_signatures(bpy.types.Menu):
    bl_idname = "MESH_MT_orbifold_signatures"
    bl_label = "Signatures"
    bl_description = "Signatures that fit the mesh and the vertices that are picked on it, each with its tile"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        mesh = context.active_object.data
        picks = [(item.vertex, item.order) for item in mesh.orbifold.cones]
        try:
            offers = fitting(mesh)
        except core.OrbifoldError as error:
            layout.label(text=str(error), icon="ERROR")
            return
        if not offers:
            layout.label(text="No orbifold has this surface with these cones and corners: add or remove some")
        if picks:  # any order can be typed in the list, which writes it into the signature at once
            own = properties.arranged(mesh, [v for v, _ in picks]).text([order for _, order in picks])
            layout.operator("mesh.orbifold_set_signature", text=f"Orders of the List: {own}").signature = own
            layout.separator()
        row = layout.row()
        for geometry, title in GEOMETRIES:
            of_it = [offer for offer in offers if offer.geometry == geometry]
            if of_it:
                column = row.column()
                column.label(text=title)
                column.separator()
                for offer in of_it:
                    text, icon = core.describe(offer.signature), previews.tile(offer.signature)
                    entry = column.operator("mesh.orbifold_set_signature", text=text, icon_value=icon)
                    entry.signature = offer.signature


def draw_entries(self, _context: bpy.types.Context) -> None:
    """What is in a menu is found by F3 too."""
    self.layout.separator()
    self.layout.operator("uv.orbifold_unwrap")
    self.layout.operator("mesh.orbifold_suggest_cones")
    self.layout.operator("mesh.orbifold_show_stretch")
    self.layout.menu(VIEW3D_MT_orbifold.bl_idname)


class VIEW3D_MT_orbifold(bpy.types.Menu):
    """All operators: what is in a menu is found by F3, in every mode."""

    bl_idname = "VIEW3D_MT_orbifold"
    bl_label = "Orbifold"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        for group in MENU_GROUPS:
            for name in group:
                layout.operator(name)
            layout.separator()
        layout.operator("mesh.orbifold_slide_cone").vertex = -1
        layout.operator_menu_enum("mesh.orbifold_show_defect", "kind")
        layout.operator_menu_enum("mesh.orbifold_mend", "kind")
        if mesh_problem(context) is None:
            layout.separator()
            layout.menu(MESH_MT_orbifold_signatures.bl_idname)
            for index, row in enumerate(context.active_object.data.orbifold.suggestions.rows):
                text = f"Place Suggestion {row.signature}"
                layout.operator("mesh.orbifold_place_suggestion", text=text).index = index


def draw_submenu(self, _context: bpy.types.Context) -> None:
    self.layout.separator()
    self.layout.menu(VIEW3D_MT_orbifold.bl_idname)


def draw_image_entries(self, _context: bpy.types.Context) -> None:
    self.layout.separator()
    self.layout.operator_menu_enum("image.orbifold_symmetrize", "source")
    for name in ("image.orbifold_new", "image.orbifold_wallpaper", "image.orbifold_fill_seam_margin"):
        self.layout.operator(name)


MENU_GROUPS = (
    ("uv.orbifold_unwrap", "uv.orbifold_fixed_boundary", "object.orbifold_sphere"),
    ("mesh.orbifold_suggest_cones", "mesh.orbifold_add_cones", "mesh.orbifold_remove_cone", "mesh.orbifold_move_cone",
     "mesh.orbifold_clear_cones", "mesh.orbifold_jump_to_cone"),
    ("mesh.orbifold_show_stretch", "mesh.orbifold_show_distortion", "object.orbifold_tile_preview",
     "object.orbifold_pattern"),
    ("image.orbifold_symmetrize", "image.orbifold_new"),
    ("object.orbifold_pattern_image", "image.orbifold_wallpaper", "image.orbifold_fill_seam_margin",
     "object.orbifold_bake"),
    ("object.orbifold_transfer", "object.orbifold_suggest_order"),
    ("mesh.orbifold_hide_distortion", "mesh.orbifold_cancel_live", "mesh.orbifold_check"),
)
UV_MENUS = ("VIEW3D_MT_uv_map", "IMAGE_MT_uvs")
OBJECT_MENUS = ("VIEW3D_MT_object",)
IMAGE_MENUS = ("IMAGE_MT_image",)
CLASSES = (MESH_MT_orbifold_signatures, VIEW3D_MT_orbifold)


def register() -> None:
    for name in UV_MENUS:
        getattr(bpy.types, name).append(draw_entries)
    for name in OBJECT_MENUS:
        getattr(bpy.types, name).append(draw_submenu)
    for name in IMAGE_MENUS:
        getattr(bpy.types, name).append(draw_image_entries)


def unregister() -> None:
    for name in UV_MENUS:
        getattr(bpy.types, name).remove(draw_entries)
    for name in OBJECT_MENUS:
        getattr(bpy.types, name).remove(draw_submenu)
    for name in IMAGE_MENUS:
        getattr(bpy.types, name).remove(draw_image_entries)
