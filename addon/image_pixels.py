# SPDX-License-Identifier: GPL-3.0-or-later
"""The pixels of a Blender image as arrays, in the numbers that it keeps, and undo steps of them."""

from __future__ import annotations

import hashlib
from typing import Optional

import bpy
import numpy as np

ROWS = 64  # that are converted at a time, to stay in the processor's cache


def problem(image: bpy.types.Image) -> Optional[str]:
    """Why its pixels cannot be written; None where they can."""
    if image.source == "TILED":
        return f"{image.name} has UDIM tiles: take an image of one tile, which repeats"
    if image.library is not None:
        return f"{image.name} is linked from another file: make it local first"
    if image.source not in ("FILE", "GENERATED"):
        return f"{image.name} is a movie, a sequence or a render: take a still image"
    if not all(image.size):
        return f"{image.name} has no pixels: its file is missing or cannot be read"
    return None


def read(image: bpy.types.Image) -> np.ndarray:
    """(height, width, channels) from below: uint8, or float32 where the image keeps such, as for 16 bits."""
    width, height = image.size
    values = np.empty((height, width, image.channels), np.float32)
    image.pixels.foreach_get(values.ravel())
    if image.is_float:
        return values
    pixels = np.empty(values.shape, np.uint8)
    for row in range(0, height, ROWS):
        part = values[row : row + ROWS]
        part *= 255
        part += 0.5
        pixels[row : row + ROWS] = part
    return pixels


def read_colours(image: bpy.types.Image) -> np.ndarray:
    """(height, width, 4) float32, whatever its channels."""
    pixels = read(image)
    values = pixels / np.float32(255) if pixels.dtype == np.uint8 else pixels
    colours = np.ones((*values.shape[:2], 4), np.float32)
    n = values.shape[2]
    colours[:, :, :3] = values[:, :, : min(n, 3)] if n != 2 else values[:, :, :1]
    if n in (2, 4):
        colours[:, :, 3] = values[:, :, -1]
    return colours


def write(image: bpy.types.Image, pixels: np.ndarray) -> None:
    """What `read` gives, or any other floats. As after a stroke the image is dirty: it has to be saved or packed."""
    if pixels.dtype == np.uint8:
        pixels = np.multiply(pixels, np.float32(1 / 255), dtype=np.float32)
    image.pixels.foreach_set(np.ascontiguousarray(pixels, np.float32).ravel())
    image.update()
    image.update_tag()  # without it version 5 shows a blend of old and new


def differing(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """(height, width) bool where two images of one shape are not the same to the bit."""
    if one.dtype == np.uint8 and one.shape[2] == 4:
        return one.view(np.uint32)[..., 0] != other.view(np.uint32)[..., 0]
    whole = np.uint32 if one.dtype == np.float32 else one.dtype
    return (one.view(whole) != other.view(whole)).any(2)


def changes(pixels: np.ndarray, before: np.ndarray) -> np.ndarray:
    """(height, width) uint8 how much the pixels of two images differ: 0 not at all, and 255 from white to black."""
    found = differing(pixels, before).astype(np.uint8)
    area = bounds(found)
    if area is not None:
        x, y, width, height = area
        part = np.s_[y : y + height, x : x + width]
        most = 255 if pixels.dtype == np.uint8 else 1
        size = np.abs(pixels[part].astype(np.float32) - before[part]).max(2) * (255 / most)
        found[part] *= np.clip(np.nan_to_num(size, nan=255.0), 1, 255).astype(np.uint8)
    return found


def bounds(mask: np.ndarray) -> Optional[tuple[int, int, int, int]]:
    """x, y, width, height of what is there of a mask (height, width); None where nothing is."""
    rows = np.flatnonzero(mask.any(1))
    if not len(rows):
        return None
    columns = np.flatnonzero(mask[rows[0] : rows[-1] + 1].any(0))
    return int(columns[0]), int(rows[0]), int(np.ptp(columns)) + 1, int(np.ptp(rows)) + 1


def digest(pixels: np.ndarray) -> bytes:
    return hashlib.sha1(pixels, usedforsecurity=False).digest()


def push_undo(image: bpy.types.Image) -> None:
    """One of Blender's undo steps for images, which takes all pixels from those of the last such step, if one is just
    before, to what they are now. Painting has steps of its own kind, and only operators of Blender's for images make
    others: this one inverts no channel. Without a window there is no undo, and it would end Blender."""
    if bpy.app.background:
        return
    with bpy.context.temp_override(edit_image=image):
        bpy.ops.image.invert(invert_r=False, invert_g=False, invert_b=False, invert_a=False)
