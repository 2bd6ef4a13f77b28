# SPDX-License-Identifier: GPL-3.0-or-later
"""In a real window, on a virtual screen: a new user's clicks and keys from the zip to a file that is opened again
(inside/new_user.py); F3 (inside/searching_window.py); suggestions (inside/suggesting_window.py); a transfer
(inside/transferring_window.py); what is drawn, and Orbifold Live by keys (inside/seeing_window.py); strokes of the
brush (inside/painting_window.py). Judged by what the scripts write; needs xvfb and imagemagick.

    ORBIFOLD_SCREENSHOTS    a folder for pictures of the screen"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest
from conftest import INSIDE, Home, blender_path, zip_path

LIMIT = 600


@pytest.fixture(scope="module")
def used(tmp_path_factory: pytest.TempPathFactory) -> dict:
    blender, package = blender_path(), zip_path()
    if blender is None or package is None:
        pytest.skip("there is no blender, or no package: run `./build.sh package`")
    return in_window(Home(tmp_path_factory.mktemp("new"), blender), "new_user.py", str(package))


@pytest.fixture(scope="module")
def suggested(home: Home) -> dict:
    return in_window(home, "suggesting_window.py")


@pytest.fixture(scope="module")
def transferred(home: Home) -> dict:
    return in_window(home, "transferring_window.py")


@pytest.fixture(scope="module")
def searched(home: Home) -> dict:
    return in_window(home, "searching_window.py")


@pytest.fixture(scope="module")
def shown(home: Home) -> dict:
    return in_window(home, "seeing_window.py")


@pytest.fixture(scope="module")
def painted(home: Home) -> dict:
    return in_window(home, "painting_window.py")


def in_window(home: Home, script: str, *more: str) -> dict:
    """What a script has seen."""
    if shutil.which("xvfb-run") is None or shutil.which("xauth") is None:
        pytest.skip("there is no xvfb-run with xauth for a window: apt-get install xvfb xauth")
    if shutil.which("import") is None:
        pytest.skip("there is no import to look at the screen with: apt-get install imagemagick")
    out, folder = home.folder / f"{script}.json", os.environ.get("ORBIFOLD_SCREENSHOTS")
    if folder:
        Path(folder).mkdir(parents=True, exist_ok=True)
    pictures = "-" if not folder else str(Path(folder) / Path(script).stem)
    command = ["xvfb-run", "-a", "-s", "-screen 0 1280x900x24 +extension GLX", home.blender, "--factory-startup"]
    command += ["--enable-event-simulate", "--window-geometry", "0", "0", "1280", "900"]
    command += ["--python", str(INSIDE / script), "--", *more, pictures, str(out)]
    environment = {**home.environment, "LIBGL_ALWAYS_SOFTWARE": "1"}
    done = subprocess.run(
        command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=LIMIT
    )
    assert out.exists(), done.stdout[-3000:]
    found = json.loads(out.read_text(encoding="utf-8"))
    assert found.get("finished"), found.get("error")
    return found


def test_the_zip_is_installed_and_enabled(used: dict) -> None:
    assert used["enabled"]


def test_vertices_that_are_clicked_become_cones_in_that_order(used: dict) -> None:
    assert len(used["picks"]) == 4 and used["cones"] == [[vertex, 2] for vertex in used["picks"]]


def test_the_button_unwraps_in_edit_mode_and_reports_the_certificate(used: dict) -> None:
    assert used["mode"] == "EDIT"
    assert [line for line in used["report"] if "Orbifold 2222 (euclidean): a bijection, certified" in line]
    assert used["redo_panel"] == "UV_OT_orbifold_unwrap"


def test_one_undo_takes_the_unwrap_back_and_one_redo_brings_it_again(used: dict) -> None:
    assert used["cones_stay"] and used["redone"]


def test_it_is_found_by_search(used: dict) -> None:
    assert used["searched"] == "UV_OT_orbifold_unwrap"


def test_every_operator_is_found_by_search(searched: dict) -> None:
    assert searched["found"] == {name: name for name in searched["wanted"]}


def test_escape_on_a_large_mesh_changes_nothing_and_it_can_be_started_again(used: dict) -> None:
    assert used["vertices"] > 100_000
    assert used["uv_kept"] and used["uv_new"]


def test_a_saved_file_has_the_uv_map_cones_and_settings(used: dict) -> None:
    assert used["reopened"] == [True, True, True, "2222", "Face", False]


def test_suggestions_come_modally_and_a_row_is_placed_in_edit_mode(suggested: dict) -> None:
    assert suggested["invoked_suggest"] == ["RUNNING_MODAL"]
    assert suggested["mode_after_suggest"] == "EDIT"
    assert suggested["placed"] == [1, True]
    assert suggested["after_undo"] == [0, ""]


def test_one_click_suggests_and_unwraps_in_one_step(suggested: dict) -> None:
    assert suggested["invoked_bare"] == ["RUNNING_MODAL"]
    assert suggested["cones_of_one_click"] >= 2
    assert suggested["after_one_undo"] == [0, 0, ""]


def test_escape_ends_suggesting(suggested: dict) -> None:
    assert suggested["invoked_suggest_large"] == ["RUNNING_MODAL"]
    assert suggested["rows_after_esc"] == 0


def test_a_transfer_is_modal_and_one_undo_step(transferred: dict) -> None:
    assert transferred["invoked"] == ["RUNNING_MODAL"]
    assert transferred["groups_after_one_undo"] == 0


def test_escape_ends_a_transfer_between_two_portions_of_an_image(transferred: dict) -> None:
    assert transferred["invoked_texture"] == ["RUNNING_MODAL"]
    assert transferred["portions_before_esc"] >= 1 and transferred["portions_after_esc"] == 0
    assert transferred["groups_after_esc"] == 0 and transferred["images_after_esc"] == ["Large"]


def test_cones_and_cut_are_drawn_and_can_be_switched_off(shown: dict) -> None:
    assert shown["drawn_and_not_drawn"]


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


def test_a_stroke_on_the_mesh_is_repeated_at_its_copies(painted: dict) -> None:
    assert min(painted["changed"]) > 500 and painted["turned"] == [True, True]
    assert painted["symmetric"] and painted["problem"] is None


def test_one_undo_takes_a_stroke_and_its_copies_back_and_one_redo_brings_them_again(painted: dict) -> None:
    assert painted["undone"] == [[1], [1], [0], [1], [1], [2]]  # in the middle the undo step of a setting


def test_a_stroke_on_the_image_is_repeated_and_undone(painted: dict) -> None:
    assert painted["on_image"][0] > 500 and painted["on_image"][1] and painted["on_image_undone"]


def test_strokes_and_undos_that_follow_at_once(painted: dict) -> None:
    assert painted["hasty"] == [True, True] and painted["hasty_undone"] and painted["hasty_undone_all"]


def test_symmetrize_image_is_undone_at_once_in_paint_mode_and_in_object_mode(painted: dict) -> None:
    assert painted["not_repeated"]
    assert painted["symmetrized_TEXTURE_PAINT"] == painted["symmetrized_OBJECT"] == [True, True, True]


def test_another_file_switches_symmetric_painting_off(painted: dict) -> None:
    assert painted["after_loading"] == [False, 0]
