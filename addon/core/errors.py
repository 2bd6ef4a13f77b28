# SPDX-License-Identifier: GPL-3.0-or-later
"""The one exception of this package."""

from __future__ import annotations

from collections.abc import Sequence


class OrbifoldError(Exception):
    """What went wrong, in one sentence (`str(error)`), and where on the mesh.

    status    name of the C enum's entry, "ORB_BOUNDARY"; "ORB_NO_LIBRARY" where the native library cannot be loaded
    element   what `elements` counts: "vertex", "edge", "triangle", "character" (of the signature) or None
    elements  the first sixteen of them, from 0; an edge is a pair of vertices
    found     how many there are in all
    """

    def __init__(
        self,
        status: str,
        message: str,
        elements: Sequence[int] | Sequence[tuple[int, int]] = (),
        element: str | None = None,
        found: int | None = None,
    ) -> None:
        super().__init__(message)
        self.status = status
        self.elements = list(elements)
        self.element = element
        self.found = len(self.elements) if found is None else found
