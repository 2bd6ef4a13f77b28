# SPDX-License-Identifier: GPL-3.0-or-later
"""In Blender: what is in a .blend and a .png that `run` wrote. Arguments: ANSWER.json FILE.blend FILE.png"""

import json
import sys

import bpy
import numpy as np

answer, blend, png = sys.argv[sys.argv.index("--") + 1 :]
bpy.ops.wm.open_mainfile(filepath=blend)
meshes = [obj for obj in bpy.data.objects if obj.type == "MESH"]
obj = meshes[0]
mesh = obj.data
mesh.calc_loop_triangles()
uv = np.array([loop.uv for loop in mesh.uv_layers["Orbifold"].data])
corners = uv[np.array([triangle.loops for triangle in mesh.loop_triangles])]
one, two = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
area = one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0]
nodes = [node for material in mesh.materials for node in material.node_tree.nodes]
image = bpy.data.images.load(png)
pixels = np.empty(len(image.pixels), np.float32)
image.pixels.foreach_get(pixels)
pixels = pixels.reshape(image.size[1], image.size[0], -1)[..., :3]
half = image.size[0] // 2
seen = {
    "objects": len(bpy.data.objects),
    "vertices": len(mesh.vertices),
    "uv_maps": [layer.name for layer in mesh.uv_layers],
    "active_uv": mesh.uv_layers.active.name,
    "uv_triangles_without_area": int((area == 0).sum()),
    "seams": sum(edge.use_seam for edge in mesh.edges),
    "shape_keys": [key.name for key in mesh.shape_keys.key_blocks] if mesh.shape_keys else [],
    "materials": len(mesh.materials),
    "material_reads_uv": any(getattr(node, "uv_map", "") == "Orbifold" for node in nodes),
    "images_without_data": [other.name for other in bpy.data.images if other is not image and not other.has_data
                            and other.type == "IMAGE" and len(other.pixels) == 0],
    "png_size": list(image.size),
    "png_spread": [float(pixels[:, :half].std()), float(pixels[:, half:].std())],
}
with open(answer, "w") as file:
    json.dump(seen, file)
