# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a batch is: a bar on a terminal, a line for each mesh elsewhere. Both are written past session.quiet, which
sends all that Blender says to nowhere.

`./build.sh run` filters what Blender writes, so that stdout is no terminal here: it names the terminal in
ORBIFOLD_TERMINAL."""

from __future__ import annotations

import os
import sys
import time
from typing import TextIO

WIDTH = 24
INTERVAL = 0.1  # seconds between two drawings


def terminal() -> TextIO | None:
    """A stream of its own to the terminal; None: there is none."""
    named = os.environ.get("ORBIFOLD_TERMINAL")
    try:
        if named:
            return open(named, "w", encoding="utf-8")
        return os.fdopen(os.dup(1), "w", encoding="utf-8") if os.isatty(1) else None
    except OSError:
        return None


class Progress:
    def __init__(self, count: int, screen: TextIO | None) -> None:
        self._count, self._screen, self._drawn = count, screen, 0.0
        self._lines = None if screen is not None else os.fdopen(os.dup(1), "w", encoding="utf-8")
        self._done, self._failed, self._name = 0, 0, ""

    def begin(self, name: str) -> None:
        self._name = name
        self._draw("reading", 0.0)

    def stage(self, stage: str, fraction: float) -> None:
        """Called by the library every few milliseconds."""
        if time.monotonic() - self._drawn > INTERVAL:
            self._draw(stage, fraction)

    def end(self, line: str, failed: bool) -> None:
        self._done, self._failed = self._done + 1, self._failed + failed
        if self._lines is not None:
            sys.stdout.flush()
            self._lines.write(f"orbifold: {self._done}/{self._count} {line}\n")
            self._lines.flush()

    def close(self) -> None:
        if self._screen is not None:
            self._screen.write("\r\033[K")
            self._screen.close()
        if self._lines is not None:
            self._lines.close()

    def _draw(self, stage: str, fraction: float) -> None:
        if self._screen is None:
            return
        self._drawn = time.monotonic()
        filled = int(WIDTH * (self._done + min(max(fraction, 0.0), 1.0)) / self._count)
        failed = f", {self._failed} failed" if self._failed else ""
        text = f"[{'#' * filled:-<{WIDTH}}] {self._done}/{self._count}{failed}  {self._name}: {stage}"
        self._screen.write(f"\r\033[K{text[:100]}")
        self._screen.flush()
