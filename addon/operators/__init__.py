# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators, one idea a file."""

from . import (
    check, cones, fixed_boundary, ordinary, painting, seam_margin, sliding, sphere, stretch, suggesting, transfer, unwrap,
    viewing, wallpaper,
)

CLASSES = (
    *cones.CLASSES,
    *suggesting.CLASSES,
    *stretch.CLASSES,
    *unwrap.CLASSES,
    *fixed_boundary.CLASSES,
    *sphere.CLASSES,
    *viewing.CLASSES,
    *sliding.CLASSES,
    *check.CLASSES,
    *transfer.CLASSES,
    *painting.CLASSES,
    *seam_margin.CLASSES,
    *wallpaper.CLASSES,
    *ordinary.CLASSES,
)
