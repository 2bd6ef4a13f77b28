# SPDX-License-Identifier: GPL-3.0-or-later
"""In Blender: how long Orbifold Live takes from an action to the UVs, each action also in CPU seconds of the process.

    blender --background --factory-startup --python tests/bench/live.py -- MESH.obj [ROUNDS]
"""

import importlib.util
import statistics
import sys
import time
from pathlib import Path

import bpy

words = sys.argv[sys.argv.index("--") + 1 :]
spec = importlib.util.spec_from_file_location("run", Path(__file__).parents[2] / "addon" / "run.py")
run = importlib.util.module_from_spec(spec)
spec.loader.exec_module(run)
run.load_package()

import orbifold_uv  # noqa: E402
from orbifold_uv import core, live, properties  # noqa: E402
from orbifold_uv.headless.importers import load_object  # noqa: E402
from orbifold_uv.operators import sliding  # noqa: E402


def prepared(path):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    orbifold_uv.register()
    obj = load_object(path, None, core.read_mesh)
    points = [v.co for v in obj.data.vertices]
    chosen = [0]
    while len(chosen) < 3:
        chosen.append(max(range(len(points)), key=lambda v: min((points[v] - points[c]).length for c in chosen)))
    properties.set_cones(obj.data, chosen, [4, 4, 2])
    bpy.ops.uv.orbifold_unwrap()
    bpy.context.window_manager.orbifold_live = True
    return obj


def measured(action):
    """Wall and CPU seconds."""
    bpy.context.view_layer.update()
    live.stop()  # whatever the last action has left to wait for
    wall, cpu = time.perf_counter(), time.process_time()
    action()
    assert live._State.computing is None and not live._State.problems, live._State.problems
    return time.perf_counter() - wall, time.process_time() - cpu


def slide(mesh):
    bpy.ops.mesh.orbifold_slide_cone(vertex=sliding.neighbours(mesh, mesh.orbifold.cones[0].vertex)[0])


def actions_of(mesh):
    """Name -> function of the round."""
    texts = ("333", "442")
    actions = {"signature": lambda k: setattr(mesh.orbifold, "signature", texts[k % 2])}
    if mesh.is_editmode:
        actions["cone to a neighbour"] = lambda _k: slide(mesh)
    return actions


live.PATIENCE, live.LARGE = 600.0, 10**9
mesh_object = prepared(Path(words[0]).resolve())
rounds = int(words[1]) if len(words) > 1 else 6
print(f"{len(mesh_object.data.vertices)} vertices")
for mode in ("OBJECT", "EDIT"):
    bpy.ops.object.mode_set(mode=mode)
    for name, action in actions_of(mesh_object.data).items():
        times = [measured(lambda k=k: action(k)) for k in range(rounds + 1)][1:]  # the first one reads the mesh
        wall, cpu = zip(*times)
        print(f"{mode.lower()} mode, {name}: least {min(wall):.3f} s, median {statistics.median(wall):.3f} s; "
              f"CPU {min(cpu):.3f} s, median {statistics.median(cpu):.3f} s")
orbifold_uv.unregister()
