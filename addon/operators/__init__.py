# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators, one idea a file."""

from . import cones, sphere, unwrap

CLASSES = (*cones.CLASSES, *unwrap.CLASSES, *sphere.CLASSES)
