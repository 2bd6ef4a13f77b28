# SPDX-License-Identifier: GPL-3.0-or-later
"""How a run ends: files that appear all or not at all, one line for what went wrong, and nothing else said."""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import bpy

from .. import blender_mesh, core
from .arguments import Arguments
from .errors import RunError

EXPECTED = (RunError, core.OrbifoldError, core.MeshFileError, blender_mesh.BlenderMeshError)


@dataclass(frozen=True)
class Figures:
    """Of a job that went well, for the table."""

    signature: str
    cones: list[int]  # vertices
    flipped: int
    quasi_conformal_mean: float
    log_area_std: float


def one_line(reason: BaseException) -> str:
    return " ".join(str(reason).split()) or type(reason).__name__


def fault(reason: BaseException) -> str:
    """A fault of ours, with its place."""
    trace = reason.__traceback__
    while trace.tb_next is not None:
        trace = trace.tb_next
    where = f"{Path(trace.tb_frame.f_code.co_filename).name}:{trace.tb_lineno}"
    return f"internal fault in {where}: {type(reason).__name__}: {one_line(reason)}"


@contextmanager
def folder_for(output: Path) -> Iterator[Path]:
    """A folder beside their places for files in the making, which are moved to `output` at the end; when that fails,
    nothing that was not there before stays."""
    made = [folder for folder in (output, *output.parents) if not folder.exists()]
    try:
        output.mkdir(parents=True, exist_ok=True)
        part = Path(tempfile.mkdtemp(prefix=".orbifold-", dir=output)).resolve()
    except OSError as reason:
        raise RunError(f"{output}: cannot be written to ({reason.strerror})") from reason
    try:
        yield part
        for path in sorted(part.iterdir()):
            os.replace(path, output / path.name)
    except BaseException:
        shutil.rmtree(part, ignore_errors=True)
        for folder in made:
            folder.rmdir()
        raise
    shutil.rmtree(part)


def show_material() -> None:
    """Whoever opens the .blend sees the material, not grey."""
    for screen in bpy.data.screens:
        for area in screen.areas:
            if area.type == "VIEW_3D":
                area.spaces.active.shading.type = "MATERIAL"


def written(arguments: Arguments, seconds: float) -> str:
    """The line that names the files."""
    mesh = arguments.map_to or arguments.mesh
    names = [f"{arguments.name}.{ending}" for ending in arguments.files]
    if arguments.export and mesh.name not in names:
        names.append(mesh.name)
    files = ", ".join(str(arguments.output / name) for name in names) or "nothing"
    return f"wrote {files} in {seconds:.1f} s"


@contextmanager
def quiet() -> Iterator[None]:
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
