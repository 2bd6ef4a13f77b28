# SPDX-License-Identifier: GPL-3.0-or-later
"""In a real window: the panel, the modal operators, Esc. Arguments: SCREENSHOT or -, JSON; a second picture, of the
table of suggestions, goes beside the first.

Events are simulated one a timer tick; each step polls for the state that it wants. What was seen is written as JSON:
only that counts, not the exit status."""

import json
import os
import subprocess
import sys
import traceback

import bpy

sys.path.insert(0, os.path.dirname(__file__))
from harness import blob, click, edit_mode, enable, far_vertices, object_mode, set_cones  # noqa: E402

TICK, PATIENCE = 0.1, 900  # seconds; ticks for one wait
picture, out = sys.argv[-2:]
seen = {}


def window():
    return bpy.context.window_manager.windows[0]


def areas(kind):
    return [area for area in window().screen.areas if area.type == kind]


def in_view(kind="VIEW_3D", region="WINDOW"):
    area = areas(kind)[0]
    part_of = next(r for r in area.regions if r.type == region)
    return bpy.context.temp_override(window=window(), area=area, region=part_of)


def steps():
    """A generator: each `yield` waits for the next tick; a function that is yielded is waited for."""
    obj = blob(4)
    edit_mode()
    click(far_vertices(obj, 3))
    areas("VIEW_3D")[0].spaces.active.show_region_ui = True
    yield
    with in_view():
        bpy.ops.mesh.orbifold_add_cones("INVOKE_DEFAULT")
        bpy.ops.mesh.select_all(action="SELECT")
    obj.data.orbifold.signature = "432"
    bpy.ops.ed.undo_push(message="picked")
    with in_view():
        bpy.ops.view3d.view_selected()
        bpy.ops.screen.area_split(direction="VERTICAL", factor=0.5)
    yield
    left = min(areas("VIEW_3D"), key=lambda area: area.x)
    left.ui_type = "UV"
    left.spaces.active.show_region_ui = True
    yield
    for area in areas("VIEW_3D") + areas("IMAGE_EDITOR"):
        for region in area.regions:
            if region.type == "UI" and hasattr(region, "active_panel_category"):
                try:
                    region.active_panel_category = "Orbifold"
                except (AttributeError, TypeError):
                    pass
    with in_view():
        seen["invoked"] = list(bpy.ops.uv.orbifold_unwrap("INVOKE_DEFAULT", True, pattern=True))
    yield lambda: "Orbifold" in obj.data.uv_layers
    seen["mode"] = obj.mode
    seen["shape_keys"] = [key.name for key in obj.data.shape_keys.key_blocks] if obj.data.shape_keys else []
    if picture != "-":
        for area in areas("VIEW_3D"):
            area.spaces.active.shading.type = "MATERIAL"
        for _ in range(20):
            yield
        for kind in ("VIEW_3D", "IMAGE_EDITOR"):
            for area in areas(kind):
                yield from show_tab(area)
        with in_view():
            bpy.ops.view3d.view_selected()
        with in_view("IMAGE_EDITOR"):
            bpy.ops.image.view_all(fit_view=True)
        for _ in range(30):
            yield
        subprocess.run(["import", "-window", "root", picture], check=True)
    yield from undone(obj.name)
    yield from suggested()
    yield from one_click()
    yield from escaped()


def show_tab(area):
    """Choose the tab Orbifold; Blender 3 leaves no other way than clicks at the sidebar's right edge."""
    region = next(r for r in area.regions if r.type == "UI")
    if hasattr(region, "active_panel_category"):
        region.active_panel_category = "Orbifold"
        area.tag_redraw()
        return
    drawn.discard((area.as_pointer(), area.type))  # at first the panels of all tabs are drawn
    x = region.x + region.width - 12
    for y in range(region.y + region.height - 20, region.y + 20, -25):
        if y < region.y:
            break
        window().event_simulate(type="MOUSEMOVE", value="NOTHING", x=x, y=y)
        yield
        window().event_simulate(type="LEFTMOUSE", value="PRESS", x=x, y=y)
        yield
        window().event_simulate(type="LEFTMOUSE", value="RELEASE", x=x, y=y)
        yield
        if (area.as_pointer(), area.type) in drawn:
            return


drawn = set()


def watch_panels():
    """Note in which editors our panel is drawn."""
    for name in ("VIEW3D_PT_orbifold", "IMAGE_PT_orbifold"):
        cls = getattr(bpy.types, name)
        cls.append(lambda self, context: drawn.add((context.area.as_pointer(), context.area.type)))


def undone(name):
    with in_view():
        bpy.ops.ed.undo()
    yield
    object_mode()
    yield
    obj = bpy.data.objects[name]
    seen["uv_after_undo"] = [layer.name for layer in obj.data.uv_layers]
    seen["cones_after_undo"] = [item.order for item in obj.data.orbifold.cones]


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
        for area in areas("VIEW_3D"):
            area.spaces.active.shading.type = "SOLID"
        with in_view():
            bpy.ops.mesh.orbifold_show_stretch()
        object_mode()
        yield from photographed("-table")
        edit_mode()
    with in_view():
        bpy.ops.ed.undo()
    yield
    settings = bpy.context.object.data.orbifold
    seen["after_undo"] = [len(settings.cones), settings.signature]


def photographed(ending):
    for _ in range(30):
        yield
    stem, dot, kind = picture.rpartition(".")
    subprocess.run(["import", "-window", "root", stem + ending + dot + kind], check=True)


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
    window().event_simulate(type="ESC", value="PRESS")
    for _ in range(20):
        yield
    seen["rows_after_esc"] = len(obj.data.orbifold.suggestions.rows)
    set_cones(obj, "442")
    bpy.ops.ed.undo_push(message="large")
    yield
    with in_view():
        seen["invoked_large"] = list(bpy.ops.uv.orbifold_unwrap("INVOKE_DEFAULT", True))
    window().event_simulate(type="ESC", value="PRESS")  # before a frame, which can take longer than the whole job
    for _ in range(20):
        yield
    seen["uv_after_esc"] = [layer.name for layer in obj.data.uv_layers]
    with in_view():
        seen["invoked_again"] = list(bpy.ops.uv.orbifold_unwrap("INVOKE_DEFAULT", True))
    yield lambda: "Orbifold" in obj.data.uv_layers


def drive(todo):
    """Advance the steps by one at each tick; end Blender after the last."""
    state = {"waiting": None, "ticks": 0}

    def tick():
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


enable()
bpy.context.preferences.view.show_splash = False  # it would cover the picture
watch_panels()
drive(steps())
