# SPDX-License-Identifier: GPL-3.0-or-later
"""Computations on the library's own thread: to poll, as a modal operator does, or to wait for."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable
from typing import Generic, TypeVar

from . import binding
from .errors import OrbifoldError

Progress = Callable[[str, float], object]
Made = TypeVar("Made")


class Job(Generic[Made]):
    """Drop it at any time: it is cancelled."""

    def __init__(self, job: binding.Job, made: Callable[[object], Made]) -> None:
        self._job, self._made = job, made

    def poll(self) -> tuple[str, float, bool]:
        """(stage, fraction in [0, 1], whether it is over); returns at once."""
        return self._job.poll()

    def cancel(self) -> None:
        """`finish` then raises ORB_CANCELLED at once, at any size of mesh."""
        self._job.cancel()

    def finish(self) -> Made:
        """Waits for the end, once only: what was computed, or OrbifoldError."""
        return self._made(self._job.finish())


def wait_for(job: Job[Made], progress: Progress | None) -> Made:
    """Polls every few milliseconds and tells `progress`, which cancels by returning False or raising."""
    pause = 0.001
    try:
        over = False
        while not over:
            stage, fraction, over = job.poll()
            if progress is not None and progress(stage, fraction) is False:
                job.cancel()
                break
            if not over:
                time.sleep(pause)
                pause = min(2 * pause, 0.02)
    except BaseException:  # also an interrupt from the keyboard
        job.cancel()
        with contextlib.suppress(OrbifoldError):
            job.finish()
        raise
    return job.finish()
