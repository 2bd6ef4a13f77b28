# SPDX-License-Identifier: GPL-3.0-or-later
"""The headless command, run by Blender:

    blender --background --factory-startup --python-exit-code 1 --python addon/run.py -- [MESH ...] [OPTIONS]

which `./build.sh run` does; `-- --help` lists the options. The add-on's package is loaded from this folder under its
own name; nothing is installed, nothing registered but, for maps, what meshes and scenes keep, and sys.path stays as it
is."""

from __future__ import annotations

import importlib.util
import os
import sys
from pathlib import Path
from types import ModuleType

PACKAGE = "orbifold_uv"
FOLDER = Path(__file__).resolve().parent


def load_package() -> ModuleType:
    """The folder of this file as the package orbifold_uv."""
    spec = importlib.util.spec_from_file_location(
        PACKAGE, FOLDER / "__init__.py", submodule_search_locations=[str(FOLDER)]
    )
    package = importlib.util.module_from_spec(spec)
    sys.modules[PACKAGE] = package
    spec.loader.exec_module(package)
    return package


def main() -> None:
    words = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
    load_package()
    status = importlib.import_module(f"{PACKAGE}.headless.command").main(words)
    if status:  # at once: Blender's own way out prints more to stderr
        os._exit(status)


if __name__ == "__main__":
    main()
