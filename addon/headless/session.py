# SPDX-License-Identifier: GPL-3.0-or-later
"""One run: arguments, mesh, cones, embedding, four files. Either all four appear in the output folder or none."""

from __future__ import annotations

import json
import os
import shutil
import sys
import tempfile
import time
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Iterator, Optional, Sequence

import bpy
import numpy as np

from .. import blender_mesh, core, faces, materials, pattern
from ..sphere_map import sphere_of
from .arguments import Arguments, HelpWanted, read_arguments
from .errors import RunError
from .importers import load_object
from .picture import Subject, render_picture
from .placing import Placed, embed_placed
from .sample import make_creature
from .tiling import make_tiling

EXPECTED = (RunError, core.OrbifoldError, core.MeshFileError, blender_mesh.BlenderMeshError)
ENDINGS = ("blend", "json", "npz", "png")
IMAGES = 120  # of the tile, at most, but for finite groups: *532 has 120
TRIANGLES_DRAWN = 1_600_000  # of all images of the tile in the picture, where each is a mesh of its own


@dataclass(frozen=True)
class Unwrapped:
    name: str
    obj: bpy.types.Object
    arrays: blender_mesh.MeshArrays
    placed: Placed
    layout: faces.FaceLayout
    material: bpy.types.Material
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


def run(words: Sequence[str]) -> list[str]:
    """What to tell the user. Raises one of EXPECTED, or finds a fault of ours."""
    started = time.perf_counter()
    try:
        arguments = read_arguments(words)
    except HelpWanted as text:
        return str(text).splitlines()
    if arguments.signature is not None:
        core.parse_signature(arguments.signature)  # before the mesh is read, which can take long
    with _quiet():
        unwrapped = _unwrap(arguments)
        _write_files(unwrapped, arguments.output)
    return _summary(unwrapped, arguments.output, time.perf_counter() - started)


def one_line(reason: BaseException) -> str:
    return " ".join(str(reason).split()) or type(reason).__name__


# --------------------------------------------------------------------------------------------------- the work


def _unwrap(arguments: Arguments) -> Unwrapped:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if arguments.mesh is None:
        name, obj = "creature", make_creature()
    else:
        name = arguments.mesh.stem
        obj = load_object(arguments.mesh.resolve(), arguments.object_name, core.read_mesh)
    arrays = blender_mesh.read_mesh(obj.data)
    placed = embed_placed(arguments, arrays)
    result = placed.result
    if not result.report["certificate"]["bijective"]:
        raise RunError("the result is not certified to be a bijection")
    layout = faces.layout_of(result, arrays, result.chart)
    remarks = placed.remarks + faces.remarks(result, layout)
    if result.geometry == "spherical":
        remarks += _write_sphere(obj, arrays, result)
    return Unwrapped(name, obj, arrays, placed, layout, _dress(obj, arrays, result, layout), remarks)


def _write_sphere(obj: bpy.types.Object, arrays: blender_mesh.MeshArrays, result: core.Result) -> list[str]:
    """The shape key; where the sphere cannot be covered, or on a mesh too coarse for it, why there is none."""
    try:
        blender_mesh.write_shape_key(obj, sphere_of(result, arrays))
    except core.OrbifoldError as error:
        return [f"no shape key: {one_line(error)}"]
    return []


def _dress(obj: bpy.types.Object, arrays: blender_mesh.MeshArrays, result: core.Result,
           layout: faces.FaceLayout) -> bpy.types.Material:
    """UV map, seams and the one material on the object."""
    mesh = obj.data
    blender_mesh.write_uv(mesh, arrays, layout.uv)
    blender_mesh.mark_seams(mesh, layout.seams)
    material = materials.make_material(obj, result, layout)
    mesh.materials.clear()
    materials.assign(obj, material)
    smooth = result.report["mesh"]["orientable"]  # elsewhere normals of faces that lie on their backs would mix
    mesh.polygons.foreach_set("use_smooth", np.full(len(mesh.polygons), smooth))
    mesh.update()
    return material


def _write_files(unwrapped: Unwrapped, output: Path) -> None:
    """All four files into a folder beside their places, then moved there."""
    with _folder_for(output) as part:
        stem = part / unwrapped.name
        _show_material()
        bpy.ops.wm.save_as_mainfile(filepath=str(stem.with_name(f"{stem.name}.blend")), copy=True, compress=True)
        report = json.dumps(unwrapped.report, indent=2, allow_nan=False)
        stem.with_name(f"{stem.name}.json").write_text(report + "\n", encoding="utf-8")
        unwrapped.result.save(stem.with_name(f"{stem.name}.npz"))
        render_picture(_subject(unwrapped), stem.with_name(f"{stem.name}.png"))
        for ending in ENDINGS:
            os.replace(part / f"{unwrapped.name}.{ending}", output / f"{unwrapped.name}.{ending}")


@contextmanager
def _folder_for(output: Path) -> Iterator[Path]:
    """A folder inside `output` for files in the making; when that fails, nothing that was not there before stays."""
    made = [folder for folder in (output, *output.parents) if not folder.exists()]
    try:
        output.mkdir(parents=True, exist_ok=True)
        part = Path(tempfile.mkdtemp(prefix=".orbifold-", dir=output)).resolve()
    except OSError as reason:
        raise RunError(f"{output}: cannot be written to ({reason.strerror})") from reason
    try:
        yield part
    except BaseException:
        shutil.rmtree(part, ignore_errors=True)
        for folder in made:
            folder.rmdir()
        raise
    shutil.rmtree(part)


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


def _show_material() -> None:
    """Whoever opens the .blend sees the material, not grey."""
    for screen in bpy.data.screens:
        for area in screen.areas:
            if area.type == "VIEW_3D":
                area.spaces.active.shading.type = "MATERIAL"


def _summary(unwrapped: Unwrapped, output: Path, seconds: float) -> list[str]:
    report = unwrapped.result.report
    cones = ", ".join(str(cone["vertex"]) for cone in report["orbifold"]["cones"]) or "none"
    files = ", ".join(str(output / f"{unwrapped.name}.{ending}") for ending in ENDINGS)
    return [
        f"{unwrapped.name}: {report['mesh']['vertices']} vertices onto {report['orbifold']['signature']} "
        f"({report['orbifold']['geometry']}), cones {cones}",
        *_suggested(unwrapped.placed.suggestion),
        f"certified: a bijection, {report['certificate']['flipped']} flipped triangles, mean quasi-conformal error "
        f"{report['distortion']['quasi_conformal_mean']:.3f}, area spread {report['distortion']['log_area_std']:.2f}",
        f"wrote {files} in {seconds:.1f} s",
        *unwrapped.remarks,
    ]


def _suggested(suggestion: Optional[core.Suggestion]) -> list[str]:
    if suggestion is None:
        return []
    how = "measured" if suggestion.measured else "predicted"
    return [f"the cones were suggested: {how} area spread {suggestion.predicted:.2f}"]


@contextmanager
def _quiet() -> Iterator[None]:
    """Keeps Blender's own chatter (imports, saves, render lines), some of it written by C code, off both streams."""
    sys.stdout.flush()
    sys.stderr.flush()
    kept = [os.dup(1), os.dup(2)]
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 1)
        os.dup2(nowhere, 2)
        yield
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os.dup2(kept[0], 1)
        os.dup2(kept[1], 2)
        for descriptor in (*kept, nowhere):
            os.close(descriptor)
