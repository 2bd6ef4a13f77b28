# SPDX-License-Identifier: GPL-3.0-or-later
"""The installed add-on, check by check (inside/*.py, conftest.py)."""

from __future__ import annotations

import pytest
from conftest import checks_of

SCRIPTS = ("registration.py", "picking.py", "unwrapping.py", "bad_input.py")


@pytest.mark.parametrize("script, check", [(script, check) for script in SCRIPTS for check in checks_of(script)])
def test_in_blender(run_check, script: str, check: str) -> None:
    run_check(script, check)
