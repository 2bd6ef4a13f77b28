# SPDX-License-Identifier: GPL-3.0-or-later
"""The command from its words to the exit status, as run.py calls it and `blender --command orbifold`.

Lines for the user begin with "orbifold: " on stdout, and the one that says why the status is 1 with "orbifold error: "
on stderr: Blender writes much else on both."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from .arguments import HelpWanted, read_request
from .batch import run_batch
from .output import EXPECTED, fault, one_line
from .session import run


def main(words: Sequence[str]) -> int:
    try:
        lines, complaint = _run(words)
    except EXPECTED as reason:
        lines, complaint = [], one_line(reason)
    except Exception as reason:  # a fault of ours: still one line, but with the place
        lines, complaint = [], fault(reason)
    for line in lines:
        print(f"orbifold: {line}", flush=True)
    if complaint:
        sys.stdout.flush()
        sys.stderr.write(f"orbifold error: {complaint}\n")
        sys.stderr.flush()
    return 1 if complaint else 0


def _run(words: Sequence[str]) -> tuple[list[str], str]:
    """What to tell the user, and what went wrong."""
    try:
        request = read_request(words)
    except HelpWanted as text:
        return str(text).splitlines(), ""
    if not request.is_batch:
        return run(request.arguments), ""
    batch = run_batch(request)
    return batch.table(), batch.complaint()
