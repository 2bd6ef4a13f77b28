# SPDX-License-Identifier: GPL-3.0-or-later
"""In a real window: F3, an operator's name and Enter, for each of ours. They are replaced by others that note that they
were called. The last argument: JSON."""

import os
import sys

import bpy

sys.path.insert(0, os.path.dirname(__file__))
from harness import blob, enable, part  # noqa: E402
from windowed import drive, move_into, press, type_in  # noqa: E402

seen = {"wanted": [], "found": {}}
TEXTS = {  # of entries that are not called by the operator's name
    "mesh.orbifold_set_signature": "Orders of the List",
    "mesh.orbifold_place_suggestion": "Place Suggestion",
}


def steps():
    blob(3)
    bpy.ops.mesh.orbifold_suggest_cones()
    bpy.ops.mesh.orbifold_place_suggestion(index=0)
    called = []
    for cls in part("operators").CLASSES:
        replace(cls, called)
        seen["wanted"].append(cls.bl_idname)
    for cls in part("operators").CLASSES:
        called.clear()
        move_into()
        yield
        press("F3")
        yield
        yield from type_in(TEXTS.get(cls.bl_idname, cls.bl_label))
        press("RET")
        yield lambda: called
        seen["found"][cls.bl_idname] = called[0]


def replace(cls, called):
    def note(self, *_arguments):
        called.append(cls.bl_idname)
        return {"CANCELLED"}

    cls.poll = classmethod(lambda cls, context: True)
    cls.execute = note
    if hasattr(cls, "invoke"):
        cls.invoke = note


enable()
bpy.context.preferences.view.show_splash = False
drive(steps(), seen, sys.argv[-1])
