# SPDX-License-Identifier: GPL-3.0-or-later
"""For scripts that drive a real window: a generator of steps, one a timer tick; what was seen is written as JSON."""

from __future__ import annotations

import faulthandler
import json
import os
import subprocess
import traceback
from typing import Generator

import bpy
from harness import HANGS

TICK, PATIENCE = 0.1, 900  # seconds; ticks for one wait


def window() -> bpy.types.Window:
    return bpy.context.window_manager.windows[0]


def areas(kind: str) -> list[bpy.types.Area]:
    return [area for area in window().screen.areas if area.type == kind]


def region_of(kind: str = "VIEW_3D") -> bpy.types.Region:
    return next(region for region in areas(kind)[0].regions if region.type == "WINDOW")


def in_view(kind: str = "VIEW_3D"):
    return bpy.context.temp_override(window=window(), area=areas(kind)[0], region=region_of(kind))


class Mouse:
    """Where it is: events without a place are at (0, 0)."""

    x, y = 0, 0


def simulate(kind: str, value: str, **more) -> None:
    window().event_simulate(type=kind, value=value, x=Mouse.x, y=Mouse.y, **more)


def press(key: str, **held: bool) -> None:
    """Held: shift, ctrl, alt."""
    simulate(key, "PRESS", **held)
    simulate(key, "RELEASE", **held)


def type_in(text: str) -> Generator:
    for letter in text:
        key = {" ": "SPACE", "-": "MINUS"}.get(letter, letter.upper())
        simulate(key, "PRESS", unicode=letter)
        simulate(key, "RELEASE")
        yield


def move_to(x: float, y: float) -> None:
    Mouse.x, Mouse.y = int(x), int(y)
    simulate("MOUSEMOVE", "NOTHING")


def click_at(x: float, y: float, **held: bool) -> Generator:
    move_to(x, y)
    yield
    simulate("LEFTMOUSE", "PRESS", **held)
    yield
    simulate("LEFTMOUSE", "RELEASE", **held)
    yield


def move_into(kind: str = "VIEW_3D") -> None:
    """Between toolbar and sidebar."""
    region = region_of(kind)
    move_to(region.x + 0.3 * region.width, region.y + region.height / 2)


def find_button(kind: str, operator: str) -> Generator:
    """(x, y) of the button of an operator in the sidebar: the mouse goes down it, and Blender says what is under it."""
    area = areas(kind)[0]
    region = next(region for region in area.regions if region.type == "UI")
    x = region.x + 0.3 * region.width
    command = bpy.ops.ui.copy_python_command_button
    for y in range(region.y + region.height - 10, region.y + 10, -8):
        move_to(x, y)
        yield
        with bpy.context.temp_override(window=window(), area=area, region=region):
            if command.poll():
                command()
                if bpy.context.window_manager.clipboard.startswith(f"bpy.ops.{operator}("):
                    return x, y
    raise LookupError(f"no button of {operator} is in the sidebar")


def show_info() -> Generator:
    """The Info editor in place of the timeline, for `reports`."""
    areas("DOPESHEET_EDITOR")[0].ui_type = "INFO"
    yield


def reports() -> str:
    """All that the Info editor lists."""
    with in_view("INFO"):
        bpy.ops.info.select_all(action="SELECT")
        bpy.ops.info.report_copy()
    return bpy.context.window_manager.clipboard


def photograph(path: str) -> None:
    subprocess.run(["import", "-window", "root", path], check=True)


def photographed(picture: str, name: str) -> Generator:
    """Two seconds later, when all is drawn; `picture` - for no picture."""
    for _ in range(20 if picture != "-" else 0):
        yield
    if picture != "-":
        photograph(f"{picture}-{name}.png")


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
        yield
        return
    drawn = []

    def note(_panel, context) -> None:
        drawn.append(context.area.as_pointer())

    def is_shown() -> Generator:
        yield  # what is under way; in a sidebar that has just been opened the panels of all tabs are drawn once
        drawn.clear()
        area.tag_redraw()
        yield
        return area.as_pointer() in drawn

    getattr(bpy.types, panel).append(note)
    shown, y = (yield from is_shown()), region.y + region.height - 20
    while not shown and y > region.y + 20:
        yield from click_at(region.x + region.width - 12, y)
        shown, y = (yield from is_shown()), y - 25
    getattr(bpy.types, panel).remove(note)
    if not shown:
        raise LookupError(f"{panel} is not in the sidebar")


def where(steps: Generator) -> str:
    """The place where steps have come to."""
    while steps.gi_yieldfrom is not None:
        steps = steps.gi_yieldfrom
    return f"{steps.gi_code.co_name}, line {steps.gi_frame.f_lineno}"


def drive(todo: Generator, seen: dict, out: str) -> None:
    """Advance the steps by one at each tick, or wait for the function that was yielded; end Blender after the last. A
    picture of the screen is beside `out` where they fail."""
    state = {"waiting": None, "ticks": 0}

    def tick() -> float:
        try:
            if state["waiting"] is not None and not state["waiting"]():
                state["ticks"] += 1
                if state["ticks"] > PATIENCE:
                    raise TimeoutError(f"what was waited for did not come: {where(todo)}")
                return TICK
            state["waiting"], state["ticks"] = next(todo), 0
            return TICK
        except StopIteration:
            seen["finished"] = True
        except Exception:
            seen["error"] = traceback.format_exc()
            photograph(f"{out}.png")
        with open(out, "w", encoding="utf-8") as file:
            json.dump(seen, file)
        os._exit(0)

    faulthandler.dump_traceback_later(HANGS, exit=True)
    bpy.app.timers.register(tick, first_interval=1.0, persistent=True)  # another file is loaded too
