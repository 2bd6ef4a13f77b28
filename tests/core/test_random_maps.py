# SPDX-License-Identifier: GPL-3.0-or-later
"""A thousand random landmark sets on the shared spheres and disks: each is embedded, mapped and mapped back."""

import functools

import numpy as np
import pytest
from mapping import trials
from meshes import shared_file

import core


@functools.lru_cache(None)
def read(name):
    return core.read_mesh(shared_file("meshes", name))


@pytest.mark.parametrize("hundred", range(10))
def test_a_hundred_random_landmark_sets(hundred):
    found = list(trials(np.random.default_rng(hundred), 100, read))
    assert len(found) == 100 and not any(found), [line for line in found if line]
