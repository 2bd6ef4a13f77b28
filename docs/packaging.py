# SPDX-License-Identifier: GPL-3.0-or-later
"""What `./build.sh package` needs besides a zip.

    packaging.py platforms FOLDER     the platforms of the native libraries in a folder, as the manifest writes them
    packaging.py index FOLDER         writes index.json for the zips in a folder, so that Blender 4.2 and later can
                                      subscribe to it: as `blender --command extension server-generate` writes it
"""

from __future__ import annotations

import hashlib
import json
import struct
import sys
import tomllib
import zipfile
from pathlib import Path

ELF = {62: "linux-x64", 183: "linux-arm64"}
PE = {0x8664: "windows-x64", 0xAA64: "windows-arm64"}
MACH = {0x01000007: "macos-x64", 0x0100000C: "macos-arm64"}
# The manifest's fields that an index repeats, in its sequence.
FIELDS = "schema_version id name tagline version type maintainer license blender_version_min blender_version_max"
FIELDS += " website copyright permissions tags platforms wheels"


def platforms_of(library: bytes) -> list[str]:
    """What a shared library was built for, by its header; nothing for another kind of file."""
    if library[:4] == b"\x7fELF":
        return [ELF[struct.unpack_from("<H", library, 18)[0]]]
    if library[:2] == b"MZ":
        header = struct.unpack_from("<I", library, 60)[0]
        return [PE[struct.unpack_from("<H", library, header + 4)[0]]]
    if library[:4] == b"\xcf\xfa\xed\xfe":
        return [MACH[struct.unpack_from("<I", library, 4)[0]]]
    if library[:4] == b"\xca\xfe\xba\xbe":  # one library for several processors
        count = struct.unpack_from(">I", library, 4)[0]
        return [MACH[struct.unpack_from(">I", library, 8 + 20 * k)[0]] for k in range(count)]
    return []


def platforms(folder: Path) -> str:
    """A list as TOML has it."""
    found = {name for path in folder.glob("liborbifold.*") for name in platforms_of(path.read_bytes())}
    return json.dumps(sorted(found))


def entry(package: Path) -> dict:
    """One zip in the index."""
    with zipfile.ZipFile(package) as archive:
        name = next(name for name in archive.namelist() if name.split("/", 1)[-1] == "blender_manifest.toml")
        manifest = tomllib.loads(archive.read(name).decode("utf-8"))
    data = package.read_bytes()
    return {
        **{field: manifest[field] for field in FIELDS.split() if field in manifest},
        "archive_url": f"./{package.name}",
        "archive_size": len(data),
        "archive_hash": f"sha256:{hashlib.sha256(data).hexdigest()}",
    }


def index(folder: Path) -> str:
    """Writes the file; says what is in it."""
    found = [entry(path) for path in sorted(folder.glob("*.zip"))]
    text = json.dumps({"version": "v1", "blocklist": [], "data": found}, indent=2)
    (folder / "index.json").write_text(text, encoding="utf-8")
    return f"{len(found)} packages"


if __name__ == "__main__":
    verbs = {"platforms": platforms, "index": index}
    if len(sys.argv) != 3 or sys.argv[1] not in verbs:
        sys.exit(__doc__)
    print(verbs[sys.argv[1]](Path(sys.argv[2])))
