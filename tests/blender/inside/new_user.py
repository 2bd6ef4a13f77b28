# SPDX-License-Identifier: GPL-3.0-or-later
"""In a real window, as somebody works who has just got the zip: by clicks and keys. Only the zip is installed, the mesh
made and subdivided, the editors arranged, the file saved and opened by the operators that Blender's own buttons call.
Arguments: the zip, the beginning of the screenshots' names or -, JSON."""

import os
import sys
import tempfile

import bpy
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d

sys.path.insert(0, os.path.dirname(__file__))
from harness import blob, enable, far_among, install, module_name, uv_of  # noqa: E402
from windowed import (  # noqa: E402
    areas, click_at, drive, find_button, in_view, move_into, photographed, press, region_of, reports, show_info,
    show_tab, type_in,
)

package, picture, out = sys.argv[-3:]
seen = {}


def the_object():
    return bpy.context.view_layer.objects.active


def uv_map():
    return uv_of(the_object())


def cones():
    return [(item.vertex, item.order) for item in the_object().data.orbifold.cones]


def steps():
    install(package)
    enable()
    seen["enabled"] = module_name() in bpy.context.preferences.addons
    yield from show_info()
    blob(4)
    picks = yield from picked_by_clicks()
    yield from press_button("mesh.orbifold_add_cones")
    yield lambda: len(cones())
    seen["picks"], seen["cones"] = picks, cones()
    yield from unwrapped()
    yield from undone_and_done_again()
    yield from beside_it()
    yield from searched()
    yield from escaped()
    yield from saved_and_opened()


def key(name, wanted, **held):
    """Press a key in the 3D view, and wait for what it does."""
    move_into()
    yield
    press(name, **held)
    yield wanted


def picked_by_clicks():
    """Four vertices in front, the second and later ones with shift."""
    view = areas("VIEW_3D")[0].spaces.active.region_3d
    yield from key("TAB", lambda: the_object().mode == "EDIT")
    yield from key("NUMPAD_1", lambda: abs(view.view_matrix[1][2] - 1) < 1e-5)
    yield from key("NUMPAD_PERIOD", lambda: abs(view.view_distance - 15) > 1)
    yield from still(lambda: view.view_distance)
    yield from key("A", lambda: the_object().data.total_vert_sel == 0, alt=True)
    mesh, region = the_object().data, region_of()
    in_front = [vertex.index for vertex in mesh.vertices if vertex.normal.y < -0.5]
    chosen = far_among(mesh, in_front, 4)
    for count, vertex in enumerate(chosen):
        at = location_3d_to_region_2d(region, view, mesh.vertices[vertex].co)
        yield from click_at(region.x + at.x, region.y + at.y, shift=count > 0)
        yield lambda: mesh.total_vert_sel == count + 1
    return chosen


def still(value):
    """Until two ticks see the same."""
    last = None
    while value() != last:
        last = value()
        yield


def press_button(operator):
    """In the sidebar."""
    yield from show_tab("VIEW_3D", "VIEW3D_PT_orbifold")
    x, y = yield from find_button("VIEW_3D", operator)
    yield from click_at(x, y)


def unwrapped():
    """By the button; the certificate is in the report."""
    yield from press_button("uv.orbifold_unwrap")
    yield lambda: len(uv_map())
    yield lambda: "certified" in reports()
    seen["mode"] = the_object().mode
    seen["report"] = [line for line in reports().splitlines() if "certified" in line]
    yield from photographed(picture, "pressed")
    seen["redo_panel"] = bpy.context.window_manager.operators[-1].bl_idname


def undone_and_done_again():
    """One Ctrl-Z takes the unwrap back, and leaves the cones; Ctrl-Shift-Z brings it back."""
    before, picked = uv_map(), cones()
    yield from key("Z", lambda: not len(uv_map()), ctrl=True)
    seen["cones_stay"] = cones() == picked
    yield from key("Z", lambda: len(uv_map()), ctrl=True, shift=True)
    seen["redone"] = bool(np.array_equal(uv_map(), before)) and cones() == picked


def beside_it():
    """The layout in a UV editor beside the 3D view."""
    yield from key("A", lambda: the_object().data.total_vert_sel > 4)
    with in_view():
        bpy.ops.screen.area_split(direction="VERTICAL", factor=0.5)
    yield
    min(areas("VIEW_3D"), key=lambda area: area.x).ui_type = "UV"
    yield
    if picture == "-":
        return
    for kind, panel in (("VIEW_3D", "VIEW3D_PT_orbifold"), ("IMAGE_EDITOR", "IMAGE_PT_orbifold")):
        yield from show_tab(kind, panel)
    yield from photographed(picture, "sidebars")
    for kind in ("VIEW_3D", "IMAGE_EDITOR"):
        areas(kind)[0].spaces.active.show_region_ui = False
        move_into(kind)
        yield
        press("HOME")
    yield from photographed(picture, "beside")


def searched():
    """F3 and the operator's name."""
    ended = reports().count("certified")
    yield from key("F3", None)
    yield from type_in("Orbifold Unwrap")
    press("RET")
    yield lambda: reports().count("certified") > ended
    seen["searched"] = bpy.context.window_manager.operators[-1].bl_idname


def escaped():
    """More than 100,000 vertices, and Esc while they are unwrapped."""
    yield from key("A", lambda: the_object().data.total_vert_sel > 4)
    with in_view():
        bpy.ops.mesh.subdivide(number_cuts=15)
    yield from key("TAB", lambda: the_object().mode == "OBJECT")
    seen["vertices"] = len(the_object().data.vertices)
    before, ended = uv_map(), reports().count("cancelled")
    yield from press_button("uv.orbifold_unwrap")
    press("ESC")
    yield lambda: reports().count("cancelled") > ended
    seen["uv_kept"] = bool(np.array_equal(uv_map(), before))
    ended = reports().count("certified")
    yield from press_button("uv.orbifold_unwrap")
    yield lambda: reports().count("certified") > ended
    seen["uv_new"] = not np.array_equal(uv_map(), before)


def saved_and_opened():
    """UV map, cones and settings are there again."""
    name, picked, map_before = the_object().name, cones(), uv_map()
    the_object().data.orbifold.keep_away = "Face"
    bpy.context.scene.orbifold_view.show_cut = False
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "saved.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.read_homefile()
        yield
        bpy.ops.wm.open_mainfile(filepath=path)
        yield
    settings = the_object().data.orbifold
    seen["reopened"] = [
        the_object().name == name, cones() == picked, bool(np.array_equal(uv_map(), map_before)), settings.signature,
        settings.keep_away, bpy.context.scene.orbifold_view.show_cut,
    ]


bpy.context.preferences.view.show_splash = False
drive(steps(), seen, out)
