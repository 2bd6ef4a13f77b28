# SPDX-License-Identifier: GPL-3.0-or-later
"""In Blender: what is in a .blend and a .png that `run` wrote. Arguments: ANSWER.json FILE.blend
FILE.png or -"""

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


def colours_at(where):
    """The texture's colours at (k, 2) texture coordinates, bilinear."""
    texture = next(node.image for node in nodes if node.type == "TEX_IMAGE")
    width, height = texture.size
    texels = np.empty(width * height * 4, np.float32)
    texture.pixels.foreach_get(texels)
    texels = texels.reshape(height, width, 4)[..., :3]
    x, y = where[:, 0] * width - 0.5, where[:, 1] * height - 0.5
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    a, b = (x - i)[:, None], (y - j)[:, None]
    corner = lambda di, dj: texels[(j + dj) % height, (i + di) % width]  # noqa: E731
    return (1 - b) * ((1 - a) * corner(0, 0) + a * corner(1, 0)) + b * ((1 - a) * corner(0, 1) + a * corner(1, 1))


def seam_colours():
    """Colours at the middle of each seam edge, from its two faces: (seams, 2, 3)."""
    sides = {edge.index: [] for edge in mesh.edges if edge.use_seam}
    for polygon in mesh.polygons:
        loops = list(polygon.loop_indices)
        for here, there in zip(loops, loops[1:] + loops[:1]):
            if mesh.loops[here].edge_index in sides:
                sides[mesh.loops[here].edge_index].append((uv[here] + uv[there]) / 2)
    return colours_at(np.array(list(sides.values())).reshape(-1, 2)).reshape(-1, 2, 3)


at_seams = seam_colours()
seams = sum(edge.use_seam for edge in mesh.edges)
seen = {
    "objects": len(bpy.data.objects),
    "vertices": len(mesh.vertices),
    "uv_maps": [layer.name for layer in mesh.uv_layers],
    "active_uv": mesh.uv_layers.active.name,
    "uv_triangles_without_area": int((area == 0).sum()),
    "seams": seams,
    "shape_keys": [key.name for key in mesh.shape_keys.key_blocks] if mesh.shape_keys else [],
    "shape_key_values": [key.value for key in mesh.shape_keys.key_blocks[1:]] if mesh.shape_keys else [],
    "materials": len(mesh.materials),
    "material_reads_uv": any(getattr(node, "uv_map", "") == "Orbifold" for node in nodes),
    "images_without_data": [other.name for other in bpy.data.images if not other.has_data
                            and other.type == "IMAGE" and len(other.pixels) == 0],
    "seam_colour_gap": float(np.abs(at_seams[:, 0] - at_seams[:, 1]).max(axis=1).mean()) if seams else 0.0,
    "seam_colour_spread": float(at_seams.std(axis=0).mean()) if seams else 1.0,
}
if png != "-":
    image = bpy.data.images.load(png)
    pixels = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(image.size[1], image.size[0], -1)[..., :3]
    half = image.size[0] // 2
    seen["png_size"] = list(image.size)
    seen["png_spread"] = [float(pixels[:, :half].std()), float(pixels[:, half:].std())]
with open(answer, "w") as file:
    json.dump(seen, file)
