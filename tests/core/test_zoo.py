# SPDX-License-Identifier: GPL-3.0-or-later
"""Every animal of the zoo ends certified, and the judge agrees, or with an error that is clear; none crashes or hangs."""

from multiprocessing import get_context

import pytest
import zoo
from conftest import CHECKOUT
from judged import judge_without_weights, verdict
from meshes import CHECK_LAYOUT

PARTS, EACH = 6, 110
PATIENCE = 600  # seconds for a part that takes a few
PRECISION = {"slivers", "caps", "valence 1,000"}  # what doubles may be too coarse for


def tried(seed, folder):
    """What went wrong in one part, as texts; in a process of its own, which may crash."""
    wrong = []
    for number, (kind, mesh, signature, picks, settings) in enumerate(zoo.cases(EACH, seed)):
        kept = [array.copy() for array in mesh]
        status, found = zoo.outcome(mesh, signature, picks, settings)
        why = None
        if status != "ok":
            why = zoo.complaint(found, mesh)
            if kind == "as it is" and status != "ORB_BAD_ORBIFOLD":
                why = "a good mesh is refused"
            elif status in ("ORB_CERTIFICATE_FAILED", "ORB_NOT_CONVERGED") and kind not in PRECISION:
                why = "it was not embedded"
        elif CHECK_LAYOUT.is_file():
            said = (verdict if found.weights is not None else judge_without_weights)(found, folder)
            why = None if said["ok"] else said["why"]
        if any(array.tobytes() != own.tobytes() for array, own in zip(mesh, kept)):
            why = "the arrays have changed"
        if why:
            wrong.append(f"{number}, {kind}, {signature} {picks} {settings}: {status} {found}: {why}")
    return wrong


@pytest.mark.parametrize("seed", range(PARTS))
def test_a_part_of_the_zoo(seed, tmp_path):
    with get_context("spawn").Pool(1) as pool:
        assert pool.apply_async(tried, (seed, tmp_path)).get(PATIENCE) == []


def test_the_page_has_all_kinds():
    page = (CHECKOUT / "docs" / "zoo.md").read_text(encoding="utf-8")
    assert [kind for kind in zoo.SPOILT if f"| {kind} |" not in page] == []
