# SPDX-License-Identifier: GPL-3.0-or-later
"""In a real window: a transfer to another mesh, undone, and Esc while an image is baked. Arguments: the beginning of the
screenshots' names or -, JSON."""

import os
import sys

import bpy
import numpy as np

sys.path.insert(0, os.path.dirname(__file__))
from harness import blob, enable, far_vertices, part, set_cones  # noqa: E402
from windowed import drive, in_view, photographed, press, reports, show_info, show_tab  # noqa: E402

picture, out = sys.argv[-2:]
seen = {}


def target() -> bpy.types.Object:
    return bpy.data.objects["Copy"]


def steps():
    yield from show_info()
    pair()
    yield from transferred()
    yield from escaped()


def pair() -> None:
    """A source, active, with a vertex group and a large image, and a copy of it that has neither."""
    source = blob(4)
    part("blender_mesh").write_uv_of_loops(
        source.data, np.random.default_rng(1).random((len(source.data.loops), 2)), np.ones(len(source.data.loops), bool),
        "Own",
    )
    copy = bpy.data.objects.new("Copy", source.data.copy())
    bpy.context.scene.collection.objects.link(copy)
    copy.location.x = 3
    source.vertex_groups.new(name="Up").add(list(range(40)), 1.0, "REPLACE")
    material = bpy.data.materials.new("Painted")
    part("blender_mesh").enable_nodes(material)
    material.node_tree.nodes.new("ShaderNodeTexImage").image = bpy.data.images.new("Large", 2048, 2048)
    source.data.materials.append(material)
    for obj in (source, copy):
        set_cones(obj, "22222", far_vertices(obj, 5))
        obj.select_set(True)
    bpy.context.view_layer.objects.active = source


def transferred():
    bpy.ops.ed.undo_push(message="to transfer")
    yield
    with in_view():
        seen["invoked"] = list(bpy.ops.object.orbifold_transfer("INVOKE_DEFAULT", True))
    yield lambda: len(target().vertex_groups)
    if picture != "-":
        yield from show_tab("VIEW_3D", "VIEW3D_PT_orbifold")
        yield from photographed(picture, "transferred")
    with in_view():
        bpy.ops.ed.undo()
    yield
    seen["groups_after_one_undo"] = len(target().vertex_groups)


def escaped():
    """While an image is baked, of which one portion is done."""
    baking, portions = part("baking"), []
    real = baking.sampled

    def sampled(*arguments):
        portions.append(bpy.data.images["Large"].size[0])
        return real(*arguments)

    baking.sampled = sampled
    with in_view():
        seen["invoked_texture"] = list(
            bpy.ops.object.orbifold_transfer("INVOKE_DEFAULT", True, texture=True, uv_maps=False)
        )
    yield lambda: portions
    press("ESC")
    yield lambda: "cancelled" in reports()
    done = len(portions)
    for _ in range(5):
        yield
    baking.sampled = real
    seen["portions_after_esc"] = len(portions) - done
    seen["portions_before_esc"] = done
    seen["groups_after_esc"] = len(target().vertex_groups)
    seen["images_after_esc"] = sorted(image.name for image in bpy.data.images if image.name.startswith("Large"))


enable()
bpy.context.preferences.view.show_splash = False
drive(steps(), seen, out)
