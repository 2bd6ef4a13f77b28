# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on as it came from an extension repository that the user subscribed to: there, enabled, at work.
Argument: JSON, what was seen."""

import importlib
import json
import os
import sys

import bpy

sys.path.insert(0, os.path.dirname(__file__))
import harness  # noqa: E402

# The user's preferences say that it is enabled; nothing is asked for here.
names = [name for name in bpy.context.preferences.addons.keys() if name.endswith(".orbifold_uv")]
harness.module_name = lambda: names[0]
seen = {"enabled": names, "loaded": names[0] in sys.modules}
obj = harness.blob()
harness.set_cones(obj, "442")
seen["unwrapped"] = list(harness.user(bpy.ops.uv.orbifold_unwrap))
seen["uv_maps"] = [layer.name for layer in obj.data.uv_layers]
seen["library_problem"] = importlib.import_module(f"{names[0]}.preferences").library_problem()
with open(sys.argv[-1], "w", encoding="utf-8") as file:
    json.dump(seen, file)
