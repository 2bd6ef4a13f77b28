# SPDX-License-Identifier: GPL-3.0-or-later
"""The sample creature: a skeleton of edges with radii, grown to a closed skin by Blender's Skin modifier and rounded
by its Subdivision Surface modifier. Nothing is random; the surface is sphere-like because the skeleton is a tree."""

from __future__ import annotations

from dataclasses import dataclass

import bmesh
import bpy

SUBDIVISIONS = 3


@dataclass(frozen=True)
class Bone:
    """A chain of joints that grows from a joint of an earlier chain. Joint: (x, y, z, radius); the creature looks
    along -y, z is up, and a mirrored chain is grown once more at -x."""

    name: str
    parent: str  # the name of a chain and the number of its joint, "spine 2"; empty for the first chain
    joints: tuple[tuple[float, float, float, float], ...]
    mirrored: bool = False


SKELETON = (
    Bone("spine", "", ((0, 0.60, 1.00, 0.58), (0, 0.10, 1.04, 0.64), (0, -0.42, 1.14, 0.58))),
    Bone("head", "spine 2", ((0, -0.78, 1.66, 0.42), (0, -1.00, 2.06, 0.58), (0, -1.44, 1.92, 0.42),
                             (0, -1.80, 1.78, 0.24))),
    Bone("ear", "head 1", ((0.44, -0.92, 2.50, 0.20), (0.60, -0.86, 2.80, 0.25), (0.74, -0.80, 3.10, 0.18),
                           (0.82, -0.74, 3.34, 0.06)), True),
    Bone("front leg", "spine 2", ((0.48, -0.52, 0.62, 0.22), (0.50, -0.54, 0.34, 0.18), (0.50, -0.58, 0.06, 0.20),
                                  (0.51, -0.86, 0.04, 0.16)), True),
    Bone("hind leg", "spine 0", ((0.50, 0.74, 0.62, 0.26), (0.54, 0.80, 0.34, 0.19), (0.54, 0.76, 0.06, 0.20),
                                 (0.55, 0.48, 0.04, 0.16)), True),
    Bone("tail", "spine 0", ((0, 1.12, 1.14, 0.24), (0, 1.38, 1.24, 0.18), (0, 1.62, 1.42, 0.16), (0, 1.76, 1.70, 0.16),
                             (0, 1.80, 2.00, 0.18), (0, 1.72, 2.30, 0.22), (0, 1.52, 2.52, 0.24),
                             (0, 1.24, 2.58, 0.20), (0, 1.02, 2.52, 0.08))),
)


def make_creature() -> bpy.types.Object:
    """The creature as a mesh object named "creature" in the current scene, its modifiers applied."""
    skeleton = _grow_skeleton()
    obj = bpy.data.objects.new("skeleton", skeleton)
    bpy.context.scene.collection.objects.link(obj)
    skin = obj.modifiers.new("Skin", "SKIN")
    skin.branch_smoothing = 0.6
    skin.use_smooth_shade = True
    rounding = obj.modifiers.new("Subdivision", "SUBSURF")
    rounding.levels = rounding.render_levels = SUBDIVISIONS
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = bpy.data.meshes.new_from_object(evaluated)
    bpy.data.objects.remove(obj)
    bpy.data.meshes.remove(skeleton)
    mesh.name = "creature"
    _poke(mesh)
    creature = bpy.data.objects.new("creature", mesh)
    bpy.context.scene.collection.objects.link(creature)
    return creature


def _poke(mesh: bpy.types.Mesh) -> None:
    """A vertex at the middle of each quad: twice as many vertices, where another subdivision would make four times."""
    poked = bmesh.new()
    poked.from_mesh(mesh)
    bmesh.ops.poke(poked, faces=poked.faces)
    for face in poked.faces:
        face.smooth = True
    poked.to_mesh(mesh)
    poked.free()


def _grow_skeleton() -> bpy.types.Mesh:
    """Edges of all chains, with their radii in the skin layer."""
    mesh = bpy.data.meshes.new("skeleton")
    grown = bmesh.new()
    radius = grown.verts.layers.skin.verify()
    joints: dict[str, bmesh.types.BMVert] = {}
    for bone in SKELETON:
        for side in (1, -1) if bone.mirrored else (1,):
            previous = joints.get(bone.parent)
            for number, (x, y, z, r) in enumerate(bone.joints):
                joint = grown.verts.new((side * x, y, z))
                joint[radius].radius = (r, r)
                if previous is None:
                    joint[radius].use_root = True
                else:
                    grown.edges.new((previous, joint))
                joints.setdefault(f"{bone.name} {number}", joint)
                previous = joint
    grown.to_mesh(mesh)
    grown.free()
    return mesh
