# SPDX-License-Identifier: GPL-3.0-or-later
"""Undo of what operators write into images.

Blender takes back strokes, but not pixels that a script sets. In object mode it takes back properties: so each image
has the number of the last edit (`Image.orbifold_edit`), and what was there before and after is kept in memory, for the
last few edits. When undo or redo has changed the number, the pixels follow.

Where images are painted undo is the images' only, and what a script has set is noticed by the next stroke. An operator
of Blender's that changes nothing stands in for a stroke, before and after: so what is between them is undone, but its
step is the second last one. Edit mode, whose undo is the mesh's only, has no such way.
"""

from __future__ import annotations

from dataclasses import dataclass
import bpy
import numpy as np
from bpy.app.handlers import persistent
from bpy.props import IntProperty

from . import image_pixels

MOST = 2**29  # bytes that are kept; of the last edit in any case


@dataclass(frozen=True)
class Edit:
    image: str  # its name
    earlier: int  # the edit before it
    before: np.ndarray
    after: np.ndarray

    @property
    def size(self) -> int:
        return self.before.nbytes + self.after.nbytes


class _State:
    edits: dict[int, Edit] = {}  # by number, the oldest first
    shown: dict[str, int] = {}  # image -> the edit whose pixels it has


def edit(context: bpy.types.Context, image: bpy.types.Image, before: np.ndarray, after: np.ndarray) -> None:
    """Write pixels as part of an operator that is one undo step, not in edit mode."""
    if _is_painting(context):
        _touch(context, image)
        image_pixels.write(image, after)
        _touch(context, image)
        return
    image_pixels.write(image, after)
    number = max([*_State.edits, *(other.orbifold_edit for other in bpy.data.images)], default=0) + 1
    _State.edits[number] = Edit(image.name, image.orbifold_edit, before.copy(), after.copy())
    image.orbifold_edit = _State.shown[image.name] = number
    while len(_State.edits) > 1 and sum(one.size for one in _State.edits.values()) > MOST:
        del _State.edits[next(iter(_State.edits))]


def _is_painting(context: bpy.types.Context) -> bool:
    area = context.area
    in_editor = area is not None and area.type == "IMAGE_EDITOR" and area.spaces.active.ui_mode == "PAINT"
    return in_editor or context.active_object.mode == "TEXTURE_PAINT"


def _touch(context: bpy.types.Context, image: bpy.types.Image) -> None:
    with context.temp_override(edit_image=image):
        bpy.ops.image.invert(invert_r=False, invert_g=False, invert_b=False, invert_a=False)


def _follow(image: bpy.types.Image) -> None:
    wanted, number = image.orbifold_edit, _State.shown.get(image.name, 0)
    pixels = None
    while number > wanted and number in _State.edits:  # undone
        pixels, number = _State.edits[number].before, _State.edits[number].earlier
    if number < wanted and wanted in _State.edits:  # redone
        pixels = _State.edits[wanted].after
    if pixels is not None and pixels.shape == (image.size[1], image.size[0], image.channels):
        image_pixels.write(image, pixels)
    _State.shown[image.name] = wanted


@persistent
def follow_all(*_arguments: object) -> None:
    edited = {one.image for one in _State.edits.values()}
    for image in bpy.data.images:
        if image.name in edited and image.library is None:
            _follow(image)


@persistent
def forget_removed(*_arguments: object) -> None:
    """Another image may get the name."""
    for name in [name for name in _State.shown if name not in bpy.data.images]:
        del _State.shown[name]


@persistent
def forget(*_arguments: object) -> None:
    """Another file: its images have nothing to do with these."""
    _State.edits.clear()
    _State.shown.clear()


HANDLERS = (
    ("undo_post", follow_all), ("redo_post", follow_all), ("depsgraph_update_post", forget_removed),
    ("load_pre", forget),
)


def register() -> None:
    bpy.types.Image.orbifold_edit = IntProperty(options={"HIDDEN"})
    for name, handler in HANDLERS:
        getattr(bpy.app.handlers, name).append(handler)


def unregister() -> None:
    for name, handler in HANDLERS:
        getattr(bpy.app.handlers, name).remove(handler)
    forget()
    del bpy.types.Image.orbifold_edit
