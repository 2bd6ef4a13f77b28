# SPDX-License-Identifier: GPL-3.0-or-later
"""A spherical embedding as positions of the mesh's vertices: on the whole sphere, or a patch of it between mirrors,
beside the mesh in size and place, and turned so that it moves least."""

from __future__ import annotations

import numpy as np

from . import core
from .blender_mesh import MeshArrays


def vertex_areas(vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(n,) a third of the area of the triangles around each vertex."""
    p, q, r = vertices[triangles].transpose(1, 0, 2)
    areas = np.linalg.norm(np.cross(q - p, r - p), axis=1) / 2
    return np.bincount(triangles.ravel(), np.repeat(areas / 3, 3), len(vertices))


def sphere_of(result: core.Result, arrays: MeshArrays) -> np.ndarray:
    """(n, 3) positions on the sphere. A disk between mirrors has no seam: the tile itself, a patch of the sphere.
    OrbifoldError where there is a seam that the whole sphere does not close."""
    if not len(result.seams) and result.report["mesh"]["orientable"]:
        return _placed_patch(result.embedding[: result.n_input_vertices], arrays)
    if {"*", "x"} & set(result.signature):
        raise core.OrbifoldError(
            "ORB_UNSUPPORTED_SIGNATURE",
            f"a surface as that of {result.signature} does not cover the sphere once: spheres with cones do, and disks "
            "with mirror corners and no cone inside become a patch of it",
        )
    return placed_sphere(result.whole_sphere(), arrays)


def placed_sphere(points: np.ndarray, arrays: MeshArrays) -> np.ndarray:
    """(n, 3) points of the unit sphere -> the sphere with the mesh's area about its centroid, turned so that the
    vertices have the least way to it (Kabsch). Vertices without a triangle stay where they are."""
    areas = vertex_areas(arrays.vertices, arrays.triangles)
    centre = (areas @ arrays.vertices) / areas.sum()
    radius = np.sqrt(areas.sum() / (4 * np.pi))
    return _with_isolated(centre + radius * points @ _turn(points, arrays.vertices - centre, areas), arrays)


def _placed_patch(points: np.ndarray, arrays: MeshArrays) -> np.ndarray:
    """The same for a part of the unit sphere: as large as the mesh, its middle in the mesh's."""
    areas = vertex_areas(arrays.vertices, arrays.triangles)
    total = areas.sum()
    centre, middle = (areas @ arrays.vertices) / total, (areas @ points) / total
    radius = np.sqrt(total / vertex_areas(points, arrays.triangles).sum())
    turn = _turn(points - middle, arrays.vertices - centre, areas)
    return _with_isolated(centre + radius * (points - middle) @ turn, arrays)


def _turn(points: np.ndarray, targets: np.ndarray, areas: np.ndarray) -> np.ndarray:
    """(3, 3) the rotation, not a reflection, that brings the points nearest to the targets, weighted with areas."""
    left, _, right = np.linalg.svd((points * areas[:, None]).T @ targets)
    left[:, -1] *= np.sign(np.linalg.det(left @ right))
    return left @ right


def _with_isolated(placed: np.ndarray, arrays: MeshArrays) -> np.ndarray:
    alone = np.bincount(arrays.triangles.ravel(), minlength=len(arrays.vertices)) == 0
    placed[alone] = arrays.vertices[alone]
    return placed
