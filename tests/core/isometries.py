# SPDX-License-Identifier: GPL-3.0-or-later
"""Groups of isometries from their generators, 3 x 3 matrices on the model's coordinates, and which of the seventeen
wallpaper groups one is."""

import numpy as np


def generated(generators, limit, probes):
    """Elements of the group, the shortest words first, at most `limit`; told apart by what they do to `probes` (k, 3),
    three points in general position."""
    steps = [*generators, *(np.linalg.inv(g) for g in generators)]
    elements, images = [np.eye(3)], [probes]
    for element in elements:  # grows while it is read
        for step in steps:
            new = element @ step
            image = probes @ new.T
            size = 1 + np.abs(image).max()
            if len(elements) < limit and (np.abs(np.array(images) - image).max((1, 2)) > 1e-7 * size).all():
                elements.append(new)
                images.append(image)
    return elements


def times_covered(points, elements, triangles):
    """How many of the images g(triangle) each point lies in: points (q, 3), triangles (m, 3, 3) of either
    orientation."""
    normals = np.stack([np.cross(triangles[:, k], triangles[:, (k + 1) % 3]) for k in range(3)], 1)
    normals *= np.sign(np.einsum("mk,mk->m", normals[:, 0], triangles[:, 2]))[:, None, None]
    count = np.zeros(len(points), int)
    for element in elements:
        back = points @ np.linalg.inv(element).T
        count += (np.einsum("qi,mki->qmk", back, normals) > 0).all(2).sum(1)
    return count


# ------------------------------------------------------------------------------------------------- wallpaper


def reduced(vectors):
    """The two shortest vectors that generate the lattice of all these."""
    vectors = np.asarray(vectors)
    least = 1e-7 * np.linalg.norm(vectors, axis=1).max()
    for _ in range(60):
        vectors = vectors[np.linalg.norm(vectors, axis=1) > least]
        vectors = vectors[np.argsort(np.linalg.norm(vectors, axis=1), kind="stable")]
        first = vectors[0]
        aside = np.abs(vectors @ _turned(first)) > least * np.linalg.norm(first)
        assert aside.any(), "all translations are in one direction"
        second = vectors[aside][0]
        basis = np.array([first, second - np.round(second @ first / (first @ first)) * first])
        rest = vectors - np.round(vectors @ np.linalg.inv(basis)) @ basis
        if np.abs(rest).max() <= least and np.linalg.norm(basis[1]) >= np.linalg.norm(first) - least:
            return basis
        vectors = np.concatenate([basis, rest])
    raise AssertionError("the translations make no lattice")


def wallpaper(elements):
    """(International name, basis of the lattice, order of the point group) from many elements of the group."""
    linear = [g[:2, :2] for g in elements]
    basis = reduced([g[:2, 2] for g, a in zip(elements, linear) if np.abs(a - np.eye(2)).max() < 1e-7])
    point_group = []
    for a in linear:
        if all(np.abs(a - b).max() > 1e-6 for b in point_group):
            point_group.append(a)
    rotations = sum(np.linalg.det(a) > 0 for a in point_group)
    axes = [_axis(a, elements, basis) for a in point_group if np.linalg.det(a) < 0]
    if not axes:
        return f"p{rotations}", basis, len(point_group)
    centred = [kind == "centred" for _, kind in axes]
    mirrors = [kind == "mirror" for _, kind in axes]
    if rotations == 1:
        name = "cm" if centred[0] else "pm" if mirrors[0] else "pg"
    elif rotations == 2:
        name = "cmm" if all(centred) else ["pgg", "pmg", "pmm"][sum(mirrors)]
    elif rotations == 4:
        name = "p4m" if any(mirrors) else "p4g"  # of the two axes that are not centred
    elif rotations == 3:
        along = max(abs(_turned(basis[0]) @ axis) / np.linalg.norm(basis[0]) for axis, _ in axes)
        name = "p3m1" if along > 1 - 1e-6 else "p31m"
    else:
        name = "p6m"
    return name, basis, len(point_group)


def _turned(v):
    return np.array([-v[1], v[0]])


def _axis(a, elements, basis):
    """(direction, "mirror", "glide" or "centred") of the elements with this reflection as their linear part."""
    angle = np.arctan2(a[1, 0], a[0, 0]) / 2
    axis = np.array([np.cos(angle), np.sin(angle)])
    shares = basis @ axis  # how far lattice vectors go along the axis: multiples of `step`
    on_axis = [c @ basis for c in np.stack(np.meshgrid(range(-6, 7), range(-6, 7)), -1).reshape(-1, 2)]
    on_axis = [abs(v @ axis) for v in on_axis if abs(_turned(axis) @ v) < 1e-6 and abs(v @ axis) > 1e-6]
    period = min(on_axis)
    step = _common(shares, period)
    if abs(step - period / 2) < 1e-5 * period:
        return axis, "centred"
    assert abs(step - period) < 1e-5 * period
    slide = next(g[:2, 2] @ axis for g in elements if np.abs(g[:2, :2] - a).max() < 1e-6) / period
    assert abs(2 * slide - round(2 * slide)) < 1e-5
    return axis, "glide" if round(2 * slide) % 2 else "mirror"


def _common(shares, period):
    """The greatest common measure of these lengths and the period."""
    a = period
    for b in np.abs(shares):
        while b > 1e-5 * period:
            a, b = b, a % b
            b = 0 if a - b < 1e-5 * period else b
    return a
