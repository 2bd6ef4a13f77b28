# SPDX-License-Identifier: GPL-3.0-or-later
"""The equation that a prediction solves (docs/mathematics.md, section 8), and random cones to try it on."""

import numpy as np
from conway import features
from picks import boundary_loops


class Surface:
    """Angle defects, areas and the cotangent Laplacian of a mesh."""

    def __init__(self, vertices, triangles):
        self.vertices, self.triangles = vertices, triangles
        n, corners = len(vertices), vertices[triangles]
        u, v = np.roll(corners, -1, 1) - corners, np.roll(corners, -2, 1) - corners
        dot, twice = (u * v).sum(2), np.linalg.norm(np.cross(u[:, 0], v[:, 0]), axis=1)[:, None]
        angles = np.arctan2(twice, dot)
        self.ends = np.stack([np.roll(triangles, -1, 1), np.roll(triangles, -2, 1)], 2).reshape(-1, 2)
        self.half_cotangents = (dot / twice / 2).ravel()
        self.border = np.zeros(n, bool)
        self.border[[v for loop in boundary_loops(triangles) for v in loop]] = True
        self.whole_angle = np.where(self.border, np.pi, 2 * np.pi)
        used = np.bincount(triangles.ravel(), minlength=n) > 0
        around = np.bincount(triangles.ravel(), angles.ravel(), n)
        self.defects = np.where(used, self.whole_angle - around, 0)
        self.triangle_areas = twice.ravel() / twice.sum()
        self.areas = np.bincount(triangles.ravel(), np.repeat(self.triangle_areas / 3, 3), n)

    def laplacian_of(self, x):
        flow = self.half_cotangents * (x[self.ends[:, 0]] - x[self.ends[:, 1]])
        n = len(self.vertices)
        return np.bincount(self.ends[:, 0], flow, n) - np.bincount(self.ends[:, 1], flow, n)

    def is_delaunay(self):
        """Whether every cotangent weight is positive, so that all reasonable Laplacians are this one."""
        edges, of = np.unique(np.sort(self.ends, 1), axis=0, return_inverse=True)
        return np.bincount(of.ravel(), self.half_cotangents).min() > 0

    def curvature_of(self, scale):
        """Gauss curvature at each vertex of the metric e^(2 scale), in radians."""
        return self.defects + self.laplacian_of(scale)

    def spread_of(self, scale):
        """Twice the area-weighted standard deviation of the triangles' mean scale."""
        of_triangle = scale[self.triangles].mean(1)
        mean = self.triangle_areas @ of_triangle
        return 2 * np.sqrt(self.triangle_areas @ (of_triangle - mean) ** 2)


def random_cones(vertices, triangles, signature, random):
    """Distinct random vertices for every cone and corner, in the signature's sequence; mirror i on the i-th longest
    boundary loop, its corners in turn."""
    return next(random_choices(vertices, triangles, signature, random))


def random_choices(vertices, triangles, signature, random):
    """`random_cones` again and again."""
    wanted, loops = features(signature), boundary_loops(triangles)
    free = np.setdiff1d(triangles, [v for loop in loops for v in loop])
    while True:
        cones = random.choice(free, len(wanted.cones), replace=False).tolist()
        for loop, corners in zip(loops, wanted.mirrors):
            places = np.sort(random.choice(len(loop), len(corners), replace=False))
            cones += [loop[at] for at in places]
        yield cones
