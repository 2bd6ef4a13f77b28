# SPDX-License-Identifier: GPL-3.0-or-later
"""`blender --command orbifold [MESH ...] [OPTIONS]`, from Blender 4.2 on: what run.py does, but as installed."""

from __future__ import annotations

from collections.abc import Sequence

import bpy

NAME = "orbifold"
_registered: list[object] = []


def _run(words: Sequence[str]) -> int:
    """The exit status."""
    from .headless import command  # only here: no session with a window needs it

    return command.main(words)


def register() -> None:
    if hasattr(bpy.utils, "register_cli_command"):
        _registered.append(bpy.utils.register_cli_command(NAME, _run))


def unregister() -> None:
    while _registered:
        bpy.utils.unregister_cli_command(_registered.pop())
