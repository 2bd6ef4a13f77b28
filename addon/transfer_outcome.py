# SPDX-License-Identifier: GPL-3.0-or-later
"""What one target gets by a transfer: everything is computed here, and written by the calls that are collected. The
arrays are those of correspondence.py."""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import dataclass, field
from functools import partial
from typing import Optional

import bpy
import numpy as np

from . import arrangement, baking, blender_mesh, core, heat, seam_edit, textures
from .correspondence import Correspondence
from .seam_cut import SeamCut, cut_along
from .steps import Step, part_of

FORM = "Form of {}"  # shape keys
MUCH = 2.0  # a map's mean angle distortion, and how many times as long as its own a mapped cut is: more is said


@dataclass(frozen=True)
class Wishes:
    """What is transferred, and how the meshes are embedded."""

    groups: bool = True
    attributes: bool = True
    colours: bool = True
    uv_maps: bool = True
    cut_seams: bool = False  # the targets' faces, where those are torn
    texture: bool = False  # the image of the source's material, to the targets' active UV maps
    form: bool = False  # a shape key of each target: the source's form
    form_back: bool = False  # a shape key of the source for each target: its form
    shape_keys: bool = False
    heat: bool = False
    heat_area: bool = False
    signature: str = ""  # empty: orbifold_for
    weights: str = "conformal"
    clamp: float = 0.01
    holes: Optional[str] = None  # None: the choice that is kept with each mesh

    @property
    def any(self) -> bool:
        ticked = (self.groups, self.attributes, self.colours, self.uv_maps, self.texture, self.form, self.form_back)
        return any((*ticked, self.shape_keys, *self.heat_maps))

    @property
    def heat_maps(self) -> list[heat.Measure]:
        """The last one is shown."""
        wanted = ((self.heat, heat.MAP), (self.heat_area, heat.MAP_AREA))
        return [measure for ticked, measure in wanted if ticked]


@dataclass
class Member:
    """A mesh with its landmarks."""

    obj: bpy.types.Object
    arrays: blender_mesh.MeshArrays  # all vertices, the triangles of the landmarks' component
    surface: core.Topology
    landmarks: list[int]
    holes: str
    result: Optional[core.Result] = None

    @property
    def places(self) -> arrangement.Arrangement:
        return arrangement.arrange(self.landmarks, self.surface, self.holes == "mirror")


@dataclass
class Outcome:
    """What a target gets: the calls that write it, and what to say of it."""

    target: Member
    map: core.SurfaceMap  # of the target onto the source
    back: core.SurfaceMap  # of the source onto the target
    cut_ratio: float
    writes: list[Callable[[], object]] = field(default_factory=list)
    names: dict[str, list[str]] = field(default_factory=dict)  # of what is written, by kind
    crossing: np.ndarray = field(default_factory=lambda: np.zeros(0, int))  # faces that a seam runs through
    cut: Optional[SeamCut] = None  # of its faces
    cut_uv: dict[str, np.ndarray] = field(default_factory=dict)  # UV maps at the corners of the cut's pieces
    locked: list[str] = field(default_factory=list)  # vertex groups

    @property
    def distortion(self) -> core.MapDistortion:
        return self.map.distortion

    @property
    def strained(self) -> bool:
        """As maps are whose landmarks do not correspond, or that are twisted."""
        return max(self.distortion.quasi_conformal_mean, self.cut_ratio) > MUCH

    def write_cut(self) -> None:
        """After all `writes`, as vertices and faces are added."""
        if self.cut is not None and self.cut.pieces:
            seam_edit.apply(self.target.obj.data, self.target.arrays.triangles, self.cut, self.cut_uv)

    def add(self, kind: str, name: str, write: Callable[[], object]) -> None:
        self.names.setdefault(kind, []).append(name)
        self.writes.append(write)


def attributes_of(source: Member, wishes: Wishes) -> list[tuple[str, str, str]]:
    """(name, domain, type) of those of the source that are wanted, colours first; none of ours."""
    mesh, ours = source.obj.data, {measure.colour for measure in heat.MEASURES}
    found = sorted(blender_mesh.plain_attributes(mesh), key=lambda one: one[0] not in mesh.color_attributes)
    return [
        one for one in found
        if not one[0].startswith("orbifold_") and one[0] not in ours
        and (wishes.colours if one[0] in mesh.color_attributes else wishes.attributes)
    ]


def uv_maps_of(source: Member, wishes: Wishes) -> list[str]:
    return [layer.name for layer in source.obj.data.uv_layers] if wishes.uv_maps else []


def outcome_of(
    source: Member, target: Member, wishes: Wishes, texture: Optional[textures.Texture]
) -> Generator[Step, None, Outcome]:
    """Both are embedded. Raises OrbifoldError."""
    yield "map", 0.0
    to_source = core.SurfaceMap(target.result, source.result)
    back = core.SurfaceMap(source.result, target.result)
    work = Correspondence(source.arrays, target.arrays, to_source, back)
    outcome = Outcome(target, to_source, back, work.cut_ratio)
    if wishes.groups:
        yield "groups", 0.1
        _add_groups(source, work, outcome)
    yield "attributes", 0.2
    _add_attributes(source, attributes_of(source, wishes), work, outcome)
    names = uv_maps_of(source, wishes)
    if wishes.cut_seams and names:
        own = [blender_mesh.read_uv(source.obj.data, name).astype(np.float64) for name in names]
        outcome.cut = yield from part_of(0.2, 0.3, cut_along(work, own))
    for name in names:
        yield "UV maps", 0.3
        _add_uv_map(source, name, work, outcome)
    if texture is not None:
        yield from part_of(0.4, 0.9, _add_texture(source, texture, work, outcome))
    yield "forms", 0.9
    if wishes.form:
        own = blender_mesh.read_vertices(target.obj.data)
        form = np.where(np.isfinite(work.images), work.images, own)
        _add_key(outcome, target.obj, form, FORM.format(source.obj.name))
    if wishes.form_back:
        own, form = blender_mesh.read_vertices(source.obj.data), work.back.points()
        _add_key(outcome, source.obj, np.where(np.isfinite(form), form, own), FORM.format(target.obj.name))
    if wishes.shape_keys:
        _add_shape_keys(source, work, outcome)
    for measure in wishes.heat_maps:
        values = heat.at_vertices(target.arrays, _distortion(source, outcome, measure))
        outcome.add("heat maps", measure.colour, partial(
            heat.show, bpy.context, target.obj.data, measure, values
        ))
    return outcome


def _distortion(source: Member, outcome: Outcome, measure: heat.Measure) -> np.ndarray:
    """(m,) of the target's triangles: the logarithm of the ratio of singular values, or that of the area there for the
    area on the source, which is 0 for the meshes as a whole. 0 where the map has none."""
    distortion = outcome.distortion
    if measure == heat.MAP:
        return np.log(np.maximum(distortion.quasi_conformal, 1.0))
    whole = np.log(heat.areas_of(outcome.target.arrays).sum() / heat.areas_of(source.arrays).sum())
    return np.where(distortion.quasi_conformal > 0, -distortion.log_area - whole, 0.0)


def _add_groups(source: Member, work: Correspondence, outcome: Outcome) -> None:
    groups, target = source.obj.vertex_groups, outcome.target.obj
    if not len(groups):
        return
    weights = work.of_vertices(blender_mesh.read_all_group_weights(source.obj.data, len(groups)))
    for group in groups:
        there = target.vertex_groups.get(group.name)
        if there is not None and there.lock_weight:
            outcome.locked.append(group.name)
            continue
        own = np.clip(weights[:, group.index], 0.0, 1.0)
        own[own < 1e-6] = 0.0
        outcome.add("vertex groups", group.name, partial(
            _write_group, target, group.name, own, work.vertices.there, group.lock_weight
        ))


def _add_attributes(
    source: Member, wanted: list[tuple[str, str, str]], work: Correspondence, outcome: Outcome
) -> None:
    mesh, target = source.obj.data, outcome.target.obj.data
    for name, domain, kind in wanted:
        values, exact = blender_mesh.read_attribute(mesh, name), kind in ("INT", "BOOLEAN")
        if domain == "POINT":
            found, among = (work.nearest_of_vertices if exact else work.of_vertices)(values), work.vertices.there
        elif domain == "CORNER":
            found, among = (work.nearest_of_corners if exact else work.of_corners)(values), work.corners.there
        else:
            found, among = _of_faces(values, work, len(target.polygons))
        outcome.add("colours" if name in mesh.color_attributes else "attributes", name, partial(
            blender_mesh.write_attribute, target, name, domain, kind, found, among
        ))


def _of_faces(values: np.ndarray, work: Correspondence, n_faces: int) -> tuple[np.ndarray, np.ndarray]:
    """(n_faces, width) of the target, and which of its faces have one."""
    known, faces = work.of_faces(values)
    found, among = np.zeros((n_faces, values.shape[1]), values.dtype), np.zeros(n_faces, bool)
    found[faces], among[faces] = known, True
    return found, among


def _add_uv_map(source: Member, name: str, work: Correspondence, outcome: Outcome) -> None:
    own = blender_mesh.read_uv(source.obj.data, name).astype(np.float64)
    uv, crossing = work.of_uv(own)
    if outcome.cut is not None:
        crossing = outcome.cut.crossing
        across = np.zeros(len(uv), bool)
        across[work.target.loops[np.isin(work.target.polygons, crossing)]] = True
        uv = np.where(across[:, None], uv, work.of_corners(own))
        outcome.cut_uv[name] = outcome.cut.corners.mixed(own[work.source.loops])
    outcome.crossing = np.union1d(outcome.crossing, crossing).astype(int)
    outcome.add("UV maps", name, partial(
        blender_mesh.write_uv_of_loops, outcome.target.obj.data, uv, work.corners.there, name
    ))


def _add_texture(
    source: Member, texture: textures.Texture, work: Correspondence, outcome: Outcome
) -> Generator[Step, None, None]:
    target = outcome.target
    own = target.obj.data.uv_layers.active.name
    uv = blender_mesh.read_uv(target.obj.data, own).astype(np.float64)[target.arrays.loops]
    from_uv = blender_mesh.read_uv(source.obj.data, texture.uv_map).astype(np.float64)
    corners = from_uv[source.arrays.loops]
    pixels = yield from baking.bake(uv, *texture.image.size, work.map.evaluate, corners, texture.pixels())
    outcome.add("images", texture.image.name, partial(textures.write, target.obj, texture, pixels, own))


def _add_shape_keys(source: Member, work: Correspondence, outcome: Outcome) -> None:
    keys = source.obj.data.shape_keys
    if keys is None:
        return
    basis, own = work.source.vertices, blender_mesh.read_vertices(outcome.target.obj.data)
    for key in keys.key_blocks:
        if key == keys.reference_key or key.name == blender_mesh.SHAPE_KEY or key.name.startswith(FORM.format("")):
            continue
        moved = blender_mesh.read_shape_key(source.obj, key.name) - basis
        _add_key(outcome, outcome.target.obj, own + work.of_displacements(moved), key.name)


def _add_key(outcome: Outcome, obj: bpy.types.Object, positions: np.ndarray, name: str) -> None:
    outcome.add("shape keys", name, partial(blender_mesh.write_shape_key, obj, positions, name))


def _write_group(
    obj: bpy.types.Object, name: str, weights: np.ndarray, among: np.ndarray, locked: bool
) -> None:
    """A new group is locked where the source's is."""
    there = name in obj.vertex_groups
    blender_mesh.write_group_weights(obj, name, weights, among)
    if not there:
        obj.vertex_groups[name].lock_weight = locked


def described(outcome: Outcome) -> str:
    distortion = outcome.distortion
    counts = [f"{len(names)} {kind}" if len(names) > 1 else f"1 {kind.rstrip('s')}"
              for kind, names in outcome.names.items()]
    text = (
        f"{', '.join(counts) or 'nothing, as the source has none of what is ticked'}; "
        f"mean angle distortion {distortion.quasi_conformal_mean:.3f}, area spread {distortion.log_area_std:.2f}, "
        "a bijection."
    )
    if outcome.strained:
        text += (
            f" That is much, and the source's landmark paths become {outcome.cut_ratio:.1f} times as long as its own: "
            "look whether the landmarks correspond, and whether another order of them mends a twist."
        )
    if outcome.cut is not None and outcome.cut.cut_faces:
        text += f" {outcome.cut.cut_faces} faces were cut into {outcome.cut.cut_pieces} at the source's seams."
    if len(outcome.crossing):
        text += f" {len(outcome.crossing)} faces cross a seam of the source's UV maps: they are selected."
    if outcome.locked:
        text += f" Locked vertex groups stay: {', '.join(outcome.locked)}."
    return text
