# SPDX-License-Identifier: GPL-3.0-or-later
"""The round sphere's conformal maps onto orbifolds, exactly: the log scale u and the spread of 2 u over the area.

Cones are unit vectors. Plane: a harmonic function, u = -sum (1 - 1/n) log |x - c| + constant. Sphere: the orbifold's
own sphere covers it by one of Klein's rational functions (docs/mathematics.md, section 7); points are taken evenly on that
sphere, so that the integrand is bounded, and carry the area of their images."""

import numpy as np
from numpy.polynomial import Polynomial

GOLDEN = np.pi * (3 - np.sqrt(5))


def evenly(count):
    """(count, 3) points of the unit sphere, each for the same area."""
    z = 1 - (2 * np.arange(count) + 1) / count
    angle = GOLDEN * np.arange(count)
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(angle), r * np.sin(angle), z], 1)


def to_plane(points):
    return (points[:, 0] + 1j * points[:, 1]) / (1 + points[:, 2])


def to_sphere(z):
    return np.stack([2 * z.real, 2 * z.imag, 1 - np.abs(z) ** 2], 1) / (1 + np.abs(z) ** 2)[:, None]


def flat_scale(points, cones, orders):
    """u, up to a constant, of a Euclidean orbifold of rotations."""
    distance = np.linalg.norm(points[:, None] - np.asarray(cones, float), axis=2)
    return -(np.log(distance) @ (1 - 1 / np.array(orders)))


def flat_spread(cones, orders, count=200_000):
    return spread(flat_scale(evenly(count), cones, orders))


def spread(u, weight=None):
    mean = np.average(u, weights=weight)
    return 2 * np.sqrt(np.average((u - mean) ** 2, weights=weight))


def powers(*factors):
    """(f, f'/f) of a product of polynomials (coefficients, lowest first) to integer powers."""

    def value(w):
        product, slope = np.ones_like(w), np.zeros_like(w)
        for coefficients, power in factors:
            f = Polynomial(coefficients)
            product = product * f(w) ** power
            slope = slope + power * f.deriv()(w) / f(w)
        return product, slope

    return value


def sparse(**terms):
    """sparse(w11=1, w6=11, w1=-1): coefficients, lowest first."""
    degree = {int(name[1:]): c for name, c in terms.items()}
    return [degree.get(k, 0) for k in range(max(degree) + 1)]


I3 = 2j * np.sqrt(3)
# the function's values are infinity, 0, 1 at the cones of these orders
KLEIN = {
    "332": ((3, 3, 2), 12, powers((sparse(w4=1, w2=I3, w0=1), 3), (sparse(w4=1, w2=-I3, w0=1), -3))),
    "432": ((4, 3, 2), 24, powers(([1 / 108], 1), (sparse(w8=1, w4=14, w0=1), 3), (sparse(w5=1, w1=-1), -4))),
    "532": (
        (5, 3, 2),
        60,
        powers(
            ([-1 / 1728], 1),
            (sparse(w20=1, w15=-228, w10=494, w5=228, w0=1), 3),
            (sparse(w11=1, w6=11, w1=-1), -5),
        ),
    ),
    **{
        f"22{n}": ((n, 2, 2), 2 * n, powers(([-0.25], 1), (sparse(**{f"w{n}": 1, "w0": -1}), 2), ([0, 1], -n)))
        for n in (2, 3, 5)
    },
}


def klein_samples(signature, cones, count=200_000):
    """(x, u, weight): points of the round sphere, the log scale there, and the area each stands for, for a map onto
    the orbifold whose cones, in the sequence of KLEIN, are the unit vectors `cones`."""
    _, size, function = KLEIN[signature]
    turn, _ = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))  # so that no cone is at infinity
    at = to_plane(np.asarray(cones, float) @ turn)
    w = to_plane(evenly(count))
    f, slope = function(w)
    # (a f + b) / (c f + 1) with infinity -> at[0], 0 -> at[1], 1 -> at[2]
    b = at[1]
    c = (at[2] - b) / (at[0] - at[2])
    a = at[0] * c
    z = (a * f + b) / (c * f + 1)
    stretch = np.abs((a - b * c) * f * slope / (c * f + 1) ** 2)  # |dz / dw|
    u = np.log((1 + np.abs(z) ** 2) / ((1 + np.abs(w) ** 2) * stretch))
    weight = np.exp(-2 * u)
    assert abs(weight.mean() / size - 1) < 1e-3  # how often the one sphere covers the other
    return to_sphere(z) @ turn.T, u, weight / weight.sum()


def round_spread(signature, cones, count=200_000):
    _, u, weight = klein_samples(signature, cones, count)
    return spread(u, weight)


def octasphere(level):
    """4 * 4^level + 2 vertices on the unit sphere, the octahedron's first: x, -x, y, -y, z, -z."""
    from meshes import octahedron, subdivided

    vertices, triangles = octahedron()
    for _ in range(level):
        vertices, triangles = subdivided(vertices, triangles)
        vertices /= np.linalg.norm(vertices, axis=1, keepdims=True)
    return vertices, triangles
