# SPDX-License-Identifier: GPL-3.0-or-later
"""In Blender: the corners of a mesh file's faces with their texture coordinates. Arguments: ANSWER.npz ADDON_FOLDER
FILE..."""

import importlib.util
import sys
from pathlib import Path

import numpy as np

answer, addon, *files = map(Path, sys.argv[sys.argv.index("--") + 1 :])
spec = importlib.util.spec_from_file_location("run", addon / "run.py")
run = importlib.util.module_from_spec(spec)
spec.loader.exec_module(run)
run.load_package()

from orbifold_uv import blender_mesh, core  # noqa: E402
from orbifold_uv.headless.importers import empty_file, load_object  # noqa: E402

found = {}
for file in files:
    empty_file()
    obj = load_object(file, None, core.read_mesh)
    place = np.array(obj.matrix_world)
    vertices = blender_mesh.read_vertices(obj.data) @ place[:3, :3].T + place[:3, 3]
    uv = blender_mesh.read_uv(obj.data, obj.data.uv_layers.active.name)
    found[file.name] = np.column_stack([vertices[blender_mesh.read_loop_vertices(obj.data)], uv])
np.savez(answer, **found)
