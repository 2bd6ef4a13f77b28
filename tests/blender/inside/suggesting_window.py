# SPDX-License-Identifier: GPL-3.0-or-later
"""In a real window: suggestions, their table, one click for all, Esc. Arguments: the beginning of the screenshots'
names or -, JSON."""

import os
import sys

import bpy

sys.path.insert(0, os.path.dirname(__file__))
from harness import blob, edit_mode, enable, object_mode  # noqa: E402
from windowed import drive, in_view, photographed, press, reports, show_info, show_tab  # noqa: E402

picture, out = sys.argv[-2:]
seen = {}


def steps():
    yield from show_info()
    yield from suggested()
    yield from one_click()
    yield from escaped()


def suggested():
    """Suggest Cones, and a row of its table."""
    obj = blob(4)
    obj.vertex_groups.new(name="Face")
    obj.data.orbifold.keep_away = "Face"
    edit_mode()
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.ed.undo_push(message="to suggest")
    yield
    with in_view():
        seen["invoked_suggest"] = list(bpy.ops.mesh.orbifold_suggest_cones("INVOKE_DEFAULT", True))
    table = obj.data.orbifold.suggestions
    yield lambda: len(table.rows)
    seen["mode_after_suggest"] = obj.mode
    with in_view():
        bpy.ops.mesh.orbifold_place_suggestion("INVOKE_DEFAULT", True, index=1)
    seen["placed"] = [table.active, obj.data.orbifold.signature == table.rows[1].signature]
    if picture != "-":
        with in_view():
            bpy.ops.mesh.orbifold_show_stretch()
        object_mode()
        yield from show_tab("VIEW_3D", "VIEW3D_PT_orbifold")
        yield from photographed(picture, "table")
        edit_mode()
    with in_view():
        bpy.ops.ed.undo()
    yield
    settings = bpy.context.object.data.orbifold
    seen["after_undo"] = [len(settings.cones), settings.signature]


def one_click():
    """Unwrap with no cones: two jobs in turn, one undo step."""
    obj = blob(4)
    bpy.ops.ed.undo_push(message="bare")
    yield
    with in_view():
        seen["invoked_bare"] = list(bpy.ops.uv.orbifold_unwrap("INVOKE_DEFAULT", True))
    yield lambda: "Orbifold" in obj.data.uv_layers
    seen["cones_of_one_click"] = len(obj.data.orbifold.cones)
    with in_view():
        bpy.ops.ed.undo()
    yield
    obj = bpy.context.object
    seen["after_one_undo"] = [len(obj.data.uv_layers), len(obj.data.orbifold.cones), obj.data.orbifold.signature]


def escaped():
    """Esc while a large mesh is computed."""
    obj = blob(8)
    bpy.ops.ed.undo_push(message="large without cones")
    yield
    with in_view():
        seen["invoked_suggest_large"] = list(bpy.ops.mesh.orbifold_suggest_cones("INVOKE_DEFAULT", True))
    press("ESC")
    yield lambda: "cancelled" in reports()
    seen["rows_after_esc"] = len(obj.data.orbifold.suggestions.rows)


enable()
bpy.context.preferences.view.show_splash = False
drive(steps(), seen, out)
