# SPDX-License-Identifier: GPL-3.0-or-later
"""The tests' own recogniser of wallpaper groups, on groups written down by hand."""

import numpy as np
import pytest
from isometries import generated, wallpaper


def move(x, y):
    return np.array([[1, 0, x], [0, 1, y], [0, 0, 1.0]])


def turn(degrees, x=0.0, y=0.0):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return move(x, y) @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ move(-x, -y)


def mirror(degrees, x=0.0, y=0.0, glide=0.0):
    """In the line through (x, y) in this direction, and along it."""
    c, s = np.cos(2 * np.radians(degrees)), np.sin(2 * np.radians(degrees))
    along = glide * np.cos(np.radians(degrees)), glide * np.sin(np.radians(degrees))
    return move(x + along[0], y + along[1]) @ np.array([[c, s, 0], [s, -c, 0], [0, 0, 1]]) @ move(-x, -y)


GROUPS = {
    "p1": [move(1, 0.2), move(0.3, 1.1)],
    "p2": [move(1, 0.2), move(0.3, 1.1), turn(180)],
    "pm": [move(1.3, 0), mirror(0), mirror(0, 0, 0.7)],
    "pg": [mirror(0, glide=0.5), move(0, 1.3)],
    "cm": [mirror(0), mirror(0, 0, 0.4, 0.6)],
    "pmm": [mirror(0), mirror(0, 0, 1), mirror(90), mirror(90, 1.4)],
    "pmg": [mirror(0), turn(180, 0.2, 0.5), turn(180, 0.9, 0.5)],
    "pgg": [turn(180), mirror(0, 0, 0.3, 0.5), mirror(90, 0.25, 0, 0.6)],
    "cmm": [mirror(0), mirror(90), turn(180, 0.3, 0.5)],
    "p4": [turn(90), turn(90, 1)],
    "p4m": [mirror(0), mirror(45), mirror(90, 1)],
    "p4g": [turn(90), mirror(45, 1)],
    "p3": [turn(120), turn(120, 1)],
    "p3m1": [mirror(0), mirror(60), mirror(-60, 1)],
    "p31m": [turn(120), mirror(0, 0, 1)],
    "p6": [turn(60), turn(180, 1)],
    "p6m": [mirror(0), mirror(30), mirror(90, 1)],
}


@pytest.mark.parametrize("name", GROUPS)
def test_wallpaper_groups_are_recognised(name):
    stretch = turn(17, 0.1, 0.2)
    stretch[:2, :2] *= 1.7
    probes = np.array([[0.11, 0.02, 1], [-0.07, 0.13, 1], [0.05, -0.17, 1]])
    generators = [stretch @ g @ np.linalg.inv(stretch) for g in GROUPS[name]]
    found, _, order = wallpaper(generated(generators, 400, probes))
    assert found == name
    rotations = max([int(letter) for letter in name if letter.isdigit()], default=2 if len(name) == 3 else 1)
    assert order == rotations * (1 if name[1:].isdigit() else 2)
