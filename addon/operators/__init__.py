# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators, one idea a file."""

from . import cones, fixed_boundary, sphere, unwrap

CLASSES = (*cones.CLASSES, *unwrap.CLASSES, *fixed_boundary.CLASSES, *sphere.CLASSES)
