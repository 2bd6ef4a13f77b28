# SPDX-License-Identifier: GPL-3.0-or-later
"""One run: arguments, mesh, cones, embedding, four files. Either all four appear in the output folder or none."""

from __future__ import annotations

import json
import time
from dataclasses import dataclass, replace
from typing import Optional

import bpy
import numpy as np

from .. import blender_mesh, core, faces, materials, pattern
from ..sphere_map import sphere_of
from .arguments import SAMPLE, Arguments
from .errors import RunError
from .exporters import check_export, export_object
from .importers import empty_file, load_object
from .mapping import Kept, Mapped, map_one
from .output import Figures, folder_for, one_line, quiet, show_material, written
from .picture import Subject, render_picture
from .placing import Placed, embed_placed
from .sample import make_creature
from .tiling import make_tiling

IMAGES = 120  # of the tile, at most, but for finite groups: *532 has 120
TRIANGLES_DRAWN = 1_600_000  # of all images of the tile in the picture, where each is a mesh of its own


@dataclass(frozen=True)
class Unwrapped:
    name: str
    obj: bpy.types.Object
    arrays: blender_mesh.MeshArrays
    placed: Placed
    layout: faces.FaceLayout
    material: Optional[bpy.types.Material]  # None: no file shows it
    remarks: list[str]  # what is not as one may expect, and why

    @property
    def result(self) -> core.Result:
        return self.placed.result

    @property
    def report(self) -> dict:
        """NAME.json."""
        suggestion = self.placed.suggestion
        if suggestion is None:
            return self.result.report
        kept = ("predicted", "measured", "symmetric")
        return {**self.result.report, "suggested": {name: getattr(suggestion, name) for name in kept}}

    @property
    def figures(self) -> Figures:
        orbifold, distortion = self.report["orbifold"], self.report["distortion"]
        return Figures(
            *(orbifold["signature"], [cone["vertex"] for cone in orbifold["cones"]]),
            *(self.report["certificate"]["flipped"], distortion["quasi_conformal_mean"], distortion["log_area_std"]),
        )

    def summary(self, arguments: Arguments, seconds: float) -> list[str]:
        """What to tell the user."""
        report, distortion = self.result.report, self.result.report["distortion"]
        cones = ", ".join(map(str, self.figures.cones)) or "none"
        return [
            f"{self.name}: {report['mesh']['vertices']} vertices onto {report['orbifold']['signature']} "
            f"({report['orbifold']['geometry']}), cones {cones}",
            *_suggested(self.placed.suggestion),
            f"certified: a bijection, {report['certificate']['flipped']} flipped triangles, mean quasi-conformal error "
            f"{distortion['quasi_conformal_mean']:.3f}, area spread {distortion['log_area_std']:.2f}",
            written(arguments, seconds),
            *self.remarks,
        ]


def run(arguments: Arguments) -> list[str]:
    """What to tell the user. Raises one of EXPECTED, or finds a fault of ours."""
    started = time.perf_counter()
    done = run_one(arguments)
    return done.summary(arguments, time.perf_counter() - started)


def run_one(
    arguments: Arguments, progress: Optional[core.Progress] = None, kept: Optional[Kept] = None
) -> Unwrapped | Mapped:
    """The files are there when this returns; otherwise none of them, and one of EXPECTED is raised. `kept`: of the jobs
    of one batch."""
    if arguments.signature is not None:
        core.parse_signature(arguments.signature)  # before the mesh is read, which can take long
    exported = arguments.map_to or arguments.mesh
    if arguments.export:
        check_export(exported, arguments.output)
        if exported.suffix.lower() == ".blend" and "blend" not in arguments.files:
            arguments = replace(arguments, files=("blend", *arguments.files))
    if arguments.map_to is not None:
        return map_one(arguments, progress, kept or Kept())
    with quiet():
        unwrapped = _unwrap(arguments, progress)
        _write_files(unwrapped, arguments)
    return unwrapped


# --------------------------------------------------------------------------------------------------- the work


def _unwrap(arguments: Arguments, progress: Optional[core.Progress]) -> Unwrapped:
    empty_file()
    if arguments.mesh is None:
        name, obj = SAMPLE, make_creature()
    else:
        name = arguments.mesh.stem
        obj = load_object(arguments.mesh.resolve(), arguments.object_name, core.read_mesh)
    arrays = blender_mesh.read_mesh(obj.data)
    placed = embed_placed(arguments, arrays, progress)
    result = placed.result
    if not result.report["certificate"]["bijective"]:
        raise RunError("the result is not certified to be a bijection")
    layout = faces.layout_of(result, arrays, result.chart)
    remarks = placed.remarks + faces.remarks(result, layout)
    if result.geometry == "spherical":
        remarks += _write_sphere(obj, arrays, result)
    shown = bool({"blend", "png"} & set(arguments.files))
    material = _dress(obj, arrays, result, layout, shown)
    return Unwrapped(name, obj, arrays, placed, layout, material, remarks)


def _write_sphere(obj: bpy.types.Object, arrays: blender_mesh.MeshArrays, result: core.Result) -> list[str]:
    """The shape key; where the sphere cannot be covered, or on a mesh too coarse for it, why there is none."""
    try:
        blender_mesh.write_shape_key(obj, sphere_of(result, arrays))
    except core.OrbifoldError as error:
        return [f"no shape key: {one_line(error)}"]
    return []


def _dress(obj: bpy.types.Object, arrays: blender_mesh.MeshArrays, result: core.Result, layout: faces.FaceLayout,
           shown: bool) -> Optional[bpy.types.Material]:
    """UV map and seams on the object and, where it is to be shown, the one material."""
    mesh = obj.data
    blender_mesh.write_uv(mesh, arrays, layout.uv)
    blender_mesh.mark_seams(mesh, layout.seams)
    material = None
    if shown:
        material = materials.make_material(obj, result, layout)
        mesh.materials.clear()
        materials.assign(obj, material)
    smooth = result.report["mesh"]["orientable"]  # elsewhere normals of faces that lie on their backs would mix
    mesh.polygons.foreach_set("use_smooth", np.full(len(mesh.polygons), smooth))
    mesh.update()
    return material


def _write_files(unwrapped: Unwrapped, arguments: Arguments) -> None:
    """All files into a folder beside their places, then moved there."""
    output, wanted = arguments.output, arguments.files
    with folder_for(output) as part:
        places = {ending: part / f"{unwrapped.name}.{ending}" for ending in wanted}
        show_material()
        if "blend" in wanted:
            bpy.ops.wm.save_as_mainfile(filepath=str(places["blend"]), copy=True, compress=True)
        if "json" in wanted:
            report = json.dumps(unwrapped.report, indent=2, allow_nan=False)
            places["json"].write_text(report + "\n", encoding="utf-8")
        if "npz" in wanted:
            unwrapped.result.save(places["npz"])
        if arguments.export and arguments.mesh.suffix.lower() != ".blend":
            export_object(unwrapped.obj, part / arguments.mesh.name)
        if "png" in wanted:
            render_picture(_subject(unwrapped), places["png"])


def _subject(unwrapped: Unwrapped) -> Subject:
    """What the picture shows: the tile as the library cut it, painted like the object."""
    result = unwrapped.result
    limit = IMAGES
    if result.geometry == "hyperbolic":
        limit = min(limit, max(1, TRIANGLES_DRAWN // len(result.cut_triangles)))
    tiling = make_tiling(result, limit)
    uv = result.tile_uv(result.chart).reshape(-1, 2)[tiling.corners]
    rank = {int(cone): number for number, cone in enumerate(result.cones)}
    return Subject(unwrapped.obj, unwrapped.arrays.vertices, result.cones, tiling,
                   [rank[int(result.cut_to_vertex[corner])] for corner in tiling.cones],
                   pattern.palette(max(len(result.cones), pattern.LEAST_CENTRES)) ** 2.2, unwrapped.material, uv)


def _suggested(suggestion: Optional[core.Suggestion]) -> list[str]:
    if suggestion is None:
        return []
    spread = "measured spread of areas and angles" if suggestion.measured else "predicted area spread"
    return [f"the cones were suggested: {spread} {suggestion.predicted:.2f}"]
