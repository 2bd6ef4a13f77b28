# SPDX-License-Identifier: GPL-3.0-or-later
"""Icons of the signatures' tiles for menus, drawn when they are first wanted."""

from __future__ import annotations

from typing import Optional

import bpy.utils.previews

from . import core, tile_icon

SIZE = 64


class _Icons:
    collection: Optional[bpy.utils.previews.ImagePreviewCollection] = None


def tile(signature: str) -> int:
    """The number of the icon for `icon_value`; 0 where the library cannot draw the tile."""
    if _Icons.collection is None:
        _Icons.collection = bpy.utils.previews.new()
    if signature not in _Icons.collection:
        try:
            pixels = tile_icon.tile_pixels(signature, SIZE).ravel()
        except core.OrbifoldError:
            return 0
        preview = _Icons.collection.new(signature)
        preview.image_size = preview.icon_size = (SIZE, SIZE)
        preview.image_pixels_float.foreach_set(pixels)
        preview.icon_pixels_float.foreach_set(pixels)
    return _Icons.collection[signature].icon_id


def clear() -> None:
    if _Icons.collection is not None:
        bpy.utils.previews.remove(_Icons.collection)
        _Icons.collection = None
