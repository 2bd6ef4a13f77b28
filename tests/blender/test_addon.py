# SPDX-License-Identifier: GPL-3.0-or-later
"""The installed add-on, check by check (inside/*.py, conftest.py)."""

from __future__ import annotations

import re
import subprocess
import zipfile
from pathlib import Path

import pytest
from conftest import Home, checks_of, zip_path
from test_run import open_sphere, sphere_mesh, write_obj

SCRIPTS = (
    "registration.py", "picking.py", "unwrapping.py", "orbifolds.py", "suggesting.py", "seeing.py", "bad_input.py",
    "checking.py", "objects.py", "transferring.py", "cutting.py", "painting.py", "patterns.py",
)


@pytest.mark.parametrize("script, check", [(script, check) for script in SCRIPTS for check in checks_of(script)])
def test_in_blender(run_check, script: str, check: str) -> None:
    run_check(script, check)


def test_the_zip_is_one_folder_without_caches() -> None:
    package = zip_path()
    if package is None:
        pytest.skip("there is no package: run `./build.sh package`")
    names = zipfile.ZipFile(package).namelist()
    assert all(name.startswith("orbifold_uv/") for name in names)
    assert not [name for name in names if "__pycache__" in name or name.endswith((".pyc", ".blend1"))]


def test_the_command_of_the_installed_add_on(home: Home, tmp_path: Path) -> None:
    """`blender --command orbifold`: the same words, lines and status as run.py; from Blender 4.2 on."""
    version = subprocess.run([home.blender, "--version"], capture_output=True, text=True).stdout
    if tuple(map(int, re.search(r"(\d+)\.(\d+)", version).groups())) < (4, 2):
        pytest.skip("this Blender has no --command")
    meshes = [write_obj(tmp_path / "a.obj", *sphere_mesh()), write_obj(tmp_path / "b.obj", *open_sphere())]
    module = "bl_ext.user_default.orbifold_uv"
    command = [home.blender, "--factory-startup", "--addons", module, "--command", "orbifold"]
    other = write_obj(tmp_path / "c.obj", *sphere_mesh())
    to_other = ["--cones", "0,100,250", "--map-to", other, "--map-cones", "0,100,250", "--transfer", "heat"]
    for words, status in ((meshes[:1], 0), (meshes, 1), ([meshes[0], *to_other], 0)):
        options = ["--orbifold", "442", "--files", "blend,json", "--output", str(tmp_path / "out")]
        done = subprocess.run([*command, *map(str, words), *options], capture_output=True, text=True, timeout=300,
                              env=home.environment)
        assert done.returncode == status, done.stdout + done.stderr
        assert (tmp_path / "out" / "a.json").is_file()
        assert ("orbifold error: 1 of 2 meshes failed: b.obj" in done.stderr) == (status == 1), done.stderr
        assert ("1 of 2 meshes done" in done.stdout) == (status == 1)
    assert (tmp_path / "out" / "c.blend").is_file()
