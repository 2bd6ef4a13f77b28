# SPDX-License-Identifier: GPL-3.0-or-later
"""Symmetrize Image, New Symmetric Image, and Symmetric Painting with pixels that are written in place of a stroke."""

import os
import sys
import tempfile

import bpy
import numpy as np

sys.path.insert(0, os.path.dirname(__file__))
from harness import blob, enable, object_mode, part, raises, run_checks, set_cones  # noqa: E402

enable()
core, painting, image_pixels, symmetric_image = map(part, ("core", "painting", "image_pixels", "symmetric_image"))
ORDERS = {"2222": 2, "442": 4, "333": 6, "632": 12}


def unwrapped(signature="442", **settings):
    painting.clear()
    bpy.context.window_manager.orbifold_symmetric_painting = False
    for image in list(bpy.data.images):
        bpy.data.images.remove(image)
    obj = blob()
    set_cones(obj, signature)
    bpy.ops.uv.orbifold_unwrap(**settings)
    return obj


def beside(obj, signature, name="Other"):
    """Another object, with its own mesh and layout, that has the same materials."""
    other = obj.copy()
    other.data, other.name = obj.data.copy(), name
    bpy.context.scene.collection.objects.link(other)
    bpy.context.view_layer.objects.active = other
    set_cones(other, signature)
    bpy.ops.uv.orbifold_unwrap()
    bpy.context.view_layer.objects.active = obj
    return other


def noise(image, seed=0):
    width, height = image.size
    kind = np.float32 if image.is_float else np.uint8
    values = np.random.default_rng(seed).random((height, width, image.channels)) * (2 if image.is_float else 255)
    write(image, values.astype(kind))
    return image_pixels.read(image)


def write(image, pixels):
    """As Blender's brush: then the handlers are called."""
    image_pixels.write(image, pixels)
    bpy.context.view_layer.update()


def with_image(obj, width=64, **settings):
    bpy.ops.image.orbifold_new(name="Image", width=width, **settings)
    return painting.images_of(obj)[0]


def stroke(image, x, y, value):
    """A square of 5 texels."""
    pixels = image_pixels.read(image)
    pixels[y : y + 5, x : x + 5] = value
    write(image, pixels)
    return pixels


def switch(on=True):
    bpy.context.window_manager.orbifold_symmetric_painting = on


def is_symmetric(obj, image):
    """Whether nothing is left to do."""
    symmetry, wallpaper = painting.symmetry_for(image)
    pixels = image_pixels.read(image)
    same = pixels.copy()
    wallpaper.symmetrize(same)
    return bool((same == pixels).all())


def refused(image_or_obj, words):
    try:
        painting.symmetry_for(image_or_obj)
    except part("blender_mesh").BlenderMeshError as error:
        assert words in str(error), error
    else:
        raise AssertionError("not refused")


# -------------------------------------------------------------------------------------------------- symmetry


def check_a_layout_gives_the_motions_of_its_group():
    for signature, order in ORDERS.items():
        obj = unwrapped(signature)
        symmetry = painting.symmetry_of(obj)
        wallpaper = symmetry.wallpaper(64, 64)
        assert (wallpaper.order, wallpaper.exact) == (order, order < 5), signature
        kept = (wallpaper.to_tile == 0).mean() * order
        assert abs(kept - 1) < 0.1, (signature, kept)
        tall = 3**0.5 if order > 4 else 1 if order == 4 else symmetry.tallness
        assert abs(symmetry.tallness - tall) < 1e-4, (signature, symmetry.tallness)
    assert symmetry.height_for(2048) == 3548


def check_the_height_is_that_of_square_texels():
    """Between the tile's corners are as many texels as on the plane, in proportion, in all directions."""
    for signature in ("442", "333", "632"):
        obj = unwrapped(signature)
        layout = part("layouts").read(obj.data, part("blender_mesh").read_mesh(obj.data))
        size = np.array([600, painting.symmetry_of(obj).height_for(600)])
        texels, plane = layout.uv * size, layout.points[..., :2]
        lengths = [np.linalg.norm(where[:, 0] - where[:, 1], axis=1) for where in (texels, plane)]
        assert np.ptp(lengths[0] / lengths[1]) < 1e-2 * np.mean(lengths[0] / lengths[1]), signature


def check_layouts_on_which_no_image_repeats_are_refused():
    for settings, words in (
        (("333", dict(chart_euclidean="conformal")), "choose the layout Periodic"),
        (("432", {}), "a signature of the plane, such as 442 or 2222"), (("237", {}), "a signature of the plane"),
    ):
        unwrapped(settings[0], **settings[1])
        assert words in raises(bpy.ops.image.orbifold_new, width=64), settings
        assert not len(bpy.data.images)


# -------------------------------------------------------------------------------------------------- operators


def check_a_new_image_has_the_layout_s_shape_and_is_shown():
    for signature, height in (("442", 64), ("333", 112), ("632", 112)):
        obj = unwrapped(signature)
        image = with_image(obj)
        assert tuple(image.size) == (64, height), (signature, tuple(image.size))
        material = obj.active_material
        node = material.node_tree.nodes.active
        assert node.image == image and node.extension == "REPEAT"
        assert node.inputs["Vector"].links[0].from_node.uv_map == "Orbifold"
        assert {polygon.material_index for polygon in obj.data.polygons} == {obj.active_material_index}


def check_images_of_all_kinds_become_symmetric():
    for signature in ORDERS:
        for float_buffer in (False, True):
            obj = unwrapped(signature)
            image = with_image(obj, float_buffer=float_buffer)
            for source in ("tile", "all"):
                before = noise(image)
                assert bpy.ops.image.orbifold_symmetrize(source=source) == {"FINISHED"}
                after = image_pixels.read(image)
                assert (after != before).any() and is_symmetric(obj, image) and image.is_dirty
                bpy.ops.image.orbifold_symmetrize(source=source)
                assert (image_pixels.read(image) == after).all(), (signature, float_buffer, source)
                kept = painting.symmetry_for(image)[1].to_tile == 0
                assert source == "all" or (after[kept] == before[kept]).all()


def check_pixels_are_read_and_written_without_loss():
    image = bpy.data.images.new("All", 16, 16, alpha=True)
    pixels = np.arange(1024, dtype=np.uint32).astype(np.uint8).reshape(16, 16, 4)
    image_pixels.write(image, pixels)
    assert image_pixels.read(image).dtype == np.uint8 and (image_pixels.read(image) == pixels).all()
    bpy.data.images.remove(image)


def check_files_of_eight_and_sixteen_bits():
    for depth in ("8", "16"):
        obj = unwrapped()
        image = with_image(obj)
        noise(image)
        settings = bpy.context.scene.render.image_settings
        settings.file_format, settings.color_depth, settings.color_mode = "PNG", depth, "RGBA"
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "image.png")
            image.save_render(path)
            loaded = bpy.data.images.load(path)
            obj.active_material.node_tree.nodes.active.image = loaded
            assert not loaded.is_dirty and tuple(loaded.size) == (64, 64)
            bpy.ops.image.orbifold_symmetrize()
            assert loaded.is_dirty and loaded.source == "FILE" and is_symmetric(obj, loaded), depth
            assert loaded.is_float == (depth == "16")


def check_a_packed_image_stays_packed():
    obj = unwrapped()
    image = with_image(obj)
    noise(image)
    image.pack()
    bpy.ops.image.orbifold_symmetrize()
    assert image.packed_file is not None and image.is_dirty and is_symmetric(obj, image)
    image.pack()
    image.reload()
    assert is_symmetric(obj, image)


def check_images_that_cannot_be_written_are_refused():
    obj = unwrapped()
    assert "use New Symmetric Image" in raises(bpy.ops.image.orbifold_symmetrize)
    with_image(obj)
    node = obj.active_material.node_tree.nodes.active
    node.image = bpy.data.images.new("Tiles", 16, 16, tiled=True)
    assert "Tiles has UDIM tiles" in raises(bpy.ops.image.orbifold_symmetrize)
    node.image = bpy.data.images.new("Gone", 16, 16)
    node.image.source, node.image.filepath = "FILE", "//is_not_there.png"
    assert "Gone has no pixels" in raises(bpy.ops.image.orbifold_symmetrize)
    node.image = bpy.data.images.new("Film", 16, 16)
    node.image.source = "MOVIE"
    assert "Film is a movie" in raises(bpy.ops.image.orbifold_symmetrize)
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "library.blend")
        bpy.data.libraries.write(path, {bpy.data.images.new("Theirs", 16, 16)}, fake_user=True)
        with bpy.data.libraries.load(path, link=True) as (_, wanted):
            wanted.images = ["Theirs"]
        node.image = wanted.images[0]
        assert "Theirs is linked from another file" in raises(bpy.ops.image.orbifold_symmetrize)
        bpy.data.libraries.remove(bpy.data.libraries[0])


def check_in_edit_mode_and_in_paint_mode():
    obj = unwrapped()
    image = with_image(obj)
    for mode in ("EDIT", "TEXTURE_PAINT"):
        bpy.ops.object.mode_set(mode=mode)
        noise(image)
        bpy.ops.image.orbifold_symmetrize()
        assert obj.mode == mode
        object_mode()
        assert is_symmetric(obj, image)


def check_what_was_painted_since_the_last_time():
    obj = unwrapped()
    image = with_image(obj)
    noise(image)
    assert "is not known" in raises(bpy.ops.image.orbifold_symmetrize, source="painted")
    bpy.ops.image.orbifold_symmetrize(source="tile")
    before = image_pixels.read(image)
    stroke(image, 40, 50, 7)
    bpy.ops.image.orbifold_symmetrize(source="painted")
    changed = image_pixels.differing(image_pixels.read(image), before)
    assert changed.sum() == 100 and changed[50:55, 40:45].all() and is_symmetric(obj, image)


# ---------------------------------------------------------------------------------------------------- sharing


def check_objects_that_share_an_image():
    obj = unwrapped("442")
    image = with_image(obj)
    other = beside(obj, "442")
    assert painting.symmetry_for(image)[0].owner == obj.name
    bpy.context.view_layer.objects.active = other
    assert painting.symmetry_for(image)[0].owner == "Other"
    noise(image)
    bpy.ops.image.orbifold_symmetrize()
    assert is_symmetric(other, image)
    bpy.context.view_layer.objects.active = obj
    beside(obj, "333", "Third")
    refused(image, "Blob (442) and Third (333) share Image")
    assert "different symmetries" in raises(bpy.ops.image.orbifold_symmetrize)


# ---------------------------------------------------------------------------------------------------- strokes


def check_a_stroke_is_repeated_and_nothing_else():
    for signature, order in ORDERS.items():
        obj = unwrapped(signature)
        image = with_image(obj)
        before = noise(image)
        bpy.ops.image.orbifold_symmetrize()
        before = image_pixels.read(image)
        switch()
        assert painting.problem(image) is None
        stroke(image, 9, 12, 3)
        after = image_pixels.read(image)
        changed = image_pixels.differing(after, before)
        assert 0.6 < changed.sum() / (25 * order) < 2.5, (signature, changed.sum())
        assert is_symmetric(obj, image) and order > 4 or (after[12:17, 9:14] == 3).all()
        bpy.context.view_layer.update()
        assert (image_pixels.read(image) == after).all()


def check_without_the_switch_nothing_is_repeated():
    obj = unwrapped()
    image = with_image(obj)
    noise(image)
    switch()
    switch(False)
    wanted = stroke(image, 9, 12, 3)
    assert (image_pixels.read(image) == wanted).all() and not painting._State.kept


def check_no_handler_runs_away():
    """The image's own update by the copies is no stroke, also where numbers are none."""
    obj = unwrapped("632")
    image = with_image(obj, float_buffer=True)
    noise(image)
    switch()
    real, calls = image_pixels.write, []

    def counted(*arguments):
        calls.append(arguments)
        real(*arguments)

    pixels = image_pixels.read(image)
    pixels[20:25, 20:25] = np.nan
    write(image, pixels)
    image_pixels.write = counted
    try:
        for _ in range(5):
            image.update_tag()
            bpy.context.view_layer.update()
    finally:
        image_pixels.write = real
    assert not calls


def check_a_stroke_on_a_shared_image_and_one_that_does_not_fit():
    obj = unwrapped()
    image = with_image(obj)
    noise(image)
    bpy.ops.image.orbifold_symmetrize()
    other = beside(obj, "442")
    switch()
    bpy.context.view_layer.objects.active = other
    stroke(image, 30, 3, 9)
    assert is_symmetric(other, image)
    beside(obj, "2222", "Third")
    wanted = stroke(image, 10, 3, 9)
    assert (image_pixels.read(image) == wanted).all()
    assert "share Image" in painting.problem(image)


def check_an_image_that_comes_later_or_goes():
    obj = unwrapped()
    switch()
    image = with_image(obj)
    bpy.context.view_layer.update()
    assert set(painting._State.kept) == {"Image"}
    stroke(image, 9, 12, 3)
    assert is_symmetric(obj, image)
    bpy.data.images.remove(image)
    bpy.context.view_layer.update()
    assert not painting._State.kept


def check_a_resized_image_is_taken_as_it_is():
    obj = unwrapped()
    image = with_image(obj)
    noise(image)
    switch()
    image.scale(32, 32)
    image.update_tag()
    bpy.context.view_layer.update()
    assert painting._State.kept["Image"].shape == (32, 32, 4)
    bpy.ops.image.orbifold_symmetrize()
    stroke(image, 4, 5, 3)
    assert is_symmetric(obj, image)


def check_another_file_switches_it_off():
    obj = unwrapped()
    with_image(obj)
    switch()
    assert painting._State.kept
    bpy.ops.wm.read_homefile(use_empty=True)
    assert not painting.is_on() and not painting._State.kept and not painting._State.wallpapers


run_checks(globals())
