# SPDX-License-Identifier: GPL-3.0-or-later
"""Data of one object's mesh -> other objects', by surface maps: the jobs in turn (one for each mesh, and one in which
everything is computed), and at the end all is written at once. No operator, no context: operators/transfer.py polls the
jobs, api.py waits for them. What each target gets is computed in transfer_outcome.py."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Sequence
from contextlib import ExitStack
from dataclasses import replace
from typing import Optional, Union

import bpy
import numpy as np

from . import arrangement, blender_mesh, cones, core, cut_paths, heat, layouts, seam_edit, textures
from .correspondence import orbifold_for
from .steps import Step, Steps, part_of
from .transfer_outcome import Member, Outcome, Wishes, attributes_of, described, outcome_of, uv_maps_of


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

    def start(self, embedded: Optional[core.Result] = None) -> core.Job:
        """Checks all, and gives the first job. `embedded`: the source, by an earlier transfer from it with the same
        landmarks and wishes. Raises OrbifoldError and BlenderMeshError."""
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
        if embedded is not None:
            self.source.result, self._next = embedded, 1
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
            if self.wishes.uv_maps and self.wishes.cut_seams:
                seam_edit.check(target)

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
        uv_maps = uv_maps_of(self.source, self.wishes)
        try:
            for name, domain, kind in attributes_of(self.source, self.wishes):
                blender_mesh.check_attribute(target.data, name, kind, domain)
            for measure in self.wishes.heat_maps:
                heat.check(target.data, measure)
            for name in uv_maps:
                blender_mesh.check_uv_space(target.data, name)
        except blender_mesh.BlenderMeshError as error:
            raise blender_mesh.BlenderMeshError(f"{target.name}: {error}") from error
        own = target.data.uv_layers.active
        if self.wishes.texture and own is None:
            raise blender_mesh.BlenderMeshError(f"{target.name} has no UV map to bake to: unwrap it first")
        if self.wishes.texture and own.name in uv_maps:
            raise blender_mesh.BlenderMeshError(
                f'The UV map "{own.name}" of {target.name} would be replaced by that of {source.name}, and is to be '
                "baked to: do not tick UV Maps, or rename it"
            )
        more = [name for name in uv_maps if name not in target.data.uv_layers]
        if len(target.data.uv_layers) + len(more) > blender_mesh.MAX_UV_MAPS:
            raise blender_mesh.BlenderMeshError(
                f"{target.name} has no room for {len(more)} more UV maps: remove some, or those of {source.name}"
            )

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

    def proceed(self, job: Union[core.Job, Steps]) -> Union[core.Job, Steps, None]:
        """The job is over: the next one, or None where there is only to write."""
        if isinstance(job, Steps):
            self.outcomes = job.finish()
            return None
        member = self.members[self._next]
        try:
            member.result = job.finish()
        except core.OrbifoldError as error:
            raise error if error.status == "ORB_CANCELLED" else _of(member, error) from error
        self._next += 1
        if self._next < len(self.members):
            return self._embedding()
        return Steps(self._computing())

    def _computing(self) -> Generator[Step, None, list[Outcome]]:
        outcomes, targets = [], self.members[1:]
        with _object_modes([member.obj for member in self.members]):
            for number, target in enumerate(targets):
                self.at = target.obj
                try:
                    steps = outcome_of(self.source, target, self.wishes, self._texture)
                    own = yield from part_of(number / len(targets), (number + 1) / len(targets), steps)
                    outcomes.append(own)
                except core.OrbifoldError as error:
                    raise _of(target, error) from error
        return outcomes

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
            for outcome in self.outcomes:  # at the end, as all else counts the vertices and faces that were there
                outcome.write_cut()

    def message(self) -> str:
        said = [f"{outcome.target.obj.name}: {described(outcome)}" for outcome in self.outcomes]
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
                    "cut_faces": outcome.cut.cut_faces if outcome.cut is not None else 0,
                    "cut_pieces": outcome.cut.cut_pieces if outcome.cut is not None else 0,
                    "landmark_residual": outcome.map.landmark_residual,
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


def _cones(obj: bpy.types.Object) -> list[int]:
    return [cone.vertex for cone in cones.read_cones(obj.data)]


def _object_modes(objects: Iterable[bpy.types.Object]) -> ExitStack:
    stack = ExitStack()
    for obj in objects:
        stack.enter_context(blender_mesh.object_mode(obj))
    return stack


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
