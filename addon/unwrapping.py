# SPDX-License-Identifier: GPL-3.0-or-later
"""The mesh of one object -> the UV map `Orbifold`: its components that have cones, the jobs for each in turn, and at
the end everything is written at once, so that whatever fails leaves the mesh as it was. No operator, no context:
operators/unwrap.py polls the jobs, api.py waits for them.

A component is embedded with the coordinates of all vertices and its own triangles, so that vertices keep their numbers;
those of other components are isolated vertices to the library, which it tolerates.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Optional

import bpy
import numpy as np

from . import (
    arrangement, blender_mesh, cones, core, cut_paths, faces, layouts, live, materials, properties, sphere_map,
    suggestions,
)

EXPECTED = (core.OrbifoldError, blender_mesh.BlenderMeshError)  # what is for the person to mend
NAMED = 6  # components that a report names at most


@dataclass(frozen=True)
class Settings:
    signature: Optional[str] = None  # None or empty: the mesh's
    weights: str = "conformal"
    clamp: float = 0.01
    holes: str = "refuse"
    flat: bool = True  # of suggestions for any signature only those of the plane
    charts: Mapping[str, str] = field(default_factory=dict)  # by geometry; what is not there is core's default
    mark_seams: bool = True
    sphere_key: bool = True
    pattern: bool = False
    sphere_only: bool = False  # the shape key and nothing else; an error where there cannot be one


@dataclass(frozen=True)
class Missing:
    """What to suggest before a component can be embedded."""

    signature: Optional[str]  # None: any that is usual for the mesh
    fixed: list[int]  # vertices


def missing_cones(
    picked: Sequence[cones.Cone], typed: str, surface: core.Topology, holes: str, all_mirrors: bool = False
) -> Optional[Missing]:
    """None: the cones are complete, or they do not fit what is typed, which is for the person to mend. A single cone is
    a beginning: it is kept."""
    vertices = [cone.vertex for cone in picked]
    if len(picked) > 1:
        return None
    own = arrangement.arrange(vertices, surface, all_mirrors or not picked).text([cone.order for cone in picked])
    if typed and not (picked and typed == own):  # "2" is what a single cone writes by itself
        read = properties.read_signature(typed)
        return Missing(typed, vertices) if read is not None and len(read.orders) > len(picked) else None
    read = properties.read_signature(own)
    whole = read is not None and len(read.orders) == len(picked)
    return None if whole and not (holes == "fill" and surface.loops) else Missing(None, vertices)


# --------------------------------------------------------------------------------------------------- components


@dataclass
class Piece:
    """A component that is treated, and what has become of it so far."""

    arrays: blender_mesh.MeshArrays  # all vertices, its own triangles
    triangles: Optional[np.ndarray]  # where these are among all; None: they are all
    surface: core.Topology
    picked: list[cones.Cone]
    signature: str = ""
    missing: Optional[Missing] = None
    suggested: list[core.Suggestion] = field(default_factory=list)
    tried: list[core.Suggestion] = field(default_factory=list)
    failed: list[core.OrbifoldError] = field(default_factory=list)
    result: Optional[core.Result] = None
    layout: Optional[faces.FaceLayout] = None
    key: Optional[np.ndarray] = None
    remarks: list[str] = field(default_factory=list)

    @property
    def best(self) -> Optional[core.Suggestion]:
        """The suggestion that was embedded."""
        return self.tried[len(self.failed)] if self.suggested else None

    @property
    def used(self) -> np.ndarray:
        """(k,) its vertices."""
        return np.unique(self.arrays.triangles)


@dataclass(frozen=True)
class Untreated:
    """A component without cones beside others that have some."""

    vertex: int  # its first one
    faces: int


def _split(
    arrays: blender_mesh.MeshArrays, picked: Sequence[cones.Cone]
) -> tuple[list[Piece], list[Untreated]]:
    """The components to treat and the others: the only one, or each that has cones."""
    triangles = arrays.triangles
    surface = core.topology_of(triangles)
    if surface.components < 2:
        return [Piece(arrays, None, surface, list(picked))], []
    label = core.vertex_components(len(arrays.vertices), triangles)
    of_triangle, of_pick = label[triangles[:, 0]], label[[cone.vertex for cone in picked]] if picked else []
    names, first = np.unique(of_triangle, return_index=True)
    if not set(np.asarray(of_pick).tolist()) & set(names.tolist()):
        raise core.OrbifoldError(
            "ORB_SEVERAL_COMPONENTS",
            f"the mesh is in {len(names)} components and none of them has cones: pick cones on each that is to be "
            "unwrapped, or separate them (Check Mesh)",
            triangles[first, 0].tolist()[:16], "vertex", len(names),
        )
    pieces, others = [], []
    for name in names[np.argsort(first)].tolist():
        own = [cone for cone, place in zip(picked, of_pick) if place == name]
        chosen = np.flatnonzero(of_triangle == name)
        if not own:
            count = len(np.unique(arrays.polygons[chosen]))
            others.append(Untreated(int(triangles[chosen].min()), count))
            continue
        part = replace(
            arrays, triangles=triangles[chosen], loops=arrays.loops[chosen], polygons=arrays.polygons[chosen]
        )
        pieces.append(Piece(part, chosen, core.topology_of(part.triangles), own))
    stray = [cone.vertex for cone, place in zip(picked, of_pick) if place not in names]
    if stray:
        raise core.OrbifoldError(
            "ORB_BAD_CONE", f"no face uses vertex {stray[0]}: take it off the list of cones", stray, "vertex"
        )
    return pieces, others


# ------------------------------------------------------------------------------------------------- one object


class Unwrapping:
    """Reads the mesh when it is made; raises one of EXPECTED. `start` and `proceed` give jobs until all is computed,
    then `write` writes it; until then nothing has changed."""

    def __init__(
        self, obj: bpy.types.Object, settings: Settings, picked: Optional[Sequence[cones.Cone]] = None
    ) -> None:
        """`picked`: cones in place of the mesh's own, which `write` replaces."""
        mesh = obj.data
        if mesh.library is not None:
            raise blender_mesh.BlenderMeshError("The mesh is linked from another file: make it local first")
        self.obj, self.settings, self._given, self._at = obj, settings, picked, 0
        with blender_mesh.object_mode(obj):
            self.arrays = blender_mesh.read_mesh(mesh)
            if not settings.sphere_only:
                blender_mesh.check_uv_space(mesh)
        self.picked = cones.read_cones(mesh) if picked is None else list(picked)
        outside = [cone.vertex for cone in self.picked if not 0 <= cone.vertex < len(self.arrays.vertices)]
        if outside:
            raise core.OrbifoldError("ORB_BAD_CONE", f"there is no vertex {outside[0]} in the mesh", outside, "vertex")
        self.pieces, self.untreated = _split(self.arrays, self.picked)
        self._give_signatures()
        self._keep_away = None
        if any(piece.missing is not None for piece in self.pieces):
            with blender_mesh.object_mode(obj):
                self._keep_away = suggestions.keep_away(obj)

    def _give_signatures(self) -> None:
        own = self.obj.data.orbifold.signature if self._given is None else ""
        asked = self.settings.signature or own
        if len(self.pieces) > 1:
            if asked != own:
                raise core.OrbifoldError(
                    "ORB_BAD_ARGUMENT",
                    f"cones lie on {len(self.pieces)} components, and each has the signature of its own cones: set "
                    "their orders instead of one signature",
                )
            asked = ""
        typed = properties.read_signature(asked)
        for piece in self.pieces:
            mirrors = self.settings.holes == "mirror" or (
                typed is not None and typed.n_mirrors == len(piece.surface.loops)
            )
            piece.missing = missing_cones(piece.picked, asked, piece.surface, self.settings.holes, mirrors)
            piece.signature = asked
            if not asked and (len(self.pieces) > 1 or not piece.picked or self._given is not None):
                places = arrangement.arrange(
                    [cone.vertex for cone in piece.picked], piece.surface, mirrors or not piece.picked
                )
                piece.signature = places.text([cone.order for cone in piece.picked])

    # ---------------------------------------------------------------------------------------------- the jobs

    def start(self) -> core.Job:
        piece = self.pieces[self._at]
        if piece.missing is None:
            vertices, signature = [cone.vertex for cone in piece.picked], piece.signature
            return self._embed(piece, signature, arrangement.in_sequence(vertices, piece.surface, signature))
        missing = piece.missing
        flat = self.settings.flat and not self.settings.sphere_only
        return core.start_suggesting(
            *(piece.arrays.vertices, piece.arrays.triangles, missing.signature, missing.fixed, self._keep_away),
            flat=flat, holes=self.settings.holes,
        )

    def proceed(self, job: core.Job) -> Optional[core.Job]:
        """The job is over: the next one, or None where there is only to write."""
        piece = self.pieces[self._at]
        try:
            following = self._proceed(piece, job)
        except core.OrbifoldError as error:
            raise _for_all_triangles(error, piece) from error
        if following is None:
            self._at += 1
            following = self.start() if self._at < len(self.pieces) else None
        return following

    def _proceed(self, piece: Piece, job: core.Job) -> Optional[core.Job]:
        if isinstance(job, core.SuggestionJob):
            piece.suggested = job.finish()
            found = piece.suggested
            if self.settings.sphere_only:
                found = [one for one in found if core.geometry_of(one.signature) == "spherical"] or found
            piece.tried = core.worth_trying(found, self.settings.weights)
            return self._embed_next(piece)
        try:
            result = job.finish()
        except core.OrbifoldError as error:
            if not piece.suggested or error.status not in core.DEPENDS_ON_CONES:
                raise
            piece.failed.append(error)
            if len(piece.failed) < len(piece.tried):
                return self._embed_next(piece)
            raise piece.failed[0] from error
        self._lay_out(piece, result)
        return None

    def _embed_next(self, piece: Piece) -> core.EmbeddingJob:
        best = piece.tried[len(piece.failed)]
        return self._embed(piece, best.signature, best.cones)

    def _embed(self, piece: Piece, signature: str, vertices: Sequence[int]) -> core.EmbeddingJob:
        return core.start_embedding(
            *(piece.arrays.vertices, piece.arrays.triangles, signature, vertices),
            weights=self.settings.weights, clamp=self.settings.clamp, holes=self.settings.holes,
        )

    def _lay_out(self, piece: Piece, result: core.Result) -> None:
        """What can still fail, before anything is written."""
        piece.result = result
        if self.settings.sphere_only:
            if result.geometry != "spherical":
                raise core.OrbifoldError(
                    "ORB_UNSUPPORTED_SIGNATURE",
                    f"the signature {result.signature} is {result.geometry}, not spherical: choose another, as 432 or "
                    "22",
                )
            piece.key = sphere_map.sphere_of(result, piece.arrays)
            return
        chart = self.settings.charts.get(result.geometry, result.chart)
        piece.layout, piece.key, piece.remarks = laid_out(result, piece.arrays, chart, self.settings.sphere_key)

    # ------------------------------------------------------------------------------------------------ writing

    def write(self) -> None:
        """In one go, in any mode."""
        obj, settings = self.obj, self.settings
        with blender_mesh.object_mode(obj):
            self._write_cones()
            if not settings.sphere_only:
                write_layouts(obj, self.pieces, settings.mark_seams)
                self._remember()
            write_keys(obj, [(piece.key, piece.used) for piece in self.pieces if piece.key is not None])
            for number, piece in enumerate(self.pieces if settings.pattern and not settings.sphere_only else ()):
                ending = f" {number + 1}" if number else ""
                material = materials.make_material(obj, piece.result, piece.layout, name_ending=ending)
                materials.assign(obj, material, None if piece.triangles is None else piece.arrays.polygons)

    def _remember(self) -> None:
        """The cut of all that was treated, and the layout, which only a whole mesh can be shown by."""
        mesh, pieces = self.obj.data, self.pieces
        if pieces[0].triangles is None:
            only = pieces[0]
            settings = self.settings.weights, self.settings.mark_seams
            layouts.keep(mesh, only.arrays, only.result, only.layout, *settings)
        seams = np.concatenate([piece.layout.seams for piece in pieces])
        ends = np.concatenate([piece.result.cones for piece in pieces])
        layouts.keep_cut(mesh, seams, cut_paths.number_paths(seams, ends))
        live.note_written(mesh)

    def _write_cones(self) -> None:
        mesh, pieces = self.obj.data, self.pieces
        only, best = pieces[0], pieces[0].best
        if len(pieces) == 1 and best is not None:
            suggestions.place(mesh, best.signature, _cones_of(best))
            suggestions.keep(mesh, only.suggested, only.missing.fixed)
        elif len(pieces) == 1:
            if self._given is None and only.signature == mesh.orbifold.signature:
                return
            orders = dict(zip(only.result.cones.tolist(), only.result.orders.tolist()))
            cones.write_cones(mesh, [cones.Cone(cone.vertex, orders[cone.vertex]) for cone in only.picked])
            properties.write_signature(mesh, only.signature)
        elif self._given is not None or any(piece.best is not None for piece in pieces):
            chosen = [cone for piece in pieces for cone in (_cones_of(piece.best) if piece.best else piece.picked)]
            properties.set_cones(mesh, [cone.vertex for cone in chosen], [cone.order for cone in chosen])

    # ---------------------------------------------------------------------------------------------- reporting

    def message(self) -> str:
        """What was done, in sentences."""
        said = [self._message_of(piece) for piece in self.pieces]
        if self.untreated:
            first = self.untreated[:NAMED]
            named = ", ".join(f"that of vertex {other.vertex} ({_faces(other.faces)})" for other in first)
            more = f" and {len(self.untreated) - NAMED} more" if len(self.untreated) > NAMED else ""
            said.append(f"Components without cones kept their UVs: {named}{more}.")
        return " ".join(said)

    def _message_of(self, piece: Piece) -> str:
        place = f" on the component of vertex {int(piece.used[0])}" if piece.triangles is not None else ""
        text = described(piece.result, f"Orbifold {piece.result.signature}{place}", piece.remarks)
        if piece.failed:
            names = " and ".join(one.signature for one in piece.tried[: len(piece.failed)])
            text += f" {names} could not be embedded: this is the next suggestion."
        return text + (" The cones were suggested: the sidebar lists others." if piece.suggested else "")

    def report(self) -> dict:
        """NAME.json of the first component that was treated, and with it the object's name, what was written, remarks,
        the reports of all components in `components`, and those that were left alone in `untreated`."""
        reports = []
        for piece in self.pieces:
            found = dict(piece.result.report)
            if piece.best is not None:
                kept = ("predicted", "measured", "symmetric")
                found["suggested"] = {name: getattr(piece.best, name) for name in kept}
            reports.append({**found, "remarks": list(piece.remarks), "first_vertex": int(piece.used[0])})
        return {
            **reports[0],
            "object": self.obj.name,
            "uv_map": None if self.settings.sphere_only else blender_mesh.UV_MAP,
            "shape_key": blender_mesh.SHAPE_KEY if any(piece.key is not None for piece in self.pieces) else None,
            "components": reports,
            "untreated": [{"first_vertex": other.vertex, "faces": other.faces} for other in self.untreated],
            "warnings": warnings(self.obj),
        }


def _cones_of(best: core.Suggestion) -> list[cones.Cone]:
    return [cones.Cone(*pair) for pair in zip(best.cones, best.orders)]


def _faces(count: int) -> str:
    return "1 face" if count == 1 else f"{count} faces"


def _for_all_triangles(error: core.OrbifoldError, piece: Piece) -> core.OrbifoldError:
    """The triangles that it names, as they are counted in the whole mesh."""
    if piece.triangles is None:
        return error
    elements = error.elements
    if error.element == "triangle":
        elements = [int(piece.triangles[number]) for number in elements]
    vertex = int(piece.used[0])
    sentence = f"component of vertex {vertex}: {error}"
    return core.OrbifoldError(error.status, sentence, elements, error.element, error.found)


# ------------------------------------------------------------------------- shared with operators/writing.py


def laid_out(
    result: core.Result, arrays: blender_mesh.MeshArrays, chart: str, sphere_key: bool
) -> tuple[faces.FaceLayout, Optional[np.ndarray], list[str]]:
    """The layout, the positions of the shape key where one is wanted and possible, and remarks."""
    layout = faces.layout_of(result, arrays, chart)
    remarks, key = faces.remarks(result, layout), None
    if result.geometry == "spherical" and sphere_key:
        try:
            key = sphere_map.sphere_of(result, arrays)
        except core.OrbifoldError as error:  # the UVs are certified all the same, and not to be lost
            remarks.append(f"no shape key: {error}".rstrip("."))
    return layout, key, remarks


def write_layouts(obj: bpy.types.Object, pieces: Sequence[Piece], mark_seams: bool) -> None:
    """UV map and seams. Not in edit mode."""
    mesh = obj.data
    for piece in pieces:
        whole = piece.triangles is None
        blender_mesh.write_uv(mesh, piece.arrays, piece.layout.uv, keep_others=not whole)
    if mark_seams:
        whole = any(piece.triangles is None for piece in pieces)
        among = None if whole else np.concatenate([piece.used for piece in pieces])
        blender_mesh.mark_seams(mesh, np.concatenate([piece.layout.seams for piece in pieces]), among)


def write_keys(obj: bpy.types.Object, keys: Sequence[tuple[np.ndarray, np.ndarray]]) -> None:
    """Positions (n, 3), and the vertices (k,) for which they are meant -> the shape key. Not in edit mode."""
    if not keys:
        return
    blocks = obj.data.shape_keys.key_blocks if obj.data.shape_keys is not None else {}
    there = blender_mesh.SHAPE_KEY in blocks
    positions = blender_mesh.read_shape_key(obj) if there else blender_mesh.read_vertices(obj.data)
    positions = positions.astype(np.float64)
    for key, vertices in keys:
        positions[vertices] = key[vertices]
    blender_mesh.write_shape_key(obj, positions)


def described(result: core.Result, name: str, remarks: Sequence[str]) -> str:
    distortion = result.report["distortion"]
    said = "".join(f" {remark[:1].upper()}{remark[1:]}." for remark in remarks)
    return (
        f"{name} ({result.geometry}): a bijection, certified; "
        f"mean angle distortion {distortion['quasi_conformal_mean']:.3f}, "
        f"area spread {distortion['log_area_std']:.2f}.{said}"
    )


def warnings(obj: bpy.types.Object) -> list[str]:
    """What moves the UVs, or the surface that they were made for, after us; sentences with a full stop."""
    said = []
    for user in (other for other in bpy.data.objects if other.data == obj.data):
        for modifier in user.modifiers:
            smooth = getattr(modifier, "uv_smooth", "NONE")
            if modifier.type in ("SUBSURF", "MULTIRES") and smooth != "NONE" and (
                modifier.show_viewport or modifier.show_render
            ):
                choice = modifier.bl_rna.properties["uv_smooth"].enum_items[smooth].name
                owner = "" if user == obj else f" of {user.name}"
                said.append(
                    f'The modifier "{modifier.name}"{owner} moves UVs, so that seams may show: its setting UV Smooth '
                    f'is "{choice}"; None leaves them where they are.'
                )
    keys = obj.data.shape_keys
    if keys is not None and keys.use_relative:
        mixed = [key.name for key in keys.key_blocks[1:] if key.value != 0 and not key.mute]
        if mixed and not obj.show_only_shape_key:
            said.append(f"The shape of {keys.reference_key.name} was unwrapped, not the mix with {', '.join(mixed)}.")
    return said
