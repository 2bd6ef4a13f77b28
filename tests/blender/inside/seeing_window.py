# SPDX-License-Identifier: GPL-3.0-or-later
"""In a real window: cones and cut are drawn, the heat map, the tile, Orbifold Live by keys. Arguments: the beginning of
the screenshots' names or -, JSON."""

import os
import sys

import bpy
import numpy as np

sys.path.insert(0, os.path.dirname(__file__))
from harness import blob, edit_mode, enable, object_mode, part, set_cones, uv_of  # noqa: E402
from windowed import areas, drive, in_view, photographed, press, region_of, show_tab, window  # noqa: E402

picture, out = sys.argv[-2:]
seen = {}


def pixels():
    """What the 3D view shows, (height, width, 3)."""
    import subprocess

    region = region_of()
    box = f"{region.width}x{region.height}+{region.x}+{window().height - region.y - region.height}"
    made = subprocess.run(
        ["import", "-window", "root", "-crop", box, "-depth", "8", "rgb:-"], check=True, stdout=subprocess.PIPE
    ).stdout
    return np.frombuffer(made, np.uint8).reshape(region.height, region.width, 3).astype(int)


def counts(colours):
    """How many pixels of the 3D view have nearly these colours in [0, 1]."""
    image = pixels()
    return [int((np.abs(image - 255 * np.asarray(colour)).max(-1) < 30).sum()) for colour in colours]


def pause(ticks):
    for _ in range(ticks):
        yield


def steps():
    obj = blob(5)
    set_cones(obj, "442")
    with in_view():
        bpy.ops.uv.orbifold_unwrap(pattern=False)
        bpy.ops.view3d.view_axis(type="RIGHT")
        bpy.ops.view3d.view_selected()
        bpy.ops.object.select_all(action="DESELECT")
    yield from photographed(picture, "cones")
    cones, cut = part("pattern").palette(3), part("overlay").path_colours(2)
    yield lambda: min(counts(cones)) > 30 and min(counts(cut)) > 200
    bpy.context.scene.orbifold_view.show_cones = bpy.context.scene.orbifold_view.show_cut = False
    yield lambda: max(counts(cones)) < 20
    seen["drawn_and_not_drawn"] = True
    bpy.context.scene.orbifold_view.show_cones = bpy.context.scene.orbifold_view.show_cut = True
    yield from heat_map()
    yield from live(obj)
    yield from tile()


def heat_map():
    shading = areas("VIEW_3D")[0].spaces.active.shading
    seen["shading"] = [shading.color_type]
    with in_view():
        bpy.ops.mesh.orbifold_show_distortion(measure="AREA")
    seen["shading"].append(shading.color_type)
    yield from photographed(picture, "heat")
    with in_view():
        bpy.ops.mesh.orbifold_hide_distortion()
    seen["shading"].append(shading.color_type)
    yield


def live(obj):
    """Arrow keys move the active cone; each move changes the UVs and is one undo step."""
    state = part("live")._State
    edit_mode()
    with in_view():
        bpy.ops.screen.area_split(direction="VERTICAL", factor=0.5)
    yield
    min(areas("VIEW_3D"), key=lambda area: area.x).ui_type = "UV"
    yield
    if picture != "-":
        yield from show_tab("VIEW_3D", "VIEW3D_PT_orbifold_show")
    obj.data.orbifold.active_cone = 2
    bpy.ops.ed.undo_push(message="before")
    bpy.context.window_manager.orbifold_live = True
    yield lambda: not bpy.app.timers.is_registered(part("live")._tick)
    before, start = uv_of(obj), obj.data.orbifold.cones[2].vertex
    with in_view("IMAGE_EDITOR"):
        bpy.ops.image.view_all(fit_view=True)
    with in_view():
        seen["invoked"] = list(bpy.ops.mesh.orbifold_slide_cone("INVOKE_DEFAULT", True))
    yield
    for key in ("UP_ARROW", "RIGHT_ARROW"):
        press(key)
        yield from pause(5)
    yield lambda: not bpy.app.timers.is_registered(part("live")._tick)
    seen["cone_moved"] = obj.data.orbifold.cones[2].vertex != start
    seen["uv_changed"] = float(np.abs(uv_of(obj) - before).max())
    seen["problems"] = list(state.problems.values())
    bpy.ops.mesh.select_all(action="SELECT")
    yield from photographed(picture, "live")
    press("RET")
    yield from pause(5)
    for _ in range(2):
        with in_view():
            bpy.ops.ed.undo()
        yield from pause(3)
    obj = bpy.context.view_layer.objects.active
    seen["cone_after_undo"] = obj.data.orbifold.cones[2].vertex == start
    yield lambda: not bpy.app.timers.is_registered(part("live")._tick)
    seen["uv_after_undo"] = float(np.abs(uv_of(obj) - before).max())
    obj.data.orbifold.signature = "44"
    yield lambda: not bpy.app.timers.is_registered(part("live")._tick)
    seen["impossible"] = [part("live").problem(obj.data), float(np.abs(uv_of(obj) - before).max())]
    yield from photographed(picture, "impossible")
    obj.data.orbifold.signature = "442"
    yield lambda: not bpy.app.timers.is_registered(part("live")._tick)
    seen["possible_again"] = part("live").problem(obj.data)
    bpy.context.window_manager.orbifold_live = False
    object_mode()


def tile():
    with in_view():
        seen["tile"] = list(bpy.ops.object.orbifold_tile_preview())
        bpy.ops.object.select_all(action="SELECT")
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_selected()
    yield from photographed(picture, "tile")


enable()
bpy.context.preferences.view.show_splash = False
drive(steps(), seen, out)
