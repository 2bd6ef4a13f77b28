# SPDX-License-Identifier: GPL-3.0-or-later
"""The installed add-on, check by check (inside/*.py, conftest.py)."""

from __future__ import annotations

import zipfile

import pytest
from conftest import checks_of, zip_path

SCRIPTS = (
    "registration.py", "picking.py", "unwrapping.py", "orbifolds.py", "suggesting.py", "seeing.py", "bad_input.py",
    "checking.py", "objects.py",
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
