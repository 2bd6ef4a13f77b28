# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh for any signature and picks on it; and those parts of the add-on that need no bpy, as a package without
Blender."""

import importlib
import sys
import types

import picks
from conftest import CHECKOUT
from conway import features
from families import MESHES, mesh_named


def bare(name):
    """A module of the add-on by its name below addon/, the package's __init__ (and so bpy) left out."""
    if "bare_addon" not in sys.modules:
        package = types.ModuleType("bare_addon")
        package.__path__ = [str(CHECKOUT / "addon")]
        sys.modules["bare_addon"] = package
    return importlib.import_module(f"bare_addon.{name}")


def surface_for(signature):
    """The first mesh of ours of the signature's surface."""
    topology = features(signature).topology
    return mesh_named(topology, next(name for name, make in MESHES[topology].items() if make))


def picks_for(mesh, signature):
    """Spread out without regard to what they cost (tests/core/picks.py), so that the embedding alone is tested."""
    return picks.picks_for(*mesh, features(signature))
