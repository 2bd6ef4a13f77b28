# SPDX-License-Identifier: GPL-3.0-or-later
"""Data of one object's mesh -> other objects', by surface maps: the jobs in turn (one for each mesh), then everything
is computed, and at the end written at once. No operator, no context: operators/transfer.py polls the jobs, api.py
waits for them. What is computed is in correspondence.py."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Optional

import bpy
import numpy as np

from . import arrangement, baking, blender_mesh, cones, core, cut_paths, heat, layouts, textures
from .correspondence import Correspondence, orbifold_for

FORM = "Form of {}"  # shape keys
MUCH = 2.0  # a map's mean angle distortion, and how many times as long as its own a mapped cut is: more is said


@dataclass(frozen=True)
class Wishes:
    """What is transferred, and how the meshes are embedded."""

    groups: bool = True
    attributes: bool = True
    colours: bool = True
    uv_maps: bool = True
    texture: bool = False  # the image of the source's material, to the targets' active UV maps
    form: bool = False  # a shape key of each target: the source's form
    form_back: bool = False  # a shape key of the source for each target: its form
    shape_keys: bool = False
    heat: bool = False
    signature: str = ""  # empty: orbifold_for
    weights: str = "conformal"
    clamp: float = 0.01
    holes: Optional[str] = None  # None: the choice that is kept with each mesh

    @property
    def any(self) -> bool:
        ticked = (self.groups, self.attributes, self.colours, self.uv_maps, self.texture, self.form, self.form_back)
        return any((*ticked, self.shape_keys, self.heat))


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
    distortion: core.MapDistortion
    landmark_residual: float
    cut_ratio: float
    writes: list[Callable[[], object]] = field(default_factory=list)
    names: dict[str, list[str]] = field(default_factory=dict)  # of what is written, by kind
    crossing: np.ndarray = field(default_factory=lambda: np.zeros(0, int))  # faces that a seam runs through
    locked: list[str] = field(default_factory=list)  # vertex groups

    @property
    def strained(self) -> bool:
        """As maps are whose landmarks do not correspond, or that are twisted."""
        return max(self.distortion.quasi_conformal_mean, self.cut_ratio) > MUCH

    def add(self, kind: str, name: str, write: Callable[[], object]) -> None:
        self.names.setdefault(kind, []).append(name)
        self.writes.append(write)


def mismatch(counts: Sequence[tuple[str, int]]) -> Optional[str]:
    """Why meshes with these names and numbers of landmarks, the source first, have no map; None where they may."""
    (name, count), *others = counts
    unequal = next((other for other in others if other[1] != count), None)
    if unequal is None:
        return None
    return (
        f"{name} has {count} landmarks and {unequal[0]} has {unequal[1]}: give each as many cones, the corresponding "
        "ones in the same places of their lists"
    )


class Transferring:
    """`start`, then `proceed` with each job that is over until it gives None; then `write`."""

    def __init__(
        self, source: bpy.types.Object, targets: Sequence[bpy.types.Object], wishes: Wishes,
        landmarks: Optional[Sequence[Sequence[int]]] = None,
    ) -> None:
        """`landmarks`: of the source and of each target, vertices; None: the cones of their meshes."""
        self.wishes = wishes
        self.at = source  # the object that an error is about
        self.outcomes: list[Outcome] = []
        self._objects, self._landmarks, self._next = [source, *targets], landmarks, 0

    @property
    def source(self) -> Member:
        return self.members[0]

    # --------------------------------------------------------------------------------- before the computation

    def start(self) -> core.Job:
        """Checks all, and gives the first job. Raises OrbifoldError and BlenderMeshError."""
        source, *targets = objects = self._objects
        if not self.wishes.any:
            raise blender_mesh.BlenderMeshError("Nothing is ticked that could be transferred")
        if not targets:
            raise blender_mesh.BlenderMeshError("Select the meshes that are to get something too")
        found = self._landmarks if self._landmarks is not None else [_cones(obj) for obj in objects]
        problem = mismatch([(obj.name, len(own)) for obj, own in zip(objects, found)])
        if problem is not None:
            raise blender_mesh.BlenderMeshError(problem)
        self._check_targets(source, targets)
        with _object_modes(objects):
            self.members = [self._member(obj, list(own)) for obj, own in zip(objects, found)]
            self.at = source
            self.signature = self._signature()
            self._texture = textures.find(source) if self.wishes.texture else None
            for target in targets:
                self.at = target
                self._check_names(source, target)
        return self._embedding()

    def _check_targets(self, source: bpy.types.Object, targets: Sequence[bpy.types.Object]) -> None:
        for number, target in enumerate(targets):
            self.at = target
            if target.data.library is not None:
                raise blender_mesh.BlenderMeshError(f"The mesh of {target.name} is linked from another file: make it "
                                                    "local first")
            for other in (source, *targets[:number]):
                if other.data == target.data:
                    raise blender_mesh.BlenderMeshError(
                        f"{other.name} and {target.name} share one mesh: make it single-user (Object > Relations), or "
                        "deselect one of them"
                    )

    def _member(self, obj: bpy.types.Object, landmarks: list[int]) -> Member:
        self.at = obj
        arrays = blender_mesh.read_mesh(obj.data)
        outside = [vertex for vertex in landmarks if not 0 <= vertex < len(arrays.vertices)]
        if outside:
            raise core.OrbifoldError(
                "ORB_BAD_CONE", f"{obj.name}: there is no vertex {outside[0]} in the mesh", outside, "vertex"
            )
        arrays = _component(obj, arrays, landmarks)
        holes = self.wishes.holes or obj.data.orbifold.holes
        return Member(obj, arrays, core.topology_of(arrays.triangles), landmarks, holes)

    def _signature(self) -> str:
        if self.wishes.signature:
            return self.wishes.signature
        places = self.source.places
        for member in self.members[1:]:
            self.at, own = member.obj, member.places
            if (own.cones, own.borders) != (places.cones, places.borders):
                raise blender_mesh.BlenderMeshError(
                    f"The landmarks of {self.source.obj.name} and {member.obj.name} lie differently on borders: those "
                    "in the same places of the lists have to be on corresponding borders, in turn along them, or inside"
                )
        count = len(self.source.landmarks)
        text = orbifold_for(lambda order: places.text([order] * count))
        self.at = self.source.obj
        if text is None:
            raise blender_mesh.BlenderMeshError(
                f"{count} landmarks are too few for a map: add cones to all meshes, 3 or more on a closed one"
            )
        return text

    def _check_names(self, source: bpy.types.Object, target: bpy.types.Object) -> None:
        """What is to be written can be."""
        try:
            for name, domain, kind in self._attributes():
                blender_mesh.check_attribute(target.data, name, kind, domain)
            if self.wishes.heat:
                heat.check(target.data, heat.MAP)
            for name in self._uv_maps():
                blender_mesh.check_uv_space(target.data, name)
        except blender_mesh.BlenderMeshError as error:
            raise blender_mesh.BlenderMeshError(f"{target.name}: {error}") from error
        own = target.data.uv_layers.active
        if self.wishes.texture and own is None:
            raise blender_mesh.BlenderMeshError(f"{target.name} has no UV map to bake to: unwrap it first")
        if self.wishes.texture and own.name in self._uv_maps():
            raise blender_mesh.BlenderMeshError(
                f'The UV map "{own.name}" of {target.name} would be replaced by that of {source.name}, and is to be '
                "baked to: do not tick UV Maps, or rename it"
            )
        more = [name for name in self._uv_maps() if name not in target.data.uv_layers]
        if len(target.data.uv_layers) + len(more) > blender_mesh.MAX_UV_MAPS:
            raise blender_mesh.BlenderMeshError(
                f"{target.name} has no room for {len(more)} more UV maps: remove some, or those of {source.name}"
            )

    def _attributes(self) -> list[tuple[str, str, str]]:
        """(name, domain, type) of those of the source that are wanted, colours first; none of ours."""
        mesh, ours = self.members[0].obj.data, {measure.colour for measure in heat.MEASURES}
        found = sorted(blender_mesh.plain_attributes(mesh), key=lambda one: one[0] not in mesh.color_attributes)
        return [
            one for one in found
            if not one[0].startswith("orbifold_") and one[0] not in ours
            and (self.wishes.colours if one[0] in mesh.color_attributes else self.wishes.attributes)
        ]

    def _uv_maps(self) -> list[str]:
        return [layer.name for layer in self.members[0].obj.data.uv_layers] if self.wishes.uv_maps else []

    # ----------------------------------------------------------------------------------------------- the jobs

    def _embedding(self) -> core.Job:
        member = self.members[self._next]
        self.at = member.obj
        if self.wishes.signature:
            vertices = arrangement.in_sequence(member.landmarks, member.surface, self.signature)
        else:
            vertices = [member.landmarks[place] for place in member.places.sequence]
        try:
            return core.start_embedding(
                *(member.arrays.vertices, member.arrays.triangles, self.signature, vertices),
                weights=self.wishes.weights, clamp=self.wishes.clamp, holes=member.holes, cut="path",
            )
        except core.OrbifoldError as error:
            raise _of(member, error) from error

    def proceed(self, job: core.Job) -> Optional[core.Job]:
        """The job is over: the next one, or None where there is only to write."""
        member = self.members[self._next]
        try:
            member.result = job.finish()
        except core.OrbifoldError as error:
            raise error if error.status == "ORB_CANCELLED" else _of(member, error) from error
        self._next += 1
        if self._next < len(self.members):
            return self._embedding()
        with _object_modes([member.obj for member in self.members]):
            for target in self.members[1:]:
                self.at = target.obj
                try:
                    self.outcomes.append(self._computed(target))
                except core.OrbifoldError as error:
                    raise _of(target, error) from error
        return None

    # -------------------------------------------------------------------------------------------- what to write

    def _computed(self, target: Member) -> Outcome:
        to_source = core.SurfaceMap(target.result, self.source.result)
        back = core.SurfaceMap(self.source.result, target.result)
        work = Correspondence(self.source.arrays, target.arrays, to_source, back)
        outcome = Outcome(target, to_source.distortion, to_source.landmark_residual, work.cut_ratio)
        if self.wishes.groups:
            self._add_groups(work, outcome)
        self._add_attributes(work, outcome)
        self._add_uv_maps(work, outcome)
        if self._texture is not None:
            self._add_texture(work, outcome)
        self._add_forms(work, outcome)
        if self.wishes.shape_keys:
            self._add_shape_keys(work, outcome)
        if self.wishes.heat:
            ratio = np.log(np.maximum(outcome.distortion.quasi_conformal, 1.0))
            values = heat.at_vertices(target.arrays, ratio)
            outcome.add("heat map", heat.MAP.colour, lambda: heat.show(bpy.context, target.obj.data, heat.MAP, values))
        return outcome

    def _add_groups(self, work: Correspondence, outcome: Outcome) -> None:
        source, target = self.source.obj, outcome.target.obj
        if not len(source.vertex_groups):
            return
        weights = work.of_vertices(blender_mesh.read_all_group_weights(source.data, len(source.vertex_groups)))
        for group in source.vertex_groups:
            there = target.vertex_groups.get(group.name)
            if there is not None and there.lock_weight:
                outcome.locked.append(group.name)
                continue
            own = np.clip(weights[:, group.index], 0.0, 1.0)
            own[own < 1e-6] = 0.0
            outcome.add("vertex groups", group.name, partial(
                _write_group, target, group.name, own, work.vertices.there, group.lock_weight
            ))

    def _add_attributes(self, work: Correspondence, outcome: Outcome) -> None:
        source, mesh = self.source.obj.data, outcome.target.obj.data
        for name, domain, kind in self._attributes():
            values = blender_mesh.read_attribute(source, name)
            of_vertices, exact = domain == "POINT", kind in ("INT", "BOOLEAN")
            if of_vertices:
                found = (work.nearest_of_vertices if exact else work.of_vertices)(values)
            else:
                found = (work.nearest_of_corners if exact else work.of_corners)(values)
            among = (work.vertices if of_vertices else work.corners).there
            outcome.add("colours" if name in source.color_attributes else "attributes", name, partial(
                blender_mesh.write_attribute, mesh, name, domain, kind, found, among
            ))

    def _add_uv_maps(self, work: Correspondence, outcome: Outcome) -> None:
        for name in self._uv_maps():
            uv, crossing = work.of_uv(blender_mesh.read_uv(self.source.obj.data, name).astype(np.float64))
            outcome.crossing = np.union1d(outcome.crossing, crossing).astype(int)
            outcome.add("UV maps", name, partial(
                blender_mesh.write_uv_of_loops, outcome.target.obj.data, uv, work.corners.there, name
            ))

    def _add_texture(self, work: Correspondence, outcome: Outcome) -> None:
        texture, target = self._texture, outcome.target
        own = target.obj.data.uv_layers.active.name
        uv = blender_mesh.read_uv(target.obj.data, own).astype(np.float64)[target.arrays.loops]
        from_uv = blender_mesh.read_uv(self.source.obj.data, texture.uv_map).astype(np.float64)
        corners = from_uv[self.source.arrays.loops]
        pixels = baking.bake(uv, *texture.image.size, work.map.evaluate, corners, texture.pixels())
        outcome.add("images", texture.image.name, partial(textures.write, target.obj, texture, pixels, own))

    def _add_forms(self, work: Correspondence, outcome: Outcome) -> None:
        source, target = self.source, outcome.target
        if self.wishes.form:
            own = blender_mesh.read_vertices(target.obj.data)
            form = np.where(np.isfinite(work.images), work.images, own)
            self._add_key(outcome, target.obj, form, FORM.format(source.obj.name))
        if self.wishes.form_back:
            own, form = blender_mesh.read_vertices(source.obj.data), work.back.points()
            self._add_key(outcome, source.obj, np.where(np.isfinite(form), form, own), FORM.format(target.obj.name))

    def _add_shape_keys(self, work: Correspondence, outcome: Outcome) -> None:
        keys = self.source.obj.data.shape_keys
        if keys is None:
            return
        basis, own = work.source.vertices, blender_mesh.read_vertices(outcome.target.obj.data)
        for key in keys.key_blocks:
            if key == keys.reference_key or key.name == blender_mesh.SHAPE_KEY or key.name.startswith(FORM.format("")):
                continue
            moved = blender_mesh.read_shape_key(self.source.obj, key.name) - basis
            self._add_key(outcome, outcome.target.obj, own + work.of_displacements(moved), key.name)

    def _add_key(self, outcome: Outcome, obj: bpy.types.Object, positions: np.ndarray, name: str) -> None:
        outcome.add("shape keys", name, partial(blender_mesh.write_shape_key, obj, positions, name))

    # ------------------------------------------------------------------------------------------------- writing

    def write(self) -> None:
        """In one go, in any mode. Faces that cross a seam are selected, and only they."""
        nothing = np.zeros(0, np.int64)
        with _object_modes([member.obj for member in self.members]):
            for outcome in self.outcomes:
                for write in outcome.writes:
                    write()
                if len(outcome.crossing):
                    blender_mesh.select_elements(outcome.target.obj.data, nothing, nothing, outcome.crossing)
            for member in self.members:
                _draw_paths(member)

    def message(self) -> str:
        said = [f"{outcome.target.obj.name}: {_described(outcome)}" for outcome in self.outcomes]
        return f"From {self.source.obj.name} by {self.signature}. {' '.join(said)}"

    @property
    def warned(self) -> bool:
        return any(
            len(outcome.crossing) or outcome.locked or outcome.strained for outcome in self.outcomes
        )

    def report(self) -> dict:
        return {
            "source": self.source.obj.name,
            "signature": self.signature,
            "geometry": self.source.result.geometry,
            "targets": [
                {
                    "object": outcome.target.obj.name,
                    "written": outcome.names,
                    "locked_groups": outcome.locked,
                    "crossing_faces": outcome.crossing.tolist(),
                    "landmark_residual": outcome.landmark_residual,
                    "cut_ratio": outcome.cut_ratio,
                    "flipped": outcome.distortion.flipped,
                    "bijective": True,  # both embeddings are certified
                    "distortion": {
                        name: getattr(outcome.distortion, name)
                        for name in ("quasi_conformal_mean", "quasi_conformal_max", "log_area_mean", "log_area_std")
                    },
                }
                for outcome in self.outcomes
            ],
        }


def _described(outcome: Outcome) -> str:
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
    if len(outcome.crossing):
        text += f" {len(outcome.crossing)} faces cross a seam of the source's UV maps: they are selected."
    if outcome.locked:
        text += f" Locked vertex groups stay: {', '.join(outcome.locked)}."
    return text


def _cones(obj: bpy.types.Object) -> list[int]:
    return [cone.vertex for cone in cones.read_cones(obj.data)]


def _object_modes(objects: Iterable[bpy.types.Object]) -> ExitStack:
    stack = ExitStack()
    for obj in objects:
        stack.enter_context(blender_mesh.object_mode(obj))
    return stack


def _write_group(
    obj: bpy.types.Object, name: str, weights: np.ndarray, among: np.ndarray, locked: bool
) -> None:
    """A new group is locked where the source's is."""
    there = name in obj.vertex_groups
    blender_mesh.write_group_weights(obj, name, weights, among)
    if not there:
        obj.vertex_groups[name].lock_weight = locked


def _draw_paths(member: Member) -> None:
    """The cut through the landmarks, numbered alike on all meshes, is drawn where there is none of a layout."""
    mesh, result = member.obj.data, member.result
    if layouts.has_layout(mesh):
        return
    seams = result.seams[(result.seams < len(mesh.vertices)).all(1)]
    numbers = cut_paths.number_paths(seams, result.cones)
    place = {int(vertex): number for number, vertex in enumerate(result.cones)}
    first = [
        min((place[vertex] for vertex in seams[numbers == path].ravel().tolist() if vertex in place), default=path)
        for path in range(int(numbers.max(initial=-1)) + 1)
    ]
    layouts.keep_cut(mesh, seams, np.array(first, int)[numbers])
    mesh.update()


def _component(
    obj: bpy.types.Object, arrays: blender_mesh.MeshArrays, landmarks: Sequence[int]
) -> blender_mesh.MeshArrays:
    """The triangles of the component on which the landmarks lie."""
    if not len(landmarks) or core.topology_of(arrays.triangles).components < 2:
        return arrays
    label = core.vertex_components(len(arrays.vertices), arrays.triangles)
    if len(set(label[landmarks].tolist())) > 1:
        raise core.OrbifoldError(
            "ORB_SEVERAL_COMPONENTS", f"{obj.name}: the landmarks lie on several components: take one of them",
            list(landmarks), "vertex",
        )
    chosen = label[arrays.triangles[:, 0]] == label[landmarks[0]]
    return replace(
        arrays, triangles=arrays.triangles[chosen], loops=arrays.loops[chosen], polygons=arrays.polygons[chosen]
    )


def _of(member: Member, error: core.OrbifoldError) -> core.OrbifoldError:
    """Which mesh it is about. Triangles are named as they are counted in its component: where that is not all, none."""
    elements = error.elements
    if error.element == "triangle" and 3 * len(member.arrays.triangles) < len(member.obj.data.loops):
        elements = []
    return core.OrbifoldError(error.status, f"{member.obj.name}: {error}", elements, error.element, error.found)
