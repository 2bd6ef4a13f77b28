# SPDX-License-Identifier: GPL-3.0-or-later
"""Enabling and disabling; the package as it was installed."""

import os
import shutil
import sys
from pathlib import Path

import bpy

sys.path.insert(0, os.path.dirname(__file__))
from harness import enable, module_name, part, run_checks  # noqa: E402

MENUS = ("VIEW3D_MT_uv_map", "IMAGE_MT_uvs")


def state() -> dict:
    """All places where an add-on can leave something."""
    handlers = {name: len(getattr(bpy.app.handlers, name)) for name in dir(bpy.app.handlers) if name[0] != "_"
                and isinstance(getattr(bpy.app.handlers, name), list)}
    operators = {f"{group}.{name}" for group in dir(bpy.ops) for name in dir(getattr(bpy.ops, group))
                 if "orbifold" in name}
    return {
        "types": {name for name in dir(bpy.types) if "orbifold" in name.lower()},
        "operators": operators,
        "mesh": {name for name in bpy.types.Mesh.bl_rna.properties.keys()},
        "scene": {name for name in bpy.types.Scene.bl_rna.properties.keys()},
        "window manager": {name for name in bpy.types.WindowManager.bl_rna.properties.keys()},
        "menus": {name: len(getattr(bpy.types, name)._dyn_ui_initialize()) for name in MENUS},
        "handlers": handlers,
    }


before = state()


def check_a_library_and_a_manifest_were_installed():
    folder = Path(enable().__file__).parent
    assert (folder / "core" / "liborbifold.so").is_file()
    assert (folder / "blender_manifest.toml").is_file()


def check_enabling_adds_operators_menus_and_the_property():
    now = state()
    wanted = "uv.orbifold_unwrap object.orbifold_sphere mesh.orbifold_add_cones mesh.orbifold_suggest_cones"
    assert set(wanted.split()) <= now["operators"]
    assert "orbifold" in now["mesh"]
    assert "orbifold_view" in now["scene"] and "orbifold_live" in now["window manager"]
    assert all(now["menus"][name] == before["menus"][name] + 1 for name in MENUS), now["menus"]
    assert {"VIEW3D_PT_orbifold", "IMAGE_PT_orbifold"} <= now["types"]


def check_preferences_say_that_the_library_is_there():
    assert part("preferences").library_problem() is None
    assert module_name() in bpy.context.preferences.addons


def check_every_operator_has_a_tooltip():
    for cls in part("operators").CLASSES:
        assert len(cls.bl_description) > 20, cls.bl_idname


def check_disabling_leaves_nothing():
    overlay, live = part("overlay"), part("live")
    bpy.context.window_manager.orbifold_live = True
    assert len(overlay._State.handles) == 3
    bpy.ops.preferences.addon_disable(module=module_name())
    now = state()
    assert now == before, {key: (before[key], now[key]) for key in before if before[key] != now[key]}
    assert not overlay._State.handles and not bpy.app.timers.is_registered(live._tick)


def check_it_can_be_enabled_again():
    enable()
    assert hasattr(bpy.ops.uv, "orbifold_unwrap") and bpy.ops.uv.orbifold_unwrap.get_rna_type()
    bpy.ops.preferences.addon_disable(module=module_name())


def check_without_the_library_it_registers_and_says_so():
    folder = Path(sys.modules[module_name()].__file__).parent
    copy = Path(os.environ["BLENDER_USER_SCRIPTS"]) / "addons" / "orbifold_uv_bare"
    shutil.copytree(folder, copy, ignore=shutil.ignore_patterns("liborbifold.so"))
    try:
        bpy.ops.preferences.addon_enable(module="orbifold_uv_bare")
        bare = sys.modules["orbifold_uv_bare"]
        assert "liborbifold.so" in bare.preferences.library_problem()
        state_of = bare.panels.sidebar.signature_state("442", 3)
        assert not state_of.good and "liborbifold.so" in state_of.text
        bpy.ops.preferences.addon_disable(module="orbifold_uv_bare")
    finally:
        shutil.rmtree(copy)


run_checks(globals())
