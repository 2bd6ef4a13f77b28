# SPDX-License-Identifier: GPL-3.0-or-later
"""In a real window, on a virtual screen: the modal operator, Esc, undo (inside/window.py). Judged by what the script
writes; needs xvfb."""

from __future__ import annotations

import json
import shutil
import subprocess

import pytest
from conftest import INSIDE, Home

LIMIT = 600


@pytest.fixture(scope="module")
def seen(home: Home) -> dict:
    if shutil.which("xvfb-run") is None or shutil.which("xauth") is None:
        pytest.skip("there is no xvfb-run with xauth for a window: apt-get install xvfb xauth")
    out = home.folder / "window.json"
    command = ["xvfb-run", "-a", "-s", "-screen 0 1280x900x24 +extension GLX", home.blender, "--factory-startup"]
    command += ["--enable-event-simulate", "--window-geometry", "0", "0", "1280", "900"]
    command += ["--python", str(INSIDE / "window.py"), "--", "-", str(out)]
    environment = {**home.environment, "LIBGL_ALWAYS_SOFTWARE": "1"}
    done = subprocess.run(
        command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=LIMIT
    )
    assert out.exists(), done.stdout[-3000:]
    found = json.loads(out.read_text(encoding="utf-8"))
    assert found.get("finished"), found.get("error")
    return found


def test_unwrap_runs_modally_and_writes_its_result_in_edit_mode(seen: dict) -> None:
    assert seen["invoked"] == ["RUNNING_MODAL"]
    assert seen["mode"] == "EDIT"
    assert "Orbifold Sphere" in seen["shape_keys"]


def test_one_undo_takes_it_back(seen: dict) -> None:
    assert seen["uv_after_undo"] == []
    assert seen["cones_after_undo"] == [4, 3, 2]


def test_suggestions_come_modally_and_a_row_is_placed_in_edit_mode(seen: dict) -> None:
    assert seen["invoked_suggest"] == ["RUNNING_MODAL"]
    assert seen["mode_after_suggest"] == "EDIT"
    assert seen["placed"] == [1, True]
    assert seen["after_undo"] == [0, ""]


def test_one_click_suggests_and_unwraps_in_one_step(seen: dict) -> None:
    assert seen["invoked_bare"] == ["RUNNING_MODAL"]
    assert seen["cones_of_one_click"] >= 2
    assert seen["after_one_undo"] == [0, 0, ""]


def test_escape_ends_suggesting(seen: dict) -> None:
    assert seen["invoked_suggest_large"] == ["RUNNING_MODAL"]
    assert seen["rows_after_esc"] == 0


def test_escape_ends_it_and_changes_nothing(seen: dict) -> None:
    assert seen["invoked_large"] == ["RUNNING_MODAL"]
    assert seen["uv_after_esc"] == []


def test_it_can_be_started_again_after_escape(seen: dict) -> None:
    assert seen["invoked_again"] == ["RUNNING_MODAL"]
