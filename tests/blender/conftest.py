# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs scripts in a real Blender in which the built zip, not the checkout, is installed.

A script in inside/ defines checks, functions named `check_...`, which run in the sequence of the file and share its
globals; Blender is started once a script, and each check is one pytest test.

    ORBIFOLD_BLENDER   the Blender to use; without it `blender`
    ORBIFOLD_ZIP       the zip of `./build.sh package`; without it the newest one in build/
"""

from __future__ import annotations

import ast
import json
import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

INSIDE = Path(__file__).parent / "inside"
ROOT = Path(__file__).parents[2]
LIMIT = 600  # seconds for one script


def blender_path() -> str | None:
    return shutil.which(os.environ.get("ORBIFOLD_BLENDER") or "blender")


def zip_path() -> Path | None:
    if os.environ.get("ORBIFOLD_ZIP"):
        return Path(os.environ["ORBIFOLD_ZIP"])
    built = sorted((ROOT / "build").glob("orbifold_uv-*.zip"), key=lambda path: path.stat().st_mtime)
    return built[-1] if built else None


def checks_of(script: str) -> list[str]:
    tree = ast.parse((INSIDE / script).read_text(encoding="utf-8"))
    return [node.name for node in tree.body if isinstance(node, ast.FunctionDef) and node.name.startswith("check_")]


class Home:
    """A Blender with a home of its own, in which the zip is installed."""

    def __init__(self, folder: Path, blender: str) -> None:
        self.folder, self.blender = folder, blender
        self.environment = {
            **os.environ,
            "BLENDER_USER_CONFIG": str(folder / "config"),
            "BLENDER_USER_SCRIPTS": str(folder / "scripts"),
            "BLENDER_USER_EXTENSIONS": str(folder / "extensions"),
            "PYTHONDONTWRITEBYTECODE": "1",
        }
        for name in ("config", "scripts/addons", "extensions"):
            (folder / name).mkdir(parents=True)
        self._results: dict[str, dict[str, str | None]] = {}

    def run(self, script: str, *arguments: str) -> subprocess.CompletedProcess[str]:
        command = [self.blender, "--background", "--factory-startup", "--python-exit-code", "1"]
        command += ["--python", str(INSIDE / script), "--", *arguments]
        return subprocess.run(
            command, env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=LIMIT
        )

    def results(self, script: str) -> dict[str, str | None]:
        """name of each check that ran -> what went wrong, or None. Blender is started at the first call."""
        if script not in self._results:
            out = self.folder / f"{script}.json"
            try:
                done = self.run(script, str(out))
                end = f"Blender ended with status {done.returncode}:\n{done.stdout[-3000:]}"
            except subprocess.TimeoutExpired:  # for all checks: none of them waits again
                end = f"Blender did not end within {LIMIT} seconds"
            found = json.loads(out.read_text(encoding="utf-8")) if out.exists() else {}
            self._results[script] = {**found, "": end}
        return self._results[script]


@pytest.fixture(scope="session")
def home(tmp_path_factory: pytest.TempPathFactory) -> Home:
    blender, package = blender_path(), zip_path()
    if blender is None:
        pytest.skip("there is no blender in PATH, and ORBIFOLD_BLENDER does not name one")
    if package is None:
        pytest.skip("there is no package: run `./build.sh package`")
    made = Home(tmp_path_factory.mktemp("blender"), blender)
    done = made.run("install.py", str(package))
    assert done.returncode == 0, done.stdout
    return made


@pytest.fixture
def run_check(home: Home) -> Callable[[str, str], None]:
    def run(script: str, check: str) -> None:
        results = home.results(script)
        assert check in results, f"{script} did not come to {check}. {results['']}"
        assert results[check] is None, results[check]

    return run
