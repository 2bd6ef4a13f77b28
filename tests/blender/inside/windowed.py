# SPDX-License-Identifier: GPL-3.0-or-later
"""For scripts that drive a real window: a generator of steps, one a timer tick; what was seen is written as JSON."""

from __future__ import annotations

import json
import os
import subprocess
import traceback
from typing import Generator

import bpy

TICK, PATIENCE = 0.1, 900  # seconds; ticks for one wait


def window() -> bpy.types.Window:
    return bpy.context.window_manager.windows[0]


def areas(kind: str) -> list[bpy.types.Area]:
    return [area for area in window().screen.areas if area.type == kind]


def region_of(kind: str = "VIEW_3D") -> bpy.types.Region:
    return next(region for region in areas(kind)[0].regions if region.type == "WINDOW")


def in_view(kind: str = "VIEW_3D"):
    return bpy.context.temp_override(window=window(), area=areas(kind)[0], region=region_of(kind))


def press(key: str) -> None:
    window().event_simulate(type=key, value="PRESS")
    window().event_simulate(type=key, value="RELEASE")


def photograph(path: str) -> None:
    subprocess.run(["import", "-window", "root", path], check=True)


def show_tab(kind: str, panel: str) -> Generator:
    """Choose the tab Orbifold in the sidebar; Blender 3 leaves no other way than clicks at its edge, until our panel is
    drawn."""
    area = areas(kind)[0]
    area.spaces.active.show_region_ui = True
    yield
    region = next(region for region in area.regions if region.type == "UI")
    if hasattr(region, "active_panel_category"):
        region.active_panel_category = "Orbifold"
        area.tag_redraw()
        return
    drawn = []

    def note(_panel, context) -> None:
        drawn.append(context.area.as_pointer())

    getattr(bpy.types, panel).append(note)
    drawn.clear()
    for y in range(region.y + region.height - 20, region.y + 20, -25):
        for kind_of, value in (("MOUSEMOVE", "NOTHING"), ("LEFTMOUSE", "PRESS"), ("LEFTMOUSE", "RELEASE")):
            window().event_simulate(type=kind_of, value=value, x=region.x + region.width - 12, y=y)
            yield
        yield
        if area.as_pointer() in drawn:
            break
    getattr(bpy.types, panel).remove(note)


def drive(todo: Generator, seen: dict, out: str) -> None:
    """Advance the steps by one at each tick, or wait for the function that was yielded; end Blender after the last."""
    state = {"waiting": None, "ticks": 0}

    def tick() -> float:
        try:
            if state["waiting"] is not None and not state["waiting"]():
                state["ticks"] += 1
                if state["ticks"] > PATIENCE:
                    raise TimeoutError("the state that was waited for did not come")
                return TICK
            state["waiting"], state["ticks"] = next(todo), 0
            return TICK
        except StopIteration:
            seen["finished"] = True
        except Exception:
            seen["error"] = traceback.format_exc()
        with open(out, "w", encoding="utf-8") as file:
            json.dump(seen, file)
        os._exit(0)

    bpy.app.timers.register(tick, first_interval=1.0)
