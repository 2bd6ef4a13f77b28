# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension repository of `./build.sh package`, a folder with the zip and index.json: what is in it, and Blender 4.2
or later as a subscriber to it."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest
from conftest import INSIDE, LIMIT, ROOT, Home, blender_path, zip_path

sys.path.insert(0, str(ROOT / "docs"))
import packaging  # noqa: E402


@pytest.fixture(scope="module")
def package() -> Path:
    path = zip_path()
    if path is None:
        pytest.skip("there is no package: run `./build.sh package`")
    return path


@pytest.fixture(scope="module")
def subscriber(tmp_path_factory: pytest.TempPathFactory) -> Home:
    """A Blender that knows extensions, without the add-on."""
    blender = blender_path()
    if blender is None:
        pytest.skip("there is no blender in PATH, and ORBIFOLD_BLENDER does not name one")
    said = subprocess.run([blender, "--version"], capture_output=True, text=True).stdout
    version = re.search(r"^Blender (\d+)\.(\d+)", said, re.MULTILINE)
    if tuple(map(int, version.groups())) < (4, 2):
        pytest.skip(f"Blender {'.'.join(version.groups())} has no extensions")
    return Home(tmp_path_factory.mktemp("subscriber"), blender)


def extension(home: Home, *words: object) -> str:
    # A subscriber has to allow access to the network, even for a folder.
    command = [home.blender, "--online-mode", "--command", "extension", *map(str, words)]
    done = subprocess.run(
        command, env=home.environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=LIMIT
    )
    assert done.returncode == 0, done.stdout
    return done.stdout


def test_the_manifest_names_the_platforms_of_the_libraries(package: Path) -> None:
    with zipfile.ZipFile(package) as archive:
        manifest = tomllib.loads(archive.read("orbifold_uv/blender_manifest.toml").decode())
        libraries = [archive.read(name) for name in archive.namelist() if Path(name).stem == "liborbifold"]
    built_for = sorted(platform for library in libraries for platform in packaging.platforms_of(library))
    assert manifest["platforms"] == built_for and built_for
    assert all(licence.startswith("SPDX:") for licence in manifest["license"])


def test_headers_of_other_systems_libraries() -> None:
    """The first bytes of a DLL and of libraries of macOS, which cannot be made here."""
    dll = b"MZ".ljust(60, b"\0") + (64).to_bytes(4, "little") + b"PE\0\0" + (0x8664).to_bytes(2, "little")
    assert packaging.platforms_of(dll) == ["windows-x64"]
    assert packaging.platforms_of(b"\xcf\xfa\xed\xfe" + (0x0100000C).to_bytes(4, "little")) == ["macos-arm64"]
    slices = b"".join(kind.to_bytes(4, "big") + bytes(16) for kind in (0x01000007, 0x0100000C))
    assert packaging.platforms_of(b"\xca\xfe\xba\xbe" + (2).to_bytes(4, "big") + slices) == ["macos-x64", "macos-arm64"]
    assert packaging.platforms_of(b"int main") == []


def test_the_repository_s_index_is_of_this_package(package: Path) -> None:
    folder = package.parent / "repository"
    if not folder.is_dir():
        pytest.skip("there is no repository beside the package")
    index = json.loads((folder / "index.json").read_text(encoding="utf-8"))
    assert index == {"version": "v1", "blocklist": [], "data": [packaging.entry(package)]}
    assert (folder / package.name).read_bytes() == package.read_bytes()


def test_blender_finds_the_package_valid(subscriber: Home, package: Path) -> None:
    extension(subscriber, "validate", package)


def test_our_index_is_the_one_that_blender_writes(subscriber: Home, package: Path, tmp_path: Path) -> None:
    shutil.copy(package, tmp_path)
    packaging.index(tmp_path)
    ours = (tmp_path / "index.json").read_text(encoding="utf-8")
    extension(subscriber, "server-generate", "--repo-dir", tmp_path)
    assert json.loads(ours) == json.loads((tmp_path / "index.json").read_text(encoding="utf-8"))


def test_subscribe_install_unwrap(subscriber: Home, package: Path, tmp_path: Path) -> None:
    folder = tmp_path / "a folder"
    folder.mkdir()
    shutil.copy(package, folder)
    packaging.index(folder)
    url = (folder / "index.json").as_uri()
    extension(subscriber, "repo-add", "--clear-all", "--name", "Orbifold", "--url", url, "orbifold")
    extension(subscriber, "sync")
    assert "orbifold_uv" in extension(subscriber, "list")
    extension(subscriber, "install", "--enable", "orbifold_uv")

    out = tmp_path / "seen.json"  # without --factory-startup: the subscription is in the preferences
    command = [subscriber.blender, "--background", "--python-exit-code", "1"]
    command += ["--python", str(INSIDE / "repository.py"), "--", str(out)]
    done = subprocess.run(command, env=subscriber.environment, capture_output=True, text=True, timeout=LIMIT)
    assert done.returncode == 0, done.stdout + done.stderr
    seen = json.loads(out.read_text(encoding="utf-8"))
    assert seen == {
        "enabled": ["bl_ext.orbifold.orbifold_uv"],
        "loaded": True,
        "unwrapped": ["FINISHED"],
        "uv_maps": ["Orbifold"],
        "library_problem": None,
    }
