# SPDX-License-Identifier: GPL-3.0-or-later
"""Work that has to be done on Blender's own thread, step by step, with the interface of the library's jobs: so it has
progress and Esc like them."""

from __future__ import annotations

from collections.abc import Generator
from typing import Generic, Optional, TypeVar

from . import core

Made = TypeVar("Made")
Step = tuple[str, float]  # what is done next, and the fraction of all that is done


class Steps(Generic[Made]):
    """A generator that yields before each of its steps, and returns what it made."""

    def __init__(self, steps: Generator[Step, None, Made]) -> None:
        self._steps, self._at, self._over = steps, ("", 0.0), False
        self._made: Optional[Made] = None
        self._error: Optional[Exception] = None

    def poll(self) -> tuple[str, float, bool]:
        """Does the next step, then (stage, fraction in [0, 1], whether all is over)."""
        if not self._over:
            try:
                self._at = next(self._steps)
            except StopIteration as end:
                self._made, self._over = end.value, True
            except Exception as error:  # `finish` raises it
                self._error, self._over = error, True
        return (*self._at, self._over)

    def cancel(self) -> None:
        self._steps.close()
        self._error, self._over = core.OrbifoldError("ORB_CANCELLED", "cancelled"), True

    def finish(self) -> Made:
        """Does the rest: what was made, or what a step raised; ORB_CANCELLED after `cancel`."""
        while not self._over:
            self.poll()
        if self._error is not None:
            raise self._error
        return self._made


def part_of(first: float, last: float, steps: Generator[Step, None, Made]) -> Generator[Step, None, Made]:
    """Steps that are some of more: their fractions of the whole are from `first` to `last`."""
    while True:
        try:
            stage, fraction = next(steps)
        except StopIteration as end:
            return end.value
        yield stage, first + fraction * (last - first)
