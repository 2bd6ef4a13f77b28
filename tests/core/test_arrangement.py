# SPDX-License-Identifier: GPL-3.0-or-later
"""Picks in the sequence of a signature."""

import numpy as np
import pytest
from surfaces import bare

import core


def surface(*loops, genus=0, orientable=True):
    euler = 2 - (2 if orientable else 1) * genus - len(loops)
    return core.Topology(euler, 1, tuple(np.array(loop) for loop in loops), orientable)


def arranged(picks, seen, all_mirrors=True):
    return bare("arrangement").arrange(picks, seen, all_mirrors)


def test_a_sphere_keeps_the_sequence():
    places = arranged([9, 3, 7], surface())
    assert places.sequence == [0, 1, 2] and places.text([4, 3, 2]) == "432"


def test_corners_follow_the_border_from_the_first_towards_the_second():
    loop = [10, 11, 12, 13, 14, 15]
    assert arranged([12, 10, 14], surface(loop)).sequence == [0, 1, 2]
    assert arranged([12, 14, 10], surface(loop)).sequence == [0, 1, 2]
    assert arranged([10, 13, 11, 15], surface(loop)).borders == ((0, 2, 1, 3),)


def test_cones_come_before_corners():
    places = arranged([11, 5, 13, 6], surface([10, 11, 12, 13]))
    assert places.cones == (1, 3) and places.borders == ((0, 2),)
    assert places.text([2, 4, 3, 5]) == "45*23"


def test_borders_without_corners_are_mirrors_if_wanted():
    seen = surface([10, 11, 12], [20, 21, 22])
    assert arranged([21], seen).text([3]) == "*3*"
    assert arranged([21], seen, all_mirrors=False).text([3]) == "*3"
    assert arranged([], surface([1, 2, 3], genus=1, orientable=False)).text([]) == "*x"
    assert arranged([4], surface(genus=2)).text([3]) == "oo3"


def test_a_signature_gives_orders():
    places = arranged([11, 5, 13, 6], surface([10, 11, 12, 13]))
    assert places.orders_from(core.parse_signature("45*23")) == [2, 4, 3, 5]
    assert places.orders_from(core.parse_signature("3*23")) is None  # too few cones
    assert places.orders_from(core.parse_signature("456*237")) == [2, 4, 3, 5]


def test_mirrors_take_loops_with_as_many_corners():
    places = arranged([10, 20, 21], surface([10, 11, 12], [20, 21, 22]))
    assert places.borders == ((0,), (1, 2))
    assert places.matched(core.parse_signature("*23*4")) == [1, 2, 0]
    assert places.orders_from(core.parse_signature("*23*4")) == [4, 2, 3]


@pytest.mark.parametrize("seen", [core.Topology(4, 2, (), True), core.Topology(3, 1, (), True)])
def test_what_is_no_surface_has_cones_only(seen):
    assert arranged([1, 2, 3], seen).cones == (0, 1, 2)
