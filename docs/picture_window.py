# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's window for window_pictures.py: editors, sidebar, mouse and keys, screenshots. Steps are generators: a
`yield` waits for the next tick of a timer, so that Blender draws in between; a function that is yielded is waited
for."""

from __future__ import annotations

import os
import subprocess
import sys
import traceback
from collections.abc import Generator

import bpy
import numpy as np
from mathutils import Euler, Vector

TICK, PATIENCE, FRAMES = 0.1, 600, 12  # seconds; ticks of one wait; ticks after which all is drawn
SCALE = 1.15  # of the interface: pictures are shown smaller than they are
folds = {"open": "Orbifold UV"}


def set_up() -> None:
    view = bpy.context.preferences.view
    view.show_splash = view.show_tooltips = False
    view.ui_scale = SCALE
    bpy.context.preferences.system.use_region_overlap = False


def window() -> bpy.types.Window:
    return bpy.context.window_manager.windows[0]


def area_of(kind: str) -> bpy.types.Area:
    return next(area for area in window().screen.areas if area.type == kind)


def region_of(kind: str, region: str = "WINDOW") -> bpy.types.Region:
    return next(found for found in area_of(kind).regions if found.type == region)


def inside(kind: str = "VIEW_3D"):
    return bpy.context.temp_override(window=window(), area=area_of(kind), region=region_of(kind))


def pointer(x: float, y: float, *events: tuple[str, str]) -> Generator:
    """Move the mouse there and press."""
    for kind, value in (("MOUSEMOVE", "NOTHING"), *events):
        window().event_simulate(type=kind, value=value, x=int(x), y=int(y))
        yield


def click(x: float, y: float) -> Generator:
    return pointer(x, y, ("LEFTMOUSE", "PRESS"), ("LEFTMOUSE", "RELEASE"))


def press(key: str) -> None:
    for value in ("PRESS", "RELEASE"):
        window().event_simulate(type=key, value=value)


def away() -> Generator:
    """The mouse where it changes nothing."""
    return pointer(window().width // 2, window().height - 6)


def pause(ticks: int = FRAMES) -> Generator:
    for _ in range(ticks):
        yield


def photograph(path: str, box: tuple[float, float, float, float] = (0, 0, 1, 1)) -> Generator:
    """The rectangle of all editors, or a part of it: left, top, right, bottom."""
    yield from pause()
    there = window().screen.areas
    left, low = min(area.x for area in there), min(area.y for area in there)
    width = max(area.x + area.width for area in there) - left
    height = max(area.y + area.height for area in there) - low
    x, y = left + int(box[0] * width), window().height - low - height + int(box[1] * height)
    size = f"{int((box[2] - box[0]) * width)}x{int((box[3] - box[1]) * height)}+{x}+{y}"
    subprocess.run(["import", "-window", "root", "-crop", size, "+repage", path], check=True)


def arrange() -> Generator:
    """A 3D view and nothing else, without what is of no use here."""
    for kind in ("DOPESHEET_EDITOR", "OUTLINER", "PROPERTIES"):
        with bpy.context.temp_override(window=window(), area=area_of(kind)):
            bpy.ops.screen.area_close()
        yield
    space = area_of("VIEW_3D").spaces.active
    space.show_region_toolbar = space.show_gizmo = False
    overlay = space.overlay
    overlay.show_floor = overlay.show_axis_x = overlay.show_axis_y = overlay.show_text = overlay.show_cursor = False
    overlay.show_object_origins = overlay.show_relationship_lines = False
    yield from sidebar("VIEW_3D", "VIEW3D_PT_orbifold")


def uv_editor(share: float = 0.4) -> Generator:
    """To the left of the 3D view, with this share of its width."""
    with inside():
        bpy.ops.screen.area_split(direction="VERTICAL", factor=share)
    yield
    left = min((area for area in window().screen.areas if area.type == "VIEW_3D"), key=lambda area: area.x)
    left.ui_type = "UV"
    yield
    left.spaces.active.show_region_ui = left.spaces.active.show_gizmo = False
    left.spaces.active.show_region_toolbar = False


def no_uv_editor() -> Generator:
    if any(area.type == "IMAGE_EDITOR" for area in window().screen.areas):
        with bpy.context.temp_override(window=window(), area=area_of("IMAGE_EDITOR")):
            bpy.ops.screen.area_close()
    yield


def sidebar(kind: str, panel: str) -> Generator:
    """Choose the tab Orbifold: version 3 leaves no other way than clicks at the edge, until our panel is drawn."""
    area_of(kind).spaces.active.show_region_ui = True
    yield from pause(3)
    region = region_of(kind, "UI")
    if hasattr(region, "active_panel_category"):
        region.active_panel_category = "Orbifold"
        return
    drawn: list[bool] = []

    def note(_panel, _context) -> None:
        drawn.append(True)

    getattr(bpy.types, panel).append(note)
    for y in range(region.y + region.height - 20, region.y + 20, -20):
        drawn.clear()  # at first the panels of all tabs are drawn
        yield from click(region.x + region.width - 10, y)
        yield from pause(2)
        if drawn:
            break
    getattr(bpy.types, panel).remove(note)
    yield from away()


def tab(panel: str) -> Generator:
    """Show the panel "Orbifold UV", or fold it, so that "Show" is to be seen: a click on its title does either."""
    if panel != folds["open"]:
        region = region_of("VIEW_3D", "UI")
        yield from click(region.x + 0.4 * region.width, region.y + region.height - 15 * SCALE)
        yield from away()
        folds["open"] = panel


def scroll(steps: int) -> Generator:
    """The sidebar, downwards."""
    region, kind = region_of("VIEW_3D", "UI"), "WHEELDOWNMOUSE" if steps > 0 else "WHEELUPMOUSE"
    for _ in range(abs(steps)):
        yield from pointer(region.x + region.width // 3, region.y + region.height // 2, (kind, "PRESS"))
    yield from away()


def look(rotation: tuple[float, float, float], at: tuple[float, float, float], distance: float) -> None:
    """Degrees, a point and how far off."""
    view = area_of("VIEW_3D").spaces.active.region_3d
    view.view_perspective = "PERSP"
    view.view_rotation = Euler([np.radians(angle) for angle in rotation]).to_quaternion()
    view.view_location, view.view_distance = Vector(at), distance


def shade(kind: str) -> None:
    shading = area_of("VIEW_3D").spaces.active.shading
    shading.type = kind
    if kind == "SOLID":
        shading.color_type = "MATERIAL"


def drive(todo: Generator) -> None:
    """Advance by one step at each tick, or wait for what was yielded; end Blender after the last one."""
    state: dict = {"waiting": None, "ticks": 0}

    def tick() -> float:
        status = 0
        try:
            if state["waiting"] is not None and not state["waiting"]():
                state["ticks"] += 1
                if state["ticks"] > PATIENCE:
                    raise TimeoutError("the state that was waited for did not come")
                return TICK
            state["waiting"], state["ticks"] = next(todo), 0
            return TICK
        except StopIteration:
            pass
        except Exception:
            traceback.print_exc()
            status = 1
        sys.stdout.flush()
        os._exit(status)

    bpy.app.timers.register(tick, first_interval=1.0)
