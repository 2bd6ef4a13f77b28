# SPDX-License-Identifier: GPL-3.0-or-later
"""A fuzzer's corpus as one text: a line of hexadecimal digits for each input, the shortest first.

    python3 corpus.py unpack FILE FOLDER
    python3 corpus.py pack FOLDER FILE
"""

import hashlib
import sys
from pathlib import Path


def unpack(file: Path, folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for line in file.read_text(encoding="ascii").split():
        data = bytes.fromhex(line)
        (folder / hashlib.sha1(data).hexdigest()).write_bytes(data)


def pack(folder: Path, file: Path) -> None:
    inputs = sorted({path.read_bytes() for path in folder.iterdir()}, key=lambda data: (len(data), data))
    file.write_text("".join(f"{data.hex()}\n" for data in inputs if data), encoding="ascii")


if __name__ == "__main__":
    {"unpack": unpack, "pack": pack}[sys.argv[1]](*map(Path, sys.argv[2:]))
