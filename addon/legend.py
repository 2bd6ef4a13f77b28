# SPDX-License-Identifier: GPL-3.0-or-later
"""The legend of a heat map, in the lower left corner of the 3D view, while the active object shows one."""

from __future__ import annotations

import blf
import bpy
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader

from . import heat

MARGIN, WIDTH, HEIGHT = 24, 18, 150  # in points of the interface
STEPS = 64
TEXT_SIZE = 12


def draw(context: bpy.types.Context) -> None:
    obj = context.active_object
    if obj is None or obj.type != "MESH" or not obj.visible_get():
        return
    measure = heat.shown(obj.data)
    shading = context.space_data.shading
    if measure is None or shading.type != "SOLID" or shading.color_type != "VERTEX":
        return
    scale = context.preferences.system.ui_scale or 1.0
    left, bottom = _corner(context, scale)
    values = np.array([value for value, _ in measure.ticks])
    heights = bottom + HEIGHT * scale * np.arange(len(values)) / (len(values) - 1)  # ticks at even distances
    levels = np.linspace(bottom, bottom + HEIGHT * scale, STEPS + 1)
    colours = heat.colours_of(measure.gain * np.interp(levels, heights, values))
    colours[:, :3] = _display(colours[:, :3])
    _rectangle(left - scale, bottom - scale, (WIDTH + 2) * scale, (HEIGHT + 2) * scale, (0.05, 0.05, 0.05, 1.0))
    ends = np.stack([np.stack([np.full(STEPS + 1, x), levels], 1) for x in (left, left + WIDTH * scale)], 1)
    places = np.column_stack([ends.reshape(-1, 2), np.zeros(2 * (STEPS + 1))])
    batch_for_shader(
        gpu.shader.from_builtin("SMOOTH_COLOR"), "TRI_STRIP",
        {"pos": places.astype(np.float32), "color": np.repeat(colours, 2, axis=0).astype(np.float32)},
    ).draw(gpu.shader.from_builtin("SMOOTH_COLOR"))
    blf.size(0, TEXT_SIZE * scale)
    blf.enable(0, blf.SHADOW)
    blf.shadow(0, 3, 0.0, 0.0, 0.0, 0.9)
    blf.color(0, 1.0, 1.0, 1.0, 1.0)
    for height, (_, text) in zip(heights, measure.ticks):
        _text(left + (WIDTH + 8) * scale, height - 4 * scale, text)
    _text(left, bottom + (HEIGHT + 12) * scale, measure.title)
    blf.disable(0, blf.SHADOW)


def _corner(context: bpy.types.Context, scale: float) -> tuple[float, float]:
    """Beside the toolbar, where it lies over the view, and above the panel of the last operator."""
    tools = next((region for region in context.area.regions if region.type == "TOOLS"), None)
    over = tools is not None and context.preferences.system.use_region_overlap and tools.width > 1
    last = next((region for region in context.area.regions if region.type == "HUD"), None)
    height = last.height if last is not None and last.height > 1 else 0
    return MARGIN * scale + (tools.width if over else 0), max(2 * MARGIN * scale, MARGIN * scale + height)


def _text(x: float, y: float, text: str) -> None:
    blf.position(0, x, y, 0)
    blf.draw(0, text)


def _rectangle(x: float, y: float, width: float, height: float, colour: tuple) -> None:
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    corners = [(x, y, 0), (x + width, y, 0), (x, y + height, 0), (x + width, y + height, 0)]
    batch = batch_for_shader(shader, "TRI_STRIP", {"pos": corners})
    shader.bind()
    shader.uniform_float("color", colour)
    batch.draw(shader)


def _display(linear: np.ndarray) -> np.ndarray:
    """sRGB, in which drawings are given."""
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055)
