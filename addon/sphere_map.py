# SPDX-License-Identifier: GPL-3.0-or-later
"""Places a map onto the unit sphere beside the mesh: its size, its place, and the rotation that moves it least."""

from __future__ import annotations

import numpy as np

from .blender_mesh import MeshArrays


def vertex_areas(vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(n,) a third of the area of the triangles around each vertex."""
    p, q, r = vertices[triangles].transpose(1, 0, 2)
    areas = np.linalg.norm(np.cross(q - p, r - p), axis=1) / 2
    return np.bincount(triangles.ravel(), np.repeat(areas / 3, 3), len(vertices))


def placed_sphere(points: np.ndarray, arrays: MeshArrays) -> np.ndarray:
    """(n, 3) points of the unit sphere -> the sphere with the mesh's area about its centroid, turned so that the
    vertices have the least way to it (Kabsch). Vertices without a triangle stay where they are."""
    areas = vertex_areas(arrays.vertices, arrays.triangles)
    total = areas.sum()
    centre = (areas @ arrays.vertices) / total
    radius = np.sqrt(total / (4 * np.pi))
    left, _, right = np.linalg.svd((points * areas[:, None]).T @ (arrays.vertices - centre))
    left[:, -1] *= np.sign(np.linalg.det(left @ right))  # a rotation, not a reflection
    placed = centre + radius * points @ (left @ right)
    alone = np.bincount(arrays.triangles.ravel(), minlength=len(arrays.vertices)) == 0
    placed[alone] = arrays.vertices[alone]
    return placed
