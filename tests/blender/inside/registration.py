# SPDX-License-Identifier: GPL-3.0-or-later
"""Enabling and disabling; the package as it was installed."""

import os
import shutil
import sys
from pathlib import Path

import bpy

sys.path.insert(0, os.path.dirname(__file__))
from harness import blob, enable, module_name, part, raises, run_checks  # noqa: E402

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
    assert "orbifold_symmetric_painting" in now["window manager"]
    assert all(now["menus"][name] == before["menus"][name] + 1 for name in MENUS), now["menus"]
    assert {"VIEW3D_PT_orbifold", "IMAGE_PT_orbifold"} <= now["types"]


def check_preferences_say_that_the_library_is_there():
    assert part("preferences").library_problem() is None
    assert module_name() in bpy.context.preferences.addons


def check_every_operator_has_a_tooltip():
    for cls in part("operators").CLASSES:
        assert len(cls.bl_description) > 20, cls.bl_idname


class Layout:
    """Notes what is drawn: operators, properties."""

    def __init__(self):
        self.names = set()

    def __getattr__(self, _name):
        return lambda *words, **settings: self

    def operator(self, name, **settings):
        self.names.add(name)
        return type("Settings", (), {})()

    def operator_menu_enum(self, name, _property):
        self.names.add(name)

    def prop(self, _data, name, **settings):
        self.names.add(name)

    def prop_search(self, data, name, *_of, **settings):
        self.prop(data, name)


def function_of(name):
    group, _, operator = name.partition(".")
    return getattr(getattr(bpy.ops, group), operator)


def check_every_operator_is_in_a_menu():
    """F3 finds what is in menus (searching_window.py)."""
    obj = blob()
    bpy.ops.mesh.orbifold_suggest_cones()
    bpy.ops.mesh.orbifold_place_suggestion(index=0)
    menus, layout = part("panels.menus"), Layout()
    for menu in (menus.VIEW3D_MT_orbifold, menus.MESH_MT_orbifold_signatures):
        menu.draw(type("Menu", (), {"layout": layout})(), bpy.context)
    wanted = {cls.bl_idname for cls in part("operators").CLASSES}
    assert layout.names == wanted, layout.names ^ wanted
    bpy.context.view_layer.objects.active = None
    menus.VIEW3D_MT_orbifold.draw(type("Menu", (), {"layout": Layout()})(), bpy.context)
    bpy.context.view_layer.objects.active = obj


MISSING = {
    "mesh.orbifold_add_cones": "Go to edit mode first",
    "mesh.orbifold_remove_cone": "The mesh has no cones",
    "mesh.orbifold_move_cone": "The mesh has no cones",
    "mesh.orbifold_clear_cones": "The mesh has no cones",
    "mesh.orbifold_jump_to_cone": "Go to edit mode first",
    "mesh.orbifold_slide_cone": "Go to edit mode first",
    "mesh.orbifold_place_suggestion": "use Suggest Cones first",
    "mesh.orbifold_show_stretch": "The mesh has no cones",
    "mesh.orbifold_show_distortion": "use Orbifold Unwrap first",
    "mesh.orbifold_hide_distortion": "shows no heat map",
    "mesh.orbifold_cancel_live": "computes nothing",
    "mesh.orbifold_show_defect": "use Check Mesh first",
    "mesh.orbifold_mend": "use Check Mesh first",
    "uv.orbifold_fixed_boundary": "no border",
    "object.orbifold_sphere": "Pick at least two cones first",
    "object.orbifold_tile_preview": "use Orbifold Unwrap first",
    "object.orbifold_pattern": "use Orbifold Unwrap first",
    "image.orbifold_symmetrize": "use Orbifold Unwrap first",
    "image.orbifold_new": "use Orbifold Unwrap first",
    "object.orbifold_pattern_image": "use Orbifold Unwrap first",
    "image.orbifold_wallpaper": "use Orbifold Unwrap first",
    "image.orbifold_fill_seam_margin": "Give the active material an image texture",
    "object.orbifold_bake": "Give the active material an image texture",
    "object.orbifold_transfer": "Select the meshes that are to get something too",
    "object.orbifold_suggest_order": "Select the meshes that are to get something too",
}
ALWAYS = {"uv.orbifold_unwrap", "mesh.orbifold_suggest_cones", "mesh.orbifold_set_signature", "mesh.orbifold_check"}


def check_operators_that_cannot_run_say_what_is_missing():
    obj = blob()
    assert MISSING.keys() | ALWAYS == {cls.bl_idname for cls in part("operators").CLASSES}
    for name, message in MISSING.items():
        assert message in raises(function_of(name)), (name, raises(function_of(name)))
    assert all(function_of(name).poll() for name in ALWAYS)
    bpy.ops.object.mode_set(mode="SCULPT")
    for name in MISSING.keys() | ALWAYS:
        assert raises(function_of(name)).rstrip().endswith("mode first"), name
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.objects.active = None
    for name in MISSING.keys() | ALWAYS:
        assert "Make a mesh object active first" in raises(function_of(name)), name
    bpy.context.view_layer.objects.active = obj


def check_redo_panels_show_all_settings():
    """Each setting in one of the situations where it matters; where an operator does not draw them, Blender does."""
    situations = [
        {"signature": signature, "geometry": part("core").geometry_of(signature), "kind": kind, "holes": "fill",
         "weights": "cotan", "_searched": True, "_extra_borders": 1,
         "uv_maps": True}
        for signature, kind in (("442", "double"), ("432", "flipped"), ("237", "zero_area"))
    ]
    for cls in part("operators").CLASSES:
        properties = function_of(cls.bl_idname).get_rna_type().properties
        settings = {p.identifier for p in properties if not p.is_hidden} - {"rna_type"}
        if cls.bl_idname == "uv.orbifold_fixed_boundary":
            settings.remove("signature")  # a polygon has none
        assert not settings or {"REGISTER", "UNDO"} <= cls.bl_options, cls.bl_idname
        if "draw" not in vars(cls):
            continue
        layout = Layout()
        for situation in situations:
            stub = type("Stub", (), {name: getattr(cls, name, None) for name in ("draw_weights", "draw_writing")})()
            vars(stub).update(situation, layout=layout)
            cls.draw(stub, bpy.context)
        assert settings == layout.names, (cls.bl_idname, settings ^ layout.names)


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
