# SPDX-License-Identifier: GPL-3.0-or-later
"""In a real window, on a virtual screen: the modal operator, Esc, undo (inside/window.py); what is drawn, and Orbifold
Live by keys (inside/seeing_window.py). Judged by what the scripts write; needs xvfb."""

from __future__ import annotations

import json
import shutil
import subprocess

import pytest
from conftest import INSIDE, Home

LIMIT = 600


@pytest.fixture(scope="module")
def seen(home: Home) -> dict:
    return in_window(home, "window.py")


@pytest.fixture(scope="module")
def shown(home: Home) -> dict:
    if shutil.which("import") is None:
        pytest.skip("there is no import to look at the screen with: apt-get install imagemagick")
    return in_window(home, "seeing_window.py")


def in_window(home: Home, script: str) -> dict:
    """What a script has seen."""
    if shutil.which("xvfb-run") is None or shutil.which("xauth") is None:
        pytest.skip("there is no xvfb-run with xauth for a window: apt-get install xvfb xauth")
    out = home.folder / f"{script}.json"
    command = ["xvfb-run", "-a", "-s", "-screen 0 1280x900x24 +extension GLX", home.blender, "--factory-startup"]
    command += ["--enable-event-simulate", "--window-geometry", "0", "0", "1280", "900"]
    command += ["--python", str(INSIDE / script), "--", "-", str(out)]
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


def test_cones_and_cut_are_drawn_and_can_be_switched_off(shown: dict) -> None:
    assert min(shown["cone_pixels"]) > 30 and min(shown["cut_pixels"]) > 200
    assert max(shown["pixels_when_off"]) < 20


def test_a_heat_map_switches_the_view_s_colours_and_switches_them_back(shown: dict) -> None:
    assert shown["shading"] == ["MATERIAL", "VERTEX", "MATERIAL"]


def test_arrow_keys_move_a_cone_and_the_uvs_follow(shown: dict) -> None:
    assert shown["invoked"] == ["RUNNING_MODAL"]
    assert shown["cone_moved"] and shown["uv_changed"] > 1e-4 and shown["problems"] == []


def test_each_move_is_undone_in_one_step(shown: dict) -> None:
    assert shown["cone_after_undo"] and shown["uv_after_undo"] < 1e-6


def test_an_impossible_signature_is_explained_and_keeps_the_uvs(shown: dict) -> None:
    reason, change = shown["impossible"]
    assert "44" in reason and change < 1e-6
    assert shown["possible_again"] is None
