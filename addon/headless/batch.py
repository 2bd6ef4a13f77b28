# SPDX-License-Identifier: GPL-3.0-or-later
"""Many meshes in one Blender, one after the other: those that fail are listed, and do not stop the others."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Optional

from .arguments import Arguments, Request
from .errors import RunError
from .importers import MESH_ENDINGS
from .joblist import jobs_of
from .mapping import Kept
from .output import EXPECTED, Figures, fault, one_line
from .progress import Progress, terminal
from .session import run_one

HEADINGS = ("mesh", "signature", "cones", "flipped", "mean quasi-conformal", "area spread", "seconds")
NUMBERS = ("flipped", "mean quasi-conformal", "area spread", "seconds")  # aligned to the right
CONES_SHOWN = 4


@dataclass(frozen=True)
class Row:
    """Of the table."""

    mesh: str
    seconds: float
    figures: Optional[Figures]  # None: failed
    error: str = ""

    def cells(self) -> tuple[str, ...]:
        figures = self.figures
        cones = [str(vertex) for vertex in figures.cones]
        more = f" ... ({len(cones)})" if len(cones) > CONES_SHOWN else ""
        return (
            self.mesh, figures.signature, " ".join(cones[:CONES_SHOWN]) + more or "none", str(figures.flipped),
            f"{figures.quasi_conformal_mean:.3f}", f"{figures.log_area_std:.2f}", f"{self.seconds:.1f}",
        )


@dataclass(frozen=True)
class Batch:
    rows: list[Row]

    @property
    def failed(self) -> list[Row]:
        return [row for row in self.rows if row.figures is None]

    def table(self) -> list[str]:
        """Lines; errors take the place of all columns but the first."""
        done = [row.cells() for row in self.rows if row.figures is not None]
        widths = [max(map(len, column)) for column in zip(HEADINGS, *done)]
        widths[0] = max(widths[0], *(len(row.mesh) for row in self.rows))
        lines = [_line(HEADINGS, widths), "  ".join("-" * width for width in widths)]
        for row in self.rows:
            if row.figures is not None:
                lines.append(_line(row.cells(), widths))
            else:
                lines.append(f"{row.mesh:{widths[0]}}  failed: {row.error}")
        total = sum(row.seconds for row in self.rows)
        lines.append(f"{len(self.rows) - len(self.failed)} of {len(self.rows)} meshes done in {total:.1f} s")
        return lines

    def complaint(self) -> str:
        """What failed, in one line; empty: nothing."""
        if not self.failed:
            return ""
        named = "; ".join(f"{row.mesh} ({row.error})" for row in self.failed)
        return f"{len(self.failed)} of {len(self.rows)} meshes failed: {named}"


def run_batch(request: Request) -> Batch:
    """RunError where there is nothing to be done at all."""
    jobs = jobs_of(request, MESH_ENDINGS)
    progress = Progress(len(jobs), terminal())
    rows, kept = [], Kept()
    try:
        for job in jobs:
            rows.append(_run_job(job, progress, kept))
    finally:
        progress.close()
    return Batch(rows)


def _run_job(job: Arguments | tuple[str, RunError], progress: Progress, kept: Kept) -> Row:
    started = time.perf_counter()
    figures, error = None, ""
    title = job.title if isinstance(job, Arguments) else job[0]
    progress.begin(title)
    try:
        if not isinstance(job, Arguments):
            raise job[1]
        figures = run_one(job, progress.stage, kept).figures
    except EXPECTED as reason:
        error = one_line(reason)
    except Exception as reason:  # a fault of ours with one mesh is no reason to leave out the others
        error = fault(reason)
    if isinstance(job, Arguments) and job.mesh is not None:
        error = error.removeprefix(f"{job.mesh}: ").removeprefix(f"{job.mesh.resolve()}: ")
    row = Row(title, time.perf_counter() - started, figures, error)
    if figures is None:
        progress.end(f"{row.mesh}: failed: {error}", True)
    else:
        _, signature, cones, flipped, mean, spread, seconds = row.cells()
        progress.end(f"{row.mesh}: {signature}, cones {cones}, {flipped} flipped, mean quasi-conformal error {mean}, "
                     f"area spread {spread}, {seconds} s", False)
    return row


def _line(cells: Sequence[str], widths: Sequence[int]) -> str:
    aligned = (f"{cell:>{width}}" if name in NUMBERS else f"{cell:{width}}"
               for name, cell, width in zip(HEADINGS, cells, widths))
    return "  ".join(aligned).rstrip()
