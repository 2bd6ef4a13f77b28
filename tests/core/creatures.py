# SPDX-License-Identifier: GPL-3.0-or-later
"""A made-up animal, mirror symmetric in x to the last bit, and mirror images as a table of vertices."""

import numpy as np
from meshes import icosphere

# (direction, how far it sticks out, how thin it is); directions off the plane x = 0 come in pairs
LIMBS = [
    ((0.0, 0.9, 0.5), 1.1, 14),  # head
    ((0.0, -1.0, 0.3), 0.8, 22),  # tail
    ((0.5, 0.6, -0.75), 0.9, 22),  # forelegs
    ((0.55, -0.5, -0.7), 0.8, 22),  # hind legs
    ((0.35, 0.75, 0.85), 0.5, 40),  # ears
]


def creature(level=4, lopsided=0.0):
    """10 * 4^level + 2 vertices; lopsided: how much the left legs are longer than the right ones."""
    points, triangles = icosphere(level)
    radius, side = np.ones(len(points)), 1 + lopsided * np.sign(points[:, 0])
    for direction, length, thinness in LIMBS:
        d = np.array(direction) / np.linalg.norm(direction)
        along = (np.abs(points * [1, 0, 0]) + points * [0, 1, 1]) * d  # both limbs of a pair at once
        radius = radius + length * (side if d[0] else 1) * np.exp(thinness * (along.sum(1) - 1))
    return points * radius[:, None] * [0.7, 1.25, 0.8], triangles


def mirror_images(vertices, plane):
    """Each vertex's image in a x + b y + c z = d, or -1 where none lies within a millionth of the mesh's size."""
    normal, offset = np.array(plane[:3], float), float(plane[3])
    size = np.linalg.norm(normal)
    reflected = vertices - np.outer(2 * (vertices @ normal - offset) / size**2, normal)
    extent = np.ptp(vertices, axis=0).max()
    image = np.full(len(vertices), -1)
    for start in range(0, len(vertices), 500):
        gap = np.linalg.norm(reflected[start : start + 500, None] - vertices, axis=2)
        nearest = gap.argmin(1)
        near = gap[np.arange(len(gap)), nearest] < 1e-6 * extent
        image[start : start + 500] = np.where(near, nearest, -1)
    return image


def is_its_own_image(suggestion, image):
    """Whether the set of (vertex, order) is taken to itself."""
    cones = {(int(v), int(n)) for v, n in zip(suggestion.cones, suggestion.orders)}
    return {(int(image[v]), n) for v, n in cones} == cones


def parted(vertices, triangles, keep):
    """The triangles for which keep(their centre) holds, as a mesh of their own."""
    from shapes import compact

    return compact(vertices, triangles[keep(vertices[triangles].mean(1))])
