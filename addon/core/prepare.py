# SPDX-License-Identifier: GPL-3.0-or-later
"""What all embeddings of one mesh share: for many requests on it, as while a cone is moved.

    prepared = prepare(vertices, triangles)
    embed(vertices, triangles, "442", cones, prepared=prepared)
"""

from __future__ import annotations

from numpy.typing import ArrayLike

from . import binding
from .arrays import mesh_of


class PreparedMesh:
    """Half-edges, cotangents, the ordering and the symbolic factor of a mesh, inside the library."""

    def __init__(self, native: binding.Prepared, n_vertices: int) -> None:
        self.native, self.n_vertices = native, n_vertices


def prepare(vertices: ArrayLike, triangles: ArrayLike) -> PreparedMesh:
    """(n, 3) coordinates, (m, 3) integers; arrays may change afterwards. Raises OrbifoldError where the mesh is bad."""
    points, faces = mesh_of(vertices, triangles)
    return PreparedMesh(binding.Prepared(points, faces), len(points))
