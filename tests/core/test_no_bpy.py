# SPDX-License-Identifier: GPL-3.0-or-later
"""addon/core is for any Python: it names no bpy, uses ctypes in one file, imports in a bare interpreter, quietly."""

import re
import subprocess
import sys

from conftest import CHECKOUT

CORE = CHECKOUT / "addon" / "core"
FILES = sorted(CORE.glob("**/*.py"))


def importing(word):
    statement = re.compile(rf"^\s*(import|from)\s+{word}\b|import_module\(.{word}|__import__\(.{word}", re.MULTILINE)
    return [file.name for file in FILES if statement.search(file.read_text())]


def test_no_file_of_core_imports_bpy():
    assert len(FILES) > 4
    assert [file.name for file in FILES if re.search(r"\b(bpy|bmesh|mathutils)\b", file.read_text())] == []
    for word in ("bpy", "bmesh", "mathutils"):
        assert importing(word) == []


def test_only_binding_uses_ctypes():
    assert importing("ctypes") == ["binding.py"]


def test_no_file_of_core_prints():
    assert [file.name for file in FILES if re.search(r"^\s*print\(", file.read_text(), re.MULTILINE)] == []


def test_import_is_quiet_and_loads_nothing():
    code = f"import sys; sys.path.insert(0, {str(CORE.parent)!r}); import core; "
    code += "print(core.library.cache_info().currsize)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert (run.stdout, run.stderr) == ("0\n", "")
