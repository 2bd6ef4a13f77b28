# SPDX-License-Identifier: GPL-3.0-or-later
"""Symmetric Painting: while it is on, a stroke on an image of unwrapped objects is repeated at all copies when it is
released.

Blender tells that an image has changed, not where: the pixels are compared with those from before. A stroke and its
copies are two undo steps of Blender's, so that it restores the image by itself, whether or not this is on. Between the
two is an image with the stroke and without copies. Such images are known by a digest, and undo and redo do not stop at
them.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Optional

import bpy
import numpy as np
from bpy.app.handlers import persistent

from . import blender_mesh, core, image_pixels, layouts, overlay, symmetric_image
from .symmetric_image import Symmetry

WALLPAPERS = 3  # that are kept; each is two bytes a texel
HALVES = 2  # of one stroke at most (_painted_in_editors)
SCENERY = (bpy.types.Object, bpy.types.Mesh, bpy.types.Material, bpy.types.NodeTree, bpy.types.Scene)


class _State:
    busy = False  # we are writing
    undoing = False
    passing = False  # undo and redo go on by themselves
    kept: dict[str, np.ndarray] = {}  # image -> its pixels after the last stroke
    halves: dict[str, set[bytes]] = {}  # image -> digests of its pixels with a stroke and without copies
    problems: dict[str, str] = {}  # image -> why strokes on it are not repeated
    symmetries: dict[tuple, Symmetry] = {}
    wallpapers: dict[tuple, core.Wallpaper] = {}  # the last used one is the last


def is_on() -> bool:
    return getattr(bpy.context.window_manager, "orbifold_symmetric_painting", False)


def problem(image: bpy.types.Image) -> Optional[str]:
    """Why strokes on it are not repeated; for the panel."""
    return _State.problems.get(image.name_full) if is_on() else None


# ------------------------------------------------------------------------------------ objects and their images


def images_of(obj: bpy.types.Object) -> list[bpy.types.Image]:
    """Those of the image textures in its materials, the active material's active one first."""
    found: list[bpy.types.Image] = []
    materials = [obj.active_material, *(slot.material for slot in obj.material_slots)]
    for tree in [material.node_tree for material in materials if material is not None and material.node_tree]:
        for node in sorted(tree.nodes, key=lambda node: node != tree.nodes.active):
            if node.type == "TEX_IMAGE" and node.image is not None and node.image not in found:
                found.append(node.image)
    return found


def image_in(context: bpy.types.Context) -> Optional[bpy.types.Image]:
    """The image editor's, or the one that the active object shows."""
    space = context.space_data
    if space is not None and space.type == "IMAGE_EDITOR" and space.image is not None:
        return space.image
    obj = context.active_object
    return next(iter(images_of(obj)), None) if obj is not None and obj.type == "MESH" else None


def _unwrapped(view_layer: bpy.types.ViewLayer) -> Iterator[bpy.types.Object]:
    """The view layer's unwrapped objects, the active one first."""
    there = sorted(view_layer.objects, key=lambda obj: obj != view_layer.objects.active)
    return (obj for obj in there if obj.type == "MESH" and layouts.has_layout(obj.data))


def symmetry_for(image: bpy.types.Image) -> tuple[Symmetry, core.Wallpaper]:
    """Of the unwrapped objects that show the image; the tile is the active one's, if it is among them. BlenderMeshError
    where it has none."""
    unfit = image_pixels.problem(image)
    if unfit is not None:
        raise blender_mesh.BlenderMeshError(unfit)
    owners = [obj for obj in _unwrapped(bpy.context.view_layer) if image in images_of(obj)]
    if not owners:
        raise blender_mesh.BlenderMeshError(
            f"No unwrapped mesh shows {image.name}: use Orbifold Unwrap, or New Symmetric Image"
        )
    symmetry = symmetric_image.joined([symmetry_of(obj) for obj in owners], image.name)
    key = (symmetry.digest(), *image.size)
    wallpaper = _State.wallpapers.pop(key, None)
    if wallpaper is None:
        wallpaper = symmetry.wallpaper(*image.size)
    _State.wallpapers[key] = wallpaper
    while len(_State.wallpapers) > WALLPAPERS:
        _State.wallpapers.pop(next(iter(_State.wallpapers)))
    return symmetry, wallpaper


def symmetry_of(obj: bpy.types.Object) -> Symmetry:
    """Of an unwrapped object's layout. BlenderMeshError where it has none."""
    mesh = obj.data
    key = mesh.name_full, mesh.orbifold.unwraps, layouts.latest(mesh).arrays
    if key not in _State.symmetries:
        if obj.mode == "EDIT":
            raise blender_mesh.BlenderMeshError(f"The layout of {obj.name} cannot be read: leave edit mode")
        layout = layouts.read(mesh, blender_mesh.read_mesh(mesh))
        _State.symmetries[key] = symmetric_image.symmetry_of(obj.name, layout)
    return _State.symmetries[key]


def forget_layouts() -> None:
    """They may have changed."""
    _State.symmetries.clear()


# ---------------------------------------------------------------------------------------------------- strokes


def painted_since(image: bpy.types.Image, pixels: np.ndarray) -> Optional[np.ndarray]:
    """(height, width) uint8 how much the pixels, which are the image's, are not those of the last stroke or Symmetrize
    Image; None where those are not known."""
    before = _State.kept.get(image.name_full)
    if before is None or before.shape != pixels.shape or before.dtype != pixels.dtype:
        return None
    return image_pixels.changes(pixels, before)


def note_written(image: bpy.types.Image, pixels: np.ndarray) -> None:
    """These have been written to the image: it is symmetric."""
    _State.kept[image.name_full] = pixels
    _State.problems.pop(image.name_full, None)


def _repeat(image: bpy.types.Image) -> None:
    """Repeat what has been painted on an image since the last time."""
    if image_pixels.problem(image) is not None:
        return
    pixels = image_pixels.read(image)
    painted = painted_since(image, pixels)
    _State.kept[image.name_full] = pixels
    area = image_pixels.bounds(painted) if painted is not None else None
    if area is None:
        return
    try:
        _, wallpaper = symmetry_for(image)
    except (core.OrbifoldError, blender_mesh.BlenderMeshError) as error:
        _fail(image, error)
        return
    result = pixels.copy()
    wallpaper.symmetrize(result, "painted", painted, area)
    if image_pixels.differing(result, pixels).any():
        _State.halves.setdefault(image.name_full, set()).add(image_pixels.digest(pixels))
        write_with_undo(image, *([pixels] if _painted_in_editors(image) else []), result)
    note_written(image, result)


def _painted_in_editors(image: bpy.types.Image) -> bool:
    """Whether an image editor shows it to be painted on. The undo step of such a stroke, unlike that of one on the
    mesh, counts the image as a tile, and Blender's other operators do not find what it leaves: they need a step of
    their own with that."""
    screens = [window.screen for window in bpy.context.window_manager.windows]
    spaces = [area.spaces.active for screen in screens for area in screen.areas if area.type == "IMAGE_EDITOR"]
    return any(space.mode == "PAINT" and space.image == image for space in spaces)


def _fail(image: bpy.types.Image, error: Exception) -> None:
    sentence = str(error).rstrip(".")
    _State.problems[image.name_full] = sentence[:1].upper() + sentence[1:]
    overlay.redraw()


def write_with_undo(image: bpy.types.Image, *states: np.ndarray) -> None:
    """Write these pixels, and make each of them an undo step."""
    _State.busy = True
    try:
        for pixels in states:
            image_pixels.write(image, pixels)
            image_pixels.push_undo(image)
    finally:
        _State.busy = False
    overlay.redraw()


def push_later(image: bpy.types.Image, before: np.ndarray, after: np.ndarray) -> None:
    """Make an undo step of what an operator has written to an image, after the operator's own, which has no pixels."""
    if not bpy.app.background:
        bpy.app.timers.register(partial(_push, image.name_full, before, after))


def _push(name: str, before: np.ndarray, after: np.ndarray) -> None:
    image = _named(name)
    if image is not None and tuple(image.size) == after.shape[1::-1]:
        if not image_pixels.differing(image_pixels.read(image), after).any():
            write_with_undo(image, before, after)


def _named(name: str) -> Optional[bpy.types.Image]:
    return next((image for image in bpy.data.images if image.name_full == name), None)


# ----------------------------------------------------------------------------------------------- what happens


def _watch() -> None:
    """Keep the pixels of the images that unwrapped objects show, before there is a stroke on them."""
    view_layer = getattr(bpy.context, "view_layer", None)  # none while Blender starts or renders
    if view_layer is None:
        return
    shown = {image.name_full: image for obj in _unwrapped(view_layer) for image in images_of(obj)}
    for name in _State.kept.keys() - shown.keys():
        del _State.kept[name]
    for name in shown.keys() - _State.kept.keys():
        if image_pixels.problem(shown[name]) is None:
            _State.kept[name] = image_pixels.read(shown[name])


@persistent
def notice(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    if not is_on() or _State.busy or _State.undoing:
        return
    updates = [(update.id.original, update.is_updated_geometry) for update in depsgraph.updates]
    if any(isinstance(one, bpy.types.Mesh) and geometry for one, geometry in updates):
        forget_layouts()
    for one, _ in updates:
        if isinstance(one, bpy.types.Image) and one.name_full in _State.kept:
            _repeat(one)
    if any(isinstance(one, SCENERY) for one, _ in updates):
        _watch()


@persistent
def before_undo(*_arguments: object) -> None:
    _State.undoing = True


@persistent
def after_undo(*_arguments: object) -> None:
    _look_again("undo")


@persistent
def after_redo(*_arguments: object) -> None:
    _look_again("redo")


def _look_again(direction: str) -> None:
    """Go on in the same direction where an image has a stroke and not its copies; not at once, for Blender may crash
    where one undo is called within another."""
    _State.undoing = False
    forget_layouts()
    if not _State.passing and _is_at_half() and not bpy.app.background:
        bpy.app.timers.register(partial(_pass_halves, direction))


def _is_at_half() -> bool:
    """Whether an image is; all that are known are read."""
    found = False
    for image in bpy.data.images:
        name = image.name_full
        if (name in _State.kept or name in _State.halves) and image_pixels.problem(image) is None:
            pixels = image_pixels.read(image)
            halves = _State.halves.get(name, ())
            found |= bool(halves) and image_pixels.digest(pixels) in halves
            if name in _State.kept:
                _State.kept[name] = pixels
    return found


def _pass_halves(direction: str) -> None:
    step = getattr(bpy.ops.ed, direction)
    _State.passing = True
    try:
        with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
            left = HALVES
            while _is_at_half() and left and step.poll():
                step()
                left -= 1
    finally:
        _State.passing = False


@persistent
def forget(*_arguments: object) -> None:
    """Another file is loaded."""
    bpy.context.window_manager.orbifold_symmetric_painting = False
    clear()


def clear() -> None:
    _State.busy = _State.undoing = _State.passing = False
    for there in (_State.kept, _State.halves, _State.problems, _State.symmetries, _State.wallpapers):
        there.clear()


def _switched(window_manager: bpy.types.WindowManager, context: bpy.types.Context) -> None:
    _State.kept.clear()
    _State.problems.clear()
    forget_layouts()
    if not window_manager.orbifold_symmetric_painting:
        return
    _watch()
    image = image_in(context)
    if image is not None:  # prepare, lest the first stroke waits for it; or say at once what is in the way
        try:
            symmetry_for(image)
        except (core.OrbifoldError, blender_mesh.BlenderMeshError) as error:
            _fail(image, error)


HANDLERS = (
    ("depsgraph_update_post", notice),
    ("undo_pre", before_undo),
    ("redo_pre", before_undo),
    ("undo_post", after_undo),
    ("redo_post", after_redo),
    ("load_post", forget),
)


def register() -> None:
    bpy.types.WindowManager.orbifold_symmetric_painting = bpy.props.BoolProperty(
        name="Symmetric Painting",
        description="A stroke of the brush, on the mesh or on the image, is repeated at all its copies when it is "
        "released, so that it is seamless. For images of meshes with a layout of the plane",
        options={"SKIP_SAVE"},
        update=_switched,
    )
    for name, handler in HANDLERS:
        getattr(bpy.app.handlers, name).append(handler)


def unregister() -> None:
    for name, handler in HANDLERS:
        getattr(bpy.app.handlers, name).remove(handler)
    clear()
    del bpy.types.WindowManager.orbifold_symmetric_painting
