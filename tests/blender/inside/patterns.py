# SPDX-License-Identifier: GPL-3.0-or-later
"""Images to start from, seams that are filled, baking to ordinary UV maps, and what exporting makes of it."""

import os
import sys
import tempfile

import bpy
import numpy as np

sys.path.insert(0, os.path.dirname(__file__))
from harness import (  # noqa: E402
    blob, edit_mode, enable, object_mode, part, quad_blob, raises, run_checks, set_cones, user,
)

enable()
blender_mesh, image_pixels, materials = part("blender_mesh"), part("image_pixels"), part("materials")
baking, core, layouts, textures = part("baking"), part("core"), part("layouts"), part("textures")
fill, bake = bpy.ops.image.orbifold_fill_seam_margin, bpy.ops.object.orbifold_bake
SIDE = 7  # points on an edge


def unwrapped(signature="442", obj=None, **settings):
    obj = obj or blob(5)
    set_cones(obj, signature)
    assert bpy.ops.uv.orbifold_unwrap(**settings) == {"FINISHED"}
    return obj


def with_image(obj, size=64, pixels=None, name="Painted", is_float=True):
    """The object with a material that shows an image by the map Orbifold: noise, if it is not given."""
    if pixels is None:
        pixels = np.random.default_rng(3).random((size, size, 4)).astype(np.float32)
    image = bpy.data.images.new(name, pixels.shape[1], pixels.shape[0], alpha=True, float_buffer=is_float)
    image_pixels.write(image, pixels)
    obj.data.materials.clear()
    material = bpy.data.materials.new(name)
    materials.show_image(material, image, "REPEAT")
    materials.assign(obj, material)
    return image


def corners(obj, name="Orbifold"):
    """(m, 3) triangles and their UVs (m, 3, 2)."""
    arrays = blender_mesh.read_mesh(obj.data)
    return arrays, blender_mesh.read_uv(obj.data, name).astype(np.float64)[arrays.loops]


def function(points):
    """(p, 4) colours of points (p, 3) of space."""
    x, y, z = points.T
    waves = np.stack([np.sin(2 * x + y), np.cos(3 * z - x), np.sin(2 * y - z), 2 + 0 * x], 1)
    return (0.5 + 0.25 * waves).astype(np.float32)


def painted(arrays, uv, size):
    """(size, size, 4) the function, linear on triangles, on the islands, and black; whether they are there."""
    where, of, barycentric = baking.texels_of(uv, size, size)
    pixels, covered = np.zeros((size * size, 4), np.float32), np.zeros(size * size, bool)
    pixels[where] = np.einsum("pc,pcd->pd", barycentric, function(arrays.vertices)[arrays.triangles[of]])
    covered[where] = True
    return pixels.reshape(size, size, 4), covered.reshape(size, size)


def seams(triangles, uv):
    """Points along every edge whose two sides have different UVs: (k, 2), (k, 2)."""
    there, steps, found = {}, np.linspace(0, 1, SIDE)[:, None], []
    for face, ends in enumerate(triangles.tolist()):
        for c in range(3):
            there[ends[c], ends[c - 2]] = uv[face, c], uv[face, c - 2]
    for (a, b), (p, q) in there.items():
        if a < b and (b, a) in there:
            q_, p_ = there[b, a]
            if np.abs([p - p_, q - q_]).max() > 1e-6:
                found.append(((1 - steps) * p + steps * q, (1 - steps) * p_ + steps * q_))
    return [np.concatenate(side) for side in zip(*found)]


def jumps(pixels, sides, levels=3):
    """Of the image and smaller ones: the root of the mean square of the difference over all seams."""
    found = []
    for _ in range(levels):
        off = baking.sampled(pixels, sides[0]) - baking.sampled(pixels, sides[1])
        found.append(np.sqrt(np.square(off).mean()))
        if len(found) < levels:
            pixels = (pixels[::2, ::2] + pixels[1::2, ::2] + pixels[::2, 1::2] + pixels[1::2, 1::2]) / 4
    return np.array(found)


# ---------------------------------------------------------------------------------------- Fill Seam Margin


def coloured_material(obj, image):
    """Emits the function, as a colour attribute's values at corners; the image is what is baked to."""
    arrays = blender_mesh.read_mesh(obj.data)
    layer = obj.data.color_attributes.new("Function", "FLOAT_COLOR", "POINT")
    layer.data.foreach_set("color", function(blender_mesh.read_vertices(obj.data)).ravel())
    material = bpy.data.materials.new("Bake")
    blender_mesh.enable_nodes(material)
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    output, emission, colour = (nodes.new(f"ShaderNode{kind}") for kind in ("OutputMaterial", "Emission", "Attribute"))
    colour.attribute_name = "Function"
    links.new(colour.outputs["Color"], emission.inputs["Color"])
    links.new(emission.outputs["Emission"], output.inputs["Surface"])
    picture = nodes.new("ShaderNodeTexImage")
    picture.image, nodes.active = image, picture
    obj.data.materials.clear()
    obj.data.materials.append(material)
    return arrays


def plain_map(obj):
    """The layout as the active UV map Plain, in the unit square with room around it."""
    arrays, uv = corners(obj)
    loops = blender_mesh.read_uv(obj.data).astype(np.float64)
    loops = 0.05 + 0.9 * (loops - uv.min((0, 1))) / np.ptp(uv, axis=(0, 1)).max()
    blender_mesh.write_uv_of_loops(obj.data, loops, np.ones(len(loops), bool), "Plain")
    obj.data.uv_layers.active = obj.data.uv_layers["Plain"]
    obj.data.uv_layers["Plain"].active_render = True
    return corners(obj, "Plain")


def check_the_jump_at_seams_is_less_than_half_of_what_a_bake_leaves():
    """Blender bakes a function with each of its kinds of margin, which ours then replaces."""
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", 4, False
    for signature, settings in (
        ("442", {}), ("432", {"chart_spherical": "stereographic"}), ("22222", {"chart_hyperbolic": "poincare"}),
    ):
        obj = unwrapped(signature, **settings)
        arrays, uv = plain_map(obj)
        sides, ratios = seams(arrays.triangles, uv), {"EXTEND": [], "ADJACENT_FACES": []}
        assert len(sides[0]) > 100
        for size in (128, 256, 512, 1024):
            exact, covered = painted(arrays, uv, size)
            for kind, found in ratios.items():
                image = bpy.data.images.new("Target", size, size, float_buffer=True)
                image.colorspace_settings.name = "Non-Color"
                coloured_material(obj, image)
                assert bpy.ops.object.bake(type="EMIT", margin=16, use_clear=True, margin_type=kind) == {"FINISHED"}
                pixels = image_pixels.read(image)
                assert np.abs(pixels - exact)[covered].mean() < 5e-3
                image_pixels.write(image, np.where(covered[:, :, None], exact, pixels))  # without the bake's noise
                theirs = jumps(image_pixels.read(image), sides)
                assert fill() == {"FINISHED"}
                found.append(jumps(image_pixels.read(image), sides) / theirs)
                bpy.data.images.remove(image)
        assert np.max(ratios["EXTEND"]) < 0.5 and np.max(ratios["ADJACENT_FACES"]) < 1, (signature, ratios)
        assert np.mean(ratios["ADJACENT_FACES"]) < 0.5, (signature, ratios)


def painted_now():
    return image_pixels.read(bpy.data.images["Painted"])


def filled_in(mode, is_float):
    """The image before, after one fill, and after another one."""
    with_image(unwrapped("2222", blob(3)), is_float=is_float)
    bpy.ops.object.mode_set(mode=mode)
    bpy.ops.ed.undo_push(message="start")
    states = [painted_now()]
    for levels in (1, 3):
        assert user(fill, mip_levels=levels) == {"FINISHED"}
        states.append(painted_now())
    assert (states[0] != states[1]).any() and (states[1] != states[2]).any()
    return states


def check_one_undo_takes_a_fill_back_and_redo_brings_it_again():
    for is_float in (False, True):
        states = filled_in("OBJECT", is_float)
        undo, redo = bpy.ops.ed.undo, bpy.ops.ed.redo
        for step, state in ((undo, 1), (undo, 0), (redo, 1), (redo, 2), (undo, 1)):
            step()
            assert (painted_now() == states[state]).all(), (is_float, state)
        assert user(fill, mip_levels=2) == {"FINISHED"}  # another way on
        other = painted_now()
        undo()
        assert (painted_now() == states[1]).all()
        redo()
        assert (painted_now() == other).all()
        bpy.data.images.remove(bpy.data.images["Painted"])
        bpy.context.view_layer.update()
        image = with_image(bpy.context.object)  # of the same name, but another one
        pixels = image_pixels.read(image)
        for message in ("another", "later"):
            bpy.ops.ed.undo_push(message=message)
        undo()
        assert (painted_now() == pixels).all()
        bpy.data.images.remove(bpy.data.images["Painted"])


def check_fills_are_undone_in_texture_paint_mode():
    """Blender's own steps are between them, which change nothing."""
    for is_float in (False, True):
        states = filled_in("TEXTURE_PAINT", is_float)
        for step, sequence in ((bpy.ops.ed.undo, (2, 1, 0)), (bpy.ops.ed.redo, (0, 1, 2))):
            for here, there in zip(sequence, sequence[1:]):
                for _ in range(3):
                    assert (painted_now() == states[here]).all()
                    step()
                    if (painted_now() == states[there]).all():
                        break
                assert (painted_now() == states[there]).all(), (is_float, step, there)
        object_mode()
        bpy.data.images.remove(bpy.data.images["Painted"])


def check_islands_of_other_meshes_stay():
    """Two plates side by side in one image: the margin of one reaches across the other's island."""
    plates = []
    for left in (0.1, 0.51):
        bpy.ops.mesh.primitive_plane_add()
        plates.append(bpy.context.object)
        uv = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * 0.4 + (left, 0.3)
        blender_mesh.write_uv_of_loops(plates[-1].data, uv, np.ones(4, bool), "Orbifold")
    arrays = [corners(obj)[1] for obj in plates]
    covered = np.zeros(64 * 64, bool)
    for uv in arrays:
        covered[baking.texels_of(uv, 64, 64)[0]] = True
    for obj in plates:
        obj.data.uv_layers.active = obj.data.uv_layers["Orbifold"]
    image = with_image(plates[1])
    plates[0].data.materials.append(plates[1].active_material)
    before = image_pixels.read(image)
    plates[0].select_set(True)
    assert bpy.context.active_object == plates[1] and fill(mip_levels=5) == {"FINISHED"}
    changed = (image_pixels.read(image) != before).any(2).ravel()
    assert changed.sum() > 500 and not changed[covered].any()
    plates[0].select_set(False)
    assert fill(mip_levels=5) == {"FINISHED"}
    assert (image_pixels.read(image) != before).any(2).ravel()[covered].any()
    for obj in plates:
        bpy.data.objects.remove(obj)


def check_images_that_cannot_be_filled_are_refused():
    obj = unwrapped("442", blob(3))
    image = with_image(obj)
    image.source = "TILED"
    assert "UDIM" in raises(fill)
    image.source = "FILE"
    image.filepath = "//nowhere.png"
    image.reload()
    assert "no pixels" in raises(fill)
    edit_mode()
    assert "object mode or texture paint mode" in raises(fill)
    object_mode()
    with_image(obj)
    while obj.data.uv_layers:
        obj.data.uv_layers.remove(obj.data.uv_layers[0])
    assert "no UV map" in raises(fill)


# ------------------------------------------------------------------------------------------- new images


def shown(obj):
    """The image, and what it is shown by."""
    texture = textures.find(obj)
    node = texture.material.node_tree.nodes[texture.node]
    assert texture.uv_map == "Orbifold" and node.extension == "REPEAT" and texture.image.packed_file
    return texture.image


def is_invariant(obj, image):
    arrays = blender_mesh.read_mesh(obj.data)
    layout = layouts.read(obj.data, arrays)
    pixels = image_pixels.read(image)
    again = pixels.copy()
    part("symmetric_image").symmetry_of(obj.name, layout).wallpaper(*image.size).symmetrize(again)
    return np.abs(again.astype(float) - pixels).max() * (1 if image.is_float else 1 / 255) < 1e-6


def check_pattern_images_fit_the_layout():
    for signature, kind, size, chart in (
        ("442", "WEAVE", (512, 512), "periodic"), ("2222", "BRICKS", None, "periodic"),
        ("333", "TRIANGLES", (512, 888), "periodic"), ("632", "HEXAGONS", (512, 888), "periodic"),
        ("442", "QUADS", (512, 512), "conformal"),  # texels do not go to texels
    ):
        obj = unwrapped(signature, chart_euclidean=chart)
        assert bpy.ops.object.orbifold_pattern_image(pattern=kind, size=512) == {"FINISHED"}
        image = shown(obj)
        assert tuple(image.size) == (size or tuple(image.size)) and is_invariant(obj, image)
        pixels = image_pixels.read(image) / 255
        assert 0.2 < (pixels[:, :, 0] > 0.5).mean() < 0.9
        arrays, uv = corners(obj)
        to_texels = kind in ("WEAVE", "BRICKS")
        assert jumps(pixels, seams(arrays.triangles, uv), 1)[0] < (1e-3 if to_texels else 0.1)
    assert "do not fit" in raises(bpy.ops.object.orbifold_pattern_image, pattern="BRICKS")
    obj = unwrapped("432")
    assert "a signature of the plane" in raises(bpy.ops.object.orbifold_pattern_image, pattern="WEAVE")
    obj = unwrapped("333", chart_euclidean="conformal")
    assert "layout Periodic" in raises(bpy.ops.object.orbifold_pattern_image, pattern="HEXAGONS")


def check_a_wallpaper_shows_the_picture_on_the_tile():
    for signature, is_float in (("442", False), ("2222", True), ("333", False)):
        obj = unwrapped(signature)
        arrays, uv = corners(obj)
        v, u = (np.mgrid[:200, :300] + 0.5) / [[[200]], [[300]]]
        pixels = np.stack([u, v, 0.5 + 0.5 * np.sin(9 * u * v), 1 + 0 * u], 2).astype(np.float32)
        picture = bpy.data.images.new("Picture", 300, 200, float_buffer=is_float)
        image_pixels.write(picture, pixels)
        before = image_pixels.read(picture)
        images = []
        for blend in (0, 0.8):
            wallpaper = bpy.ops.image.orbifold_wallpaper
            assert wallpaper(picture="Picture", size=300, blend=blend, whole=True) == {"FINISHED"}
            images.append(shown(obj))
            assert images[-1].is_float == is_float and is_invariant(obj, images[-1])
        assert (image_pixels.read(picture) == before).all()
        low, extent = uv.min((0, 1)), np.ptp(uv, axis=(0, 1))
        middles = uv.mean(1)
        off = [np.abs(baking.sampled(image_pixels.read_colours(one), middles)
                      - baking.sampled(pixels, (middles - low) / extent))[:, :2] for one in images]
        assert np.quantile(off[0], 0.9) < 0.03 < off[1].mean(), (signature, off[0].max())  # others are at the border
        for image in (picture, *images):
            bpy.data.images.remove(image)
    assert "Choose a picture" in raises(bpy.ops.image.orbifold_wallpaper, picture="Nothing")


def check_a_new_image_is_taken_back_by_one_undo():
    obj = unwrapped("442", blob(3))
    name, count = obj.name, len(bpy.data.images)
    bpy.ops.ed.undo_push(message="start")
    assert user(bpy.ops.object.orbifold_pattern_image, pattern="QUADS", size=64) == {"FINISHED"}
    pixels = image_pixels.read(shown(obj))
    bpy.ops.ed.undo()
    assert len(bpy.data.images) == count and bpy.data.objects[name].active_material is None
    bpy.ops.ed.redo()
    assert (image_pixels.read(shown(bpy.data.objects[name])) == pixels).all()


# ------------------------------------------------------------------------------------------ other programs


def check_baking_to_an_ordinary_uv_map():
    obj = unwrapped("442", quad_blob(9))
    smooth = np.indices((256, 256)).sum(0) * (2 * np.pi / 256)
    pixels = np.stack([0.5 + 0.4 * np.sin(smooth), 0.5 + 0.4 * np.cos(smooth), 0 * smooth, 1 + 0 * smooth], 2)
    image = with_image(obj, pixels=pixels.astype(np.float32))
    obj.data.polygons[3].hide = True
    hidden, selected = [face.hide for face in obj.data.polygons], [face.select for face in obj.data.polygons]
    before = image_pixels.read(image)
    assert bake(size=512) == {"FINISHED"}
    assert [face.hide for face in obj.data.polygons] == hidden
    assert [face.select for face in obj.data.polygons] == selected and bpy.context.selected_objects == [obj]
    assert bpy.context.active_object == obj and (image_pixels.read(image) == before).all()
    texture = textures.find(obj)
    assert texture.uv_map == "Baked" and tuple(texture.image.size) == (512, 512) and texture.image.is_float
    arrays, uv = corners(obj)
    _, baked_uv = corners(obj, "Baked")
    assert 0 <= baked_uv.min() and baked_uv.max() <= 1
    found = image_pixels.read(texture.image)
    wanted = baking.sampled(before, uv.mean(1))
    assert np.abs(baking.sampled(found, baked_uv.mean(1)) - wanted).max() < 0.05
    at_edges = [baking.sampled(found, (baked_uv[:, k] + baked_uv[:, k - 1]) / 2) for k in range(3)]
    along = [baking.sampled(before, (uv[:, k] + uv[:, k - 1]) / 2) for k in range(3)]
    assert np.abs(np.subtract(at_edges, along)).mean() < 0.01
    assert "already" in raises(bake, uv_map="Baked")
    assert "has no UV map Other" in raises(bake, uv_map="Other")
    plain_map(obj)
    assert bake(size=64, uv_map="Plain") == {"FINISHED"} and textures.find(obj).uv_map == "Plain"


def check_an_image_that_repeats_survives_gltf():
    if not hasattr(bpy.ops.export_scene, "gltf"):
        return
    obj = unwrapped("442")
    image = with_image(obj, is_float=False)
    image.pack()
    pixels = image_pixels.read(image)
    triangles, uv = corners(obj)
    middles = np.array([face.center[:] for face in obj.data.polygons])
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "painted.glb")
        bpy.ops.export_scene.gltf(filepath=path, export_format="GLB", use_selection=True)
        with open(path, "rb") as file:
            data = file.read()
        assert b'"wrapS":33071' not in data and b'"wrapS":33648' not in data  # clamped, mirrored
        bpy.data.images.remove(image)
        for other in list(bpy.data.objects):
            bpy.data.objects.remove(other)
        with part("headless.importers")._numpy_bool():
            bpy.ops.import_scene.gltf(filepath=path)
        found = next(other for other in bpy.data.objects if other.type == "MESH")
        node = textures.node_of(found)
        assert node.extension == "REPEAT" and (image_pixels.read(node.image) == pixels).all()
        there = np.array([face.center[:] for face in found.data.polygons])
        _, uv_there = corners(found, found.data.uv_layers[0].name)
        order = np.linalg.norm(there[:, None] - middles[None], axis=2).argmin(1)
        assert len(set(order.tolist())) == len(middles)
        off = np.sort(uv_there.reshape(len(order), -1), 1) - np.sort(uv[order].reshape(len(order), -1), 1)
        assert np.abs(off).max() < 1e-6


run_checks(globals())
