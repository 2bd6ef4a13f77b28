# SPDX-License-Identifier: GPL-3.0-or-later
"""One run with --map-to: two meshes, their landmarks, what the second gets from the first, four files."""

from __future__ import annotations

import json
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Optional

import bpy
import numpy as np
from mathutils import Matrix, Vector

from .. import cones, core, properties, transfer_settings, viewing
from ..transfer_outcome import Member, Wishes, described
from ..transferring import Transferring
from .arguments import Arguments
from .errors import RunError
from .exporters import export_object
from .importers import empty_file, load_object
from .map_picture import render_map
from .output import Figures, folder_for, quiet, show_material, written
from .sample import make_creature

TICKED = tuple(name for name in transfer_settings.NAMES if name != "signature")
GAP = 0.15  # between the two objects, of the wider one


@dataclass
class Kept:
    """The embedding of the latest source, which the next map of a batch may begin with too."""

    key: Optional[tuple] = None
    result: Optional[core.Result] = None


@dataclass(frozen=True)
class Mapped:
    work: Transferring  # with one target
    files: tuple[str, str]  # of source and target

    @property
    def source(self) -> Member:
        return self.work.source

    @property
    def target(self) -> Member:
        return self.work.members[1]

    @property
    def report(self) -> dict:
        """NAME.json."""
        return {
            "meshes": dict(zip(("source", "target"), self.files)),
            "landmarks": {"source": self.source.landmarks, "target": self.target.landmarks},
            **self.work.report(),
        }

    @property
    def figures(self) -> Figures:
        distortion = self.work.outcomes[0].distortion
        return Figures(self.work.signature, self.target.landmarks, distortion.flipped,
                       distortion.quasi_conformal_mean, distortion.log_area_std)

    def summary(self, arguments: Arguments, seconds: float) -> list[str]:
        """What to tell the user."""
        n_source, n_target = (len(member.arrays.vertices) for member in self.work.members)
        return [
            f"{self.files[0]} to {self.files[1]}: {n_source} and {n_target} vertices by {self.work.signature}, "
            f"{len(self.source.landmarks)} landmarks",
            described(self.work.outcomes[0]),
            written(arguments, seconds),
        ]


def map_one(arguments: Arguments, progress: Optional[core.Progress], kept: Kept) -> Mapped:
    """The files are there when this returns; otherwise none of them, and one of EXPECTED is raised."""
    wishes = _wishes(arguments)
    _check_places(arguments)
    with quiet():
        _register()
        source, target = _load(arguments)
        asked = ((source, arguments.cones, "--cones"), (target, arguments.map_cones, "--map-cones"))
        landmarks = [_landmarks(*one) for one in asked]
        work = Transferring(source, [target], wishes, landmarks)
        key = (arguments.mesh, arguments.object_name, *landmarks[0], wishes.signature, wishes.weights, wishes.holes)
        job = work.start(kept.result if kept.key == key else None)
        while job is not None:
            core.wait_until_over(job, progress)
            job = work.proceed(job)
        kept.key, kept.result = key, work.source.result
        work.write()
        mapped = Mapped(work, (source_file(arguments), arguments.map_to.name))
        _write_files(mapped, arguments)
    return mapped


def source_file(arguments: Arguments) -> str:
    return arguments.mesh.name if arguments.mesh is not None else "the sample creature"


# --------------------------------------------------------------------------------------------------- before it


def _wishes(arguments: Arguments) -> Wishes:
    ticked = {}
    if arguments.transfer is not None:
        unknown = [name for name in arguments.transfer if name not in TICKED]
        if unknown:
            raise RunError(f"--transfer {unknown[0]}: expected some of {','.join(TICKED)}")
        ticked = {name: name in arguments.transfer for name in TICKED}
    return Wishes(signature=arguments.signature or "", weights=arguments.weights, holes=arguments.holes, **ticked)


def _check_places(arguments: Arguments) -> None:
    """What is written has its name from the target, and must not be taken for the source, or be written over either."""
    target = arguments.map_to
    if replace(arguments, map_to=None).name == arguments.name:
        raise RunError(f"{target}: it has the name of the mesh that is mapped to it; rename one of the files")
    if "blend" in arguments.files and arguments.output.resolve() / f"{arguments.name}.blend" == target.resolve():
        raise RunError(f"{target}: its result would be written over it; choose another folder with --output")


def _register() -> None:
    """What is kept on meshes and scenes, unless the add-on is enabled: so the .blend has it."""
    if not hasattr(bpy.types.Mesh, "orbifold"):
        properties.register()
        viewing.register()


def _load(arguments: Arguments) -> tuple[bpy.types.Object, bpy.types.Object]:
    """Source and target in one scene. Each is read into an empty file, for .blend files are opened to be read."""
    empty_file()
    target = load_object(arguments.map_to.resolve(), arguments.map_object, core.read_mesh, "--map-object")
    with tempfile.TemporaryDirectory() as folder:
        library, name = str(Path(folder) / "target.blend"), target.name
        bpy.data.libraries.write(library, {target}, path_remap="ABSOLUTE", fake_user=True)
        empty_file()
        if arguments.mesh is None:
            source = make_creature()
        else:
            source = load_object(arguments.mesh.resolve(), arguments.object_name, core.read_mesh)
        with bpy.data.libraries.load(library, link=False) as (_, wanted):
            wanted.objects = [name]
    (target,) = wanted.objects
    target.use_fake_user = False
    bpy.context.scene.collection.objects.link(target)
    bpy.context.view_layer.update()
    for obj in (source, target):
        obj.select_set(True)
    bpy.context.view_layer.objects.active = source
    return source, target


def _landmarks(obj: bpy.types.Object, given: Optional[tuple[int, ...]], option: str) -> list[int]:
    if given is not None:
        return list(given)
    found = [cone.vertex for cone in cones.read_cones(obj.data)]
    if not found:
        raise RunError(f"{obj.name} has no landmarks: name vertices with {option}, or give a .blend that keeps cones")
    return found


# ------------------------------------------------------------------------------------------------------- files


def _write_files(mapped: Mapped, arguments: Arguments) -> None:
    """All files into a folder beside their places, then moved there."""
    output, wanted = arguments.output, arguments.files
    source, target = mapped.source, mapped.target
    with folder_for(output) as part:
        places = {ending: part / f"{arguments.name}.{ending}" for ending in wanted}
        if arguments.export and arguments.map_to.suffix.lower() != ".blend":
            export_object(target.obj, part / arguments.map_to.name)
        if "json" in wanted:
            places["json"].write_text(json.dumps(mapped.report, indent=2, allow_nan=False) + "\n", encoding="utf-8")
        if "npz" in wanted:
            np.savez_compressed(places["npz"], **_arrays(mapped))
        if "blend" in wanted:
            for member in mapped.work.members:
                _keep_landmarks(member)
            _stand_beside(source.obj, target.obj)
            show_material()
            bpy.ops.wm.save_as_mainfile(filepath=str(places["blend"]), copy=True, compress=True)
        if "png" in wanted:
            render_map(source, target, mapped.work.outcomes[0].map, places["png"])


def _arrays(mapped: Mapped) -> dict[str, np.ndarray]:
    """NAME.npz."""
    work, arrays = mapped.work, {}
    for name, other, member, to in (("source", "target", mapped.source, work.outcomes[0].back),
                                    ("target", "source", mapped.target, work.outcomes[0].map)):
        triangles, barycentric = to.spots
        arrays |= {
            f"{name}_vertices": member.arrays.vertices, f"{name}_triangles": member.arrays.triangles,
            f"{name}_landmarks": np.array(member.landmarks, np.int32),
            f"{name}_to_{other}_triangles": triangles, f"{name}_to_{other}_barycentric": barycentric,
        }
    return {**arrays, "signature": np.array(work.signature), "geometry": np.array(mapped.source.result.geometry)}


def _keep_landmarks(member: Member) -> None:
    """As the cones of its mesh, with the orders of the signature."""
    orders = dict(zip(member.result.cones.tolist(), member.result.orders.tolist()))
    properties.set_cones(member.obj.data, member.landmarks, [orders[vertex] for vertex in member.landmarks])


def _stand_beside(source: bpy.types.Object, target: bpy.types.Object) -> None:
    """The source to the left of the target, which stays where it is."""
    boxes = [np.array([obj.matrix_world @ Vector(corner) for corner in obj.bound_box]) for obj in (source, target)]
    gap = GAP * max(np.ptp(box[:, 0]) for box in boxes)
    step = boxes[1][:, 0].min() - gap - boxes[0][:, 0].max()
    source.matrix_world = Matrix.Translation((step, 0, 0)) @ source.matrix_world
