# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh for any signature and picks on it as `./build.sh run --cones auto` makes them; and those parts of the add-on
that need no bpy, as a package without Blender."""

import importlib
import sys
import types

from conftest import CHECKOUT
from conway import features
from families import MESHES, mesh_named

import core


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
    """As `./build.sh run --cones auto` does."""
    return bare("headless.automatic").automatic_cones(*mesh, core.parse_signature(signature))
