# SPDX-License-Identifier: GPL-3.0-or-later
"""What stands in the way of unwrapping a mesh, kept on it as a list for the sidebar, and Blender's own mend for each
kind. Elements are not kept: they are found anew whenever they are selected or mended, so that they cannot be stale."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import bmesh
import bpy
import numpy as np
from bpy.props import BoolProperty, CollectionProperty, IntProperty, IntVectorProperty, StringProperty

from . import blender_mesh, core, surface


class OrbifoldDefect(bpy.types.PropertyGroup):
    """A row of the list."""

    kind: StringProperty()  # of core.defects.KINDS
    text: StringProperty()
    count: IntProperty()
    blocks: BoolProperty()


class OrbifoldCheck(bpy.types.PropertyGroup):
    rows: CollectionProperty(type=OrbifoldDefect)
    done: BoolProperty()  # the mesh was looked at
    made_for: IntVectorProperty(size=3)  # numbers of vertices, edges, faces


CLASSES = (OrbifoldDefect, OrbifoldCheck)


def defects_of(mesh: bpy.types.Mesh) -> list[core.Defect]:
    """Not in edit mode."""
    arrays = blender_mesh.read_mesh(mesh)
    corners, sizes = blender_mesh.read_faces(mesh)
    return core.find_defects(arrays.vertices, corners, sizes, arrays.triangles, arrays.polygons)


def keep(mesh: bpy.types.Mesh, found: Sequence[core.Defect]) -> None:
    """Replace the list."""
    table = mesh.orbifold.check
    table.rows.clear()
    for defect in found:
        row = table.rows.add()
        row.kind, row.text, row.count, row.blocks = defect.kind, defect.text, defect.count, defect.blocks
    table.done, table.made_for = True, surface.counts(mesh)


def is_stale(mesh: bpy.types.Mesh) -> bool:
    return tuple(mesh.orbifold.check.made_for) != surface.counts(mesh)


def select(context: bpy.types.Context, mesh: bpy.types.Mesh, found: Sequence[core.Defect]) -> None:
    """Select the elements of these defects, and nothing else, in the select modes that show them. Not in edit mode."""
    vertices, edges, faces = (np.zeros(0, np.int64) for _ in range(3))
    for defect in found:
        if defect.element == "vertex":
            vertices = np.concatenate([vertices, defect.elements])
        elif defect.element == "edge":
            there = blender_mesh.edge_indices(mesh, defect.elements)
            edges = np.concatenate([edges, there[there >= 0]])
        else:
            faces = np.concatenate([faces, defect.elements])
    modes = tuple(bool(len(chosen)) for chosen in (vertices, edges, faces))
    if any(modes):
        context.tool_settings.mesh_select_mode = modes
    blender_mesh.select_elements(mesh, vertices, edges, faces)


# ------------------------------------------------------------------------------------------------------- mends


@dataclass(frozen=True)
class Mend:
    label: str  # of Blender's own tool
    description: str
    apply: Callable[[bpy.types.Object, core.Defect, float], None]  # not in edit mode
    uses_distance: bool = False


def _in_bmesh(work: Callable[[bmesh.types.BMesh, core.Defect, float], None]) -> Callable:
    def apply(obj: bpy.types.Object, defect: core.Defect, distance: float) -> None:
        bm = bmesh.new()
        try:
            bm.from_mesh(obj.data)
            for elements in (bm.verts, bm.edges, bm.faces):
                elements.ensure_lookup_table()
            work(bm, defect, distance)
            bm.to_mesh(obj.data)
        finally:
            bm.free()
        obj.data.update()

    return apply


def _edges(bm: bmesh.types.BMesh, defect: core.Defect) -> list[bmesh.types.BMEdge]:
    found = (bm.edges.get((bm.verts[a], bm.verts[b])) for a, b in defect.elements.tolist())
    return [edge for edge in found if edge is not None]


def _faces(bm: bmesh.types.BMesh, defect: core.Defect) -> list[bmesh.types.BMFace]:
    return [bm.faces[face] for face in defect.elements.tolist()]


def _delete_vertices(bm: bmesh.types.BMesh, defect: core.Defect, _distance: float) -> None:
    bmesh.ops.delete(bm, geom=[bm.verts[vertex] for vertex in defect.elements.tolist()], context="VERTS")


def _delete_faces(bm: bmesh.types.BMesh, defect: core.Defect, _distance: float) -> None:
    for face in _faces(bm, defect):
        bm.faces.remove(face)  # edges and vertices are those of the face that stays


def _dissolve_degenerate(bm: bmesh.types.BMesh, _defect: core.Defect, distance: float) -> None:
    bmesh.ops.dissolve_degenerate(bm, edges=bm.edges[:], dist=distance)


def _split_edges(bm: bmesh.types.BMesh, defect: core.Defect, _distance: float) -> None:
    bmesh.ops.split_edges(bm, edges=_edges(bm, defect))


def _split_vertices(bm: bmesh.types.BMesh, defect: core.Defect, _distance: float) -> None:
    for vertex in [bm.verts[vertex] for vertex in defect.elements.tolist()]:
        bmesh.utils.vert_separate(vertex, [])  # into its fans


def _recalculate_normals(bm: bmesh.types.BMesh, defect: core.Defect, _distance: float) -> None:
    """Of the components that have flipped faces; the others keep theirs."""
    todo, seen = _faces(bm, defect), set()
    while todo:
        face = todo.pop()
        if face not in seen:
            seen.add(face)
            todo += [other for edge in face.edges for other in edge.link_faces if other not in seen]
    bmesh.ops.recalc_face_normals(bm, faces=list(seen))


def _merge(bm: bmesh.types.BMesh, defect: core.Defect, distance: float) -> None:
    bmesh.ops.remove_doubles(bm, verts=[bm.verts[vertex] for vertex in defect.elements.tolist()], dist=distance)


def _fill_holes(bm: bmesh.types.BMesh, defect: core.Defect, _distance: float) -> None:
    bmesh.ops.holes_fill(bm, edges=_edges(bm, defect), sides=0)


def _delete_loose(bm: bmesh.types.BMesh, defect: core.Defect, _distance: float) -> None:
    _delete_vertices(bm, defect, 0.0)
    wires = [edge for edge in bm.edges if not edge.link_faces]
    bmesh.ops.delete(bm, geom=wires, context="EDGES")


def _validate(obj: bpy.types.Object, _defect: core.Defect, _distance: float) -> None:
    obj.data.validate()
    obj.data.update()


def _separate(obj: bpy.types.Object, _defect: core.Defect, _distance: float) -> None:
    with bpy.context.temp_override(
        active_object=obj, object=obj, selected_objects=[obj], selected_editable_objects=[obj]
    ):
        bpy.ops.mesh.separate(type="LOOSE")


MENDS = {
    "not_finite": Mend(
        "Delete Vertices", "Delete these vertices, with the faces around them", _in_bmesh(_delete_vertices)
    ),
    "repeated_corner": Mend("Validate", "Remove what no mesh should have", _validate),
    "repeated_face": Mend(
        "Delete Faces", "Delete all but the first face on the same vertices", _in_bmesh(_delete_faces)
    ),
    "zero_area": Mend(
        "Degenerate Dissolve", "Dissolve faces without area and edges without length",
        _in_bmesh(_dissolve_degenerate), True,
    ),
    "edge": Mend("Split Edges", "Take the faces at these edges apart. This makes borders", _in_bmesh(_split_edges)),
    "vertex": Mend("Split Vertices", "Give each fan of faces a vertex of its own", _in_bmesh(_split_vertices)),
    "flipped": Mend(
        "Recalculate Normals", "Turn the faces of these components so that all look outside",
        _in_bmesh(_recalculate_normals),
    ),
    "double": Mend("Merge by Distance", "Join border vertices at one place", _in_bmesh(_merge), True),
    "boundary": Mend("Fill Holes", "Close every border with a face", _in_bmesh(_fill_holes)),
    "pieces": Mend("Separate by Loose Parts", "Make an object of each component", _separate),
    "isolated": Mend("Delete Loose", "Delete vertices and edges without a face", _in_bmesh(_delete_loose)),
}


def mend(obj: bpy.types.Object, kind: str, distance: float) -> int:
    """Apply the mend of a kind to all elements of that kind, found anew; how many there were. Not in edit mode."""
    found = next((defect for defect in defects_of(obj.data) if defect.kind == kind), None)
    if found is None:
        return 0
    MENDS[kind].apply(obj, found, distance)
    return found.count
