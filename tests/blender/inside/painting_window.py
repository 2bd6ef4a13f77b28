# SPDX-License-Identifier: GPL-3.0-or-later
"""In a real window: strokes of the brush with Symmetric Painting on the mesh and on the image, undo and redo by keys,
Symmetrize Image and its redo panel. Arguments: the beginning of the screenshots' names or -, JSON."""

import os
import sys

import bpy
import numpy as np

sys.path.insert(0, os.path.dirname(__file__))
from harness import blob, enable, part, set_cones  # noqa: E402
from windowed import (  # noqa: E402
    areas, drive, in_view, move_into, move_to, photographed, press, region_of, show_tab, simulate,
)

picture, out = sys.argv[-2:]
seen = {}
COLOUR = (1.0, 0.1, 0.1)


def pixels():
    return part("image_pixels").read(bpy.data.images["Image"])


def is_symmetric():
    symmetry, wallpaper = part("painting").symmetry_for(bpy.data.images["Image"])
    now = pixels()
    same = now.copy()
    wallpaper.symmetrize(same)
    return bool((same == now).all())


def steps():
    yield from prepared()
    yield from strokes()
    yield from on_the_image()
    yield from hasty()
    yield from symmetrized()
    yield from another_file()


def prepared():
    """An unwrapped mesh with a new image in paint mode; the image beside it."""
    obj = blob(4)
    set_cones(obj, "442")
    with in_view():
        bpy.ops.uv.orbifold_unwrap(pattern=False)
        bpy.ops.image.orbifold_new(name="Image", width=512)
        bpy.ops.view3d.view_axis(type="RIGHT")
        bpy.ops.view3d.view_selected()
    yield
    with in_view():
        bpy.ops.screen.area_split(direction="VERTICAL", factor=0.5)
    yield
    min(areas("VIEW_3D"), key=lambda area: area.x).ui_type = "IMAGE_EDITOR"
    yield
    space = areas("IMAGE_EDITOR")[0].spaces.active
    space.image, space.ui_mode = bpy.data.images["Image"], "PAINT"
    with in_view("IMAGE_EDITOR"):
        bpy.ops.image.view_all(fit_view=True)
    shading = areas("VIEW_3D")[0].spaces.active.shading
    shading.type = "SOLID"
    shading.color_type = "TEXTURE"
    with in_view():
        bpy.ops.object.mode_set(mode="TEXTURE_PAINT")
        bpy.context.window_manager.orbifold_symmetric_painting = True
    yield
    take_brush()
    bpy.ops.ed.undo_push(message="to paint")
    if picture != "-":
        yield from show_tab("VIEW_3D", "VIEW3D_PT_orbifold_painting")
    yield


def take_brush():
    """Where Blender comes without its brushes, as from Debian, one of our own."""
    settings = bpy.context.tool_settings
    if settings.image_paint.brush is None:
        bpy.data.brushes.new("Ours", mode="TEXTURE_PAINT").asset_mark()
        with in_view():
            bpy.ops.brush.asset_activate(asset_library_type="LOCAL", relative_asset_identifier="Brush/Ours")
    unified = getattr(settings.image_paint, "unified_paint_settings", None) or settings.unified_paint_settings
    for holder in (settings.image_paint.brush, unified):
        holder.color, holder.size = COLOUR, 20


def stroke(kind, start, end):
    """From one place of an editor's region to another, both in [0, 1]."""
    region = region_of(kind)
    way = [np.array(start) + t * np.subtract(end, start) for t in np.linspace(0, 1, 12)]
    before = pixels()
    way = [(region.x + x * region.width, region.y + y * region.height) for x, y in way]
    move_to(*way[0])
    yield
    simulate("LEFTMOUSE", "PRESS")
    yield
    for place in way:
        move_to(*place)
        yield
    simulate("LEFTMOUSE", "RELEASE")
    yield lambda: (pixels() != before).any()
    for _ in range(5):
        yield


def key(name, **held):
    move_into("VIEW_3D")
    yield
    press(name, **held)
    for _ in range(5):
        yield


def strokes():
    """Two on the mesh, one after a change of a setting, which is an undo step as well; then back and forth."""
    states = [pixels()]
    yield from stroke("VIEW_3D", (0.35, 0.5), (0.6, 0.55))
    states.append(pixels())
    yield from photographed(picture, "stroke")
    bpy.ops.ed.undo_push(message="a setting")
    yield
    yield from stroke("VIEW_3D", (0.25, 0.6), (0.45, 0.4))
    states.append(pixels())
    yield from photographed(picture, "strokes")
    changed = [part("image_pixels").differing(*pair) for pair in zip(states, states[1:])]
    seen["changed"] = [int(mask.sum()) for mask in changed]
    seen["symmetric"] = is_symmetric()
    seen["turned"] = [bool((np.rot90(mask) == mask).all()) for mask in changed]
    seen["undone"] = []
    for held in (dict(ctrl=True),) * 3 + (dict(ctrl=True, shift=True),) * 3:
        yield from key("Z", **held)
        seen["undone"].append([number for number, state in enumerate(states) if (state == pixels()).all()])
        if len(seen["undone"]) == 3:
            yield from photographed(picture, "undone")
    seen["problem"] = part("painting").problem(bpy.data.images["Image"])


def on_the_image():
    """In the image editor; the mouse passes the middle of the image."""
    before = pixels()
    yield from stroke("IMAGE_EDITOR", (0.3, 0.45), (0.6, 0.4))
    changed = part("image_pixels").differing(pixels(), before)
    seen["on_image"] = [int(changed.sum()), is_symmetric()]
    yield from photographed(picture, "image")
    yield from key("Z", ctrl=True)
    seen["on_image_undone"] = bool((pixels() == before).all())


def hasty():
    """The next stroke begins in the tick in which the one before ends; two undos in one tick."""
    before, region = pixels(), region_of()
    places = [(region.x + x * region.width, region.y + y * region.height) for x in (0.3, 0.38, 0.45) for y in (0.5, 0.6)]
    move_to(*places[0])
    yield
    for start, end in (places[:2], places[2:4], places[4:]):
        move_to(*start)
        simulate("LEFTMOUSE", "PRESS")
        yield
        move_to(*end)
        yield
        simulate("LEFTMOUSE", "RELEASE")
    for _ in range(10):
        yield
    seen["hasty"] = [bool((pixels() != before).any()), is_symmetric()]
    move_into("VIEW_3D")
    yield
    for _ in range(3):
        press("Z", ctrl=True)
    for _ in range(10):
        yield
    seen["hasty_undone"] = is_symmetric()
    for _ in range(3):
        if (pixels() != before).any():
            yield from key("Z", ctrl=True)
    seen["hasty_undone_all"] = bool((pixels() == before).all())


def symmetrized():
    """Off, a stroke, then the operator; its setting changed as in the redo panel; one undo."""
    bpy.context.window_manager.orbifold_symmetric_painting = False
    yield from stroke("VIEW_3D", (0.45, 0.6), (0.5, 0.65))
    before = pixels()
    seen["not_repeated"] = not is_symmetric()
    for mode in ("TEXTURE_PAINT", "OBJECT"):
        with in_view():
            bpy.ops.object.mode_set(mode=mode)
            bpy.ops.image.orbifold_symmetrize("EXEC_DEFAULT", True, source="all")
        for _ in range(5):
            yield
        after = pixels()
        found = [is_symmetric(), bool((after != before).any())]
        yield from key("Z", ctrl=True)
        found.append(bool((pixels() == before).all()))
        seen[f"symmetrized_{mode}"] = found


def another_file():
    bpy.context.window_manager.orbifold_symmetric_painting = True
    bpy.ops.wm.read_homefile(use_empty=True)
    yield
    seen["after_loading"] = [part("painting").is_on(), len(part("painting")._State.kept)]


enable()
bpy.context.preferences.view.show_splash = False
drive(steps(), seen, out)
