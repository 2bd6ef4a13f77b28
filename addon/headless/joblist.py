# SPDX-License-Identifier: GPL-3.0-or-later
"""Which meshes a batch is to do, each with its own arguments: from files, folders and lists of jobs."""

from __future__ import annotations

import csv
import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Optional, Union

from .arguments import OPTIONS, Arguments, Request
from .errors import RunError

COLUMNS = ("mesh", *OPTIONS)


def jobs_of(request: Request, endings: Sequence[str]) -> list[Union[Arguments, tuple[str, RunError]]]:
    """In the sequence of the command line, the list last; for a row that cannot be done its title and the reason.
    `endings` are those of mesh files, which are looked for in folders."""
    jobs: list[Union[Arguments, tuple[str, RunError]]] = []
    for mesh in request.meshes or ([None] if request.jobs is None else []):
        files = _meshes_in(mesh, endings) if mesh is not None and mesh.is_dir() else [mesh]
        jobs += [replace(request.arguments, mesh=file) for file in files]
    if request.jobs is not None:
        jobs += [_job(request.arguments, row, request.jobs.parent) for row in read_rows(request.jobs)]
    if not jobs:
        raise RunError(f"{request.jobs}: there is no job in the list")
    return _without_clashes([one for job in jobs for one in _with_targets(job, request.targets, endings)])


def _with_targets(
    job: Union[Arguments, tuple[str, RunError]], targets: Sequence[tuple[Path, Optional[tuple[int, ...]]]],
    endings: Sequence[str],
) -> list[Union[Arguments, tuple[str, RunError]]]:
    """A job for each target; in a folder the source is none. A row of a list that names its own has only that."""
    if not isinstance(job, Arguments):
        return [job]
    if job.map_to is not None:
        targets = [(job.map_to, job.map_cones)]
    if not targets:
        return [job]
    found = []
    for target, cones in targets:
        files = [target]
        if target.is_dir():
            source = job.mesh.resolve() if job.mesh is not None else None
            files = [file for file in _meshes_in(target, endings) if file.resolve() != source]
        found += [replace(job, map_to=file, map_cones=cones) for file in files]
    return found


def _meshes_in(folder: Path, endings: Sequence[str]) -> list[Path]:
    found = sorted(path for path in folder.iterdir() if path.suffix.lower() in endings and path.is_file())
    if not found:
        raise RunError(f"{folder}: no mesh file in this folder ({' '.join(endings)})")
    return found


def read_rows(path: Path) -> list[dict[str, str]]:
    """The rows of a list, what is empty left out."""
    readers = {".csv": _read_csv, ".json": _read_json}
    if path.suffix.lower() not in readers:
        raise RunError(f"{path}: a list of jobs is a .csv or a .json file")
    try:
        rows = readers[path.suffix.lower()](path.read_text(encoding="utf-8-sig"))
    except OSError as reason:
        raise RunError(f"{path}: cannot be read ({reason.strerror})") from reason
    except (ValueError, csv.Error) as reason:
        raise RunError(f"{path}: cannot be read ({reason})") from reason
    for number, row in enumerate(rows, start=1):
        unknown = [str(name) for name in row if name not in COLUMNS]
        if unknown:
            raise RunError(f"{path}: there is no column {unknown[0]}; there are {', '.join(COLUMNS)}")
        if not row.get("mesh"):
            raise RunError(f"{path}: job {number} names no mesh")
    return rows


def _read_csv(text: str) -> list[dict[str, str]]:
    rows = []
    for row in csv.DictReader(text.splitlines(), skipinitialspace=True, restkey="(more cells than columns)"):
        cells = {(name or "").strip(): cell for name, cell in row.items()}
        rows.append({name: cell.strip() if isinstance(cell, str) else "" for name, cell in cells.items()
                     if not isinstance(cell, str) or cell.strip()})
    return [{name: cell for name, cell in row.items() if cell or name not in COLUMNS} for row in rows if row]


def _read_json(text: str) -> list[dict[str, str]]:
    read = json.loads(text)
    if not isinstance(read, list) or not all(isinstance(row, dict) for row in read):
        raise ValueError("it is no list of objects, such as [{\"mesh\": \"cow.obj\"}]")
    return [{name: _as_text(value) for name, value in row.items() if value is not None} for row in read]


def _as_text(value: object) -> str:
    if isinstance(value, list):
        return ",".join(map(_as_text, value))
    return str(value).lower() if isinstance(value, bool) else str(value)


def _job(base: Arguments, row: dict[str, str], folder: Path) -> Union[Arguments, tuple[str, RunError]]:
    mesh = folder / row["mesh"]
    values = {name: text for name, text in row.items() if text}
    for name in ("cones", "orders", "map-cones", "transfer"):  # with spaces instead no quotes are needed in a .csv
        if name in values:
            values[name] = ",".join(values[name].replace(",", " ").split())
    try:
        job = base.with_values(values)
    except RunError as reason:
        return mesh.name, reason
    output = folder / job.output if "output" in values else job.output
    map_to = folder / job.map_to if "map-to" in values else job.map_to
    return replace(job, mesh=mesh, output=output, map_to=map_to)


def _without_clashes(
    jobs: Sequence[Union[Arguments, tuple[str, RunError]]]
) -> list[Union[Arguments, tuple[str, RunError]]]:
    """Of jobs that would write the same files only the first is done, and none that would write over its own mesh."""
    taken: dict[Path, Arguments] = {}
    checked: list[Union[Arguments, tuple[str, RunError]]] = []
    for job in jobs:
        if isinstance(job, Arguments):
            place = job.output.resolve() / job.name
            first = taken.setdefault(place, job)
            reason = ""
            if first is not job:
                reason = f"{first.mesh if first.map_to is None else first.title} writes the same files; give the two " \
                         "different outputs"
            elif job.map_to is None and "blend" in job.files and \
                    place.with_name(f"{place.name}.blend") == job.mesh.resolve():
                reason = "its result would be written over it; choose another folder with --output"
            if reason:
                job = (job.title, RunError(reason))
        checked.append(job)
    return checked
