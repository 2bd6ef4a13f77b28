# SPDX-License-Identifier: GPL-3.0-or-later
"""The headless command, run by Blender:

    blender --background --factory-startup --python-exit-code 1 --python addon/run.py -- [MESH] [OPTIONS]

which `./build.sh run` does; `-- --help` lists the options. The add-on's package is loaded from this folder under its
own name; nothing is installed or registered, and sys.path stays as it is."""

from __future__ import annotations

import importlib.util
import os
import sys
from pathlib import Path
from types import ModuleType
from typing import NoReturn

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


def fail(message: str) -> NoReturn:
    """One line on stderr and exit status 1, at once: Blender's own way out prints more to stderr."""
    sys.stdout.flush()
    sys.stderr.write(f"orbifold error: {message}\n")
    sys.stderr.flush()
    os._exit(1)


def main() -> None:
    words = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
    load_package()
    headless = importlib.import_module(f"{PACKAGE}.headless.session")
    try:
        lines = headless.run(words)
    except headless.EXPECTED as reason:
        fail(headless.one_line(reason))
    except Exception as reason:  # a fault of ours: still one line, but with the place
        trace = reason.__traceback__
        while trace.tb_next is not None:
            trace = trace.tb_next
        where = f"{Path(trace.tb_frame.f_code.co_filename).name}:{trace.tb_lineno}"
        fail(f"internal fault in {where}: {type(reason).__name__}: {headless.one_line(reason)}")
    for line in lines:
        print(f"orbifold: {line}", flush=True)


if __name__ == "__main__":
    main()
