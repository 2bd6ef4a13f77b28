# SPDX-License-Identifier: GPL-3.0-or-later
"""Nothing to set; says whether the native library can be used."""

from __future__ import annotations

import bpy

from . import core


class OrbifoldPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    def draw(self, _context: bpy.types.Context) -> None:
        problem = library_problem()
        text = problem or "The native library is loaded. Sidebar (N) of the 3D view and the UV editor, tab Orbifold"
        self.layout.label(text=text, icon="ERROR" if problem else "CHECKMARK")


def library_problem() -> str | None:
    try:
        core.library()
    except core.OrbifoldError as error:
        return str(error)
    return None


CLASSES = (OrbifoldPreferences,)
