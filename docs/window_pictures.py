# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of the real window for the user guide, of the sample creature; make_window_pictures.sh starts this inside
Blender. Arguments: the folder to write to, and the names of pictures, all if there is none.

Each function of SCENES does the steps of one picture (picture_window.py)."""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Generator, Sequence

import bmesh
import bpy
import numpy as np
from mathutils import Vector

sys.path.insert(0, os.path.dirname(__file__))
from picture_window import (  # noqa: E402
    area_of, arrange, away, click, drive, inside, look, no_uv_editor, pause, photograph, pointer, press, region_of,
    SCALE, scroll, set_up, shade, tab, uv_editor, window,
)

NAME = "orbifold_uv"
PLACES = {  # of vertices on the creature: the nearest one is picked
    "ear": (0.82, -0.74, 3.34), "other ear": (-0.82, -0.74, 3.34), "tail": (0, 1.02, 2.52),
}
folder, wanted = sys.argv[sys.argv.index("--") + 1], sys.argv[sys.argv.index("--") + 2 :]


def part(name: str):
    return importlib.import_module(f"{NAME}.{name}")


# ----------------------------------------------------------------------------------------------------- the mesh


def creature(subdivisions: int = 3) -> bpy.types.Object:
    """A new one, the only object, active."""
    if bpy.context.object is not None and bpy.context.object.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    for data in (bpy.data.objects, bpy.data.meshes, bpy.data.materials, bpy.data.images):
        for item in list(data):
            data.remove(item)
    sample = part("headless.sample")
    sample.SUBDIVISIONS = subdivisions
    obj = sample.make_creature()
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    bpy.ops.ed.undo_push(message="creature")
    return obj


def nearest(obj: bpy.types.Object, place: tuple[float, float, float]) -> int:
    points = np.empty(3 * len(obj.data.vertices))
    obj.data.vertices.foreach_get("co", points)
    return int(np.linalg.norm(points.reshape(-1, 3) - place, axis=1).argmin())


def pick(obj: bpy.types.Object, places: Sequence[str]) -> None:
    """Go to edit mode and click these vertices in turn."""
    vertices = [nearest(obj, PLACES[place]) for place in places]
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    bm = bmesh.from_edit_mesh(obj.data)
    bm.verts.ensure_lookup_table()
    bm.select_history.clear()
    for vertex in vertices:
        bm.verts[vertex].select = True
        bm.select_history.add(bm.verts[vertex])
    bmesh.update_edit_mesh(obj.data)


def unwrap(obj: bpy.types.Object, **settings) -> Generator:
    """As by the button, and wait until it is done."""
    before = obj.data.orbifold.unwraps
    with inside():
        bpy.ops.uv.orbifold_unwrap("INVOKE_DEFAULT", True, **settings)
    yield lambda: obj.data.orbifold.unwraps != before
    yield


def fit_uv() -> None:
    with inside("IMAGE_EDITOR"):
        bpy.ops.image.view_all(fit_view=True)


# ---------------------------------------------------------------------------------------------------- the scenes


def one_click() -> Generator:
    yield from bare()
    yield from unwrap(bpy.context.object)
    yield from photograph(f"{folder}/one_click.png")


def redo() -> Generator:
    """The panel of the last operator, unfolded by a click on its title."""
    yield from bare()
    look(SIDE, (0, 0.4, 0.8), 1.3 * FAR)
    yield from unwrap(bpy.context.object)
    yield from pause()
    region = region_of("VIEW_3D", "HUD")
    title = (region.x + region.width // 2, region.y + region.height // 2)
    yield from click(*title)
    yield from away()
    yield from photograph(f"{folder}/redo.png")
    yield from click(title[0], region.y + region.height - 12)
    yield from away()


def picking() -> Generator:
    yield from bare(1)
    pick(bpy.context.object, EARS_AND_TAIL)
    with inside():
        bpy.ops.mesh.orbifold_add_cones("INVOKE_DEFAULT", True)
    yield from photograph(f"{folder}/picking.png")


def signatures() -> Generator:
    """The menu beside the signature."""
    yield from bare(1)
    pick(bpy.context.object, EARS_AND_TAIL)
    with inside():
        bpy.ops.mesh.orbifold_add_cones("INVOKE_DEFAULT", True)
    bpy.context.preferences.view.ui_scale = 0.95  # for three columns side by side
    yield from pause()
    yield from pointer(window().width // 2, 0.6 * window().height)
    with inside():
        bpy.ops.wm.call_menu(name="MESH_MT_orbifold_signatures")
    yield from photograph(f"{folder}/signatures.png", (0.004, 0.338, 0.853, 0.813))
    press("ESC")
    bpy.context.preferences.view.ui_scale = SCALE
    yield from pause()


def layout() -> Generator:
    """Edit mode, with the layout beside the mesh."""
    yield from beside()
    yield from photograph(f"{folder}/layout.png")


def heat() -> Generator:
    yield from three_cones()
    with inside():
        bpy.ops.mesh.orbifold_show_distortion(measure="AREA")
    yield from tab("Show")
    yield from photograph(f"{folder}/heat.png")
    with inside():
        bpy.ops.mesh.orbifold_hide_distortion()


def pattern() -> Generator:
    """The tile preview, and a pattern over mesh and tile."""
    yield from three_cones()
    bpy.context.scene.orbifold_view.pattern = "QUADS"
    with inside():
        bpy.ops.object.orbifold_pattern("INVOKE_DEFAULT", True)
        bpy.ops.object.orbifold_tile_preview("INVOKE_DEFAULT", True)
    yield from tab("Show")
    look((80, 0, 10), (2.8, 0, 1.7), 1.6 * FAR)
    shade("MATERIAL")
    yield from pause(40)
    yield from photograph(f"{folder}/pattern.png", (0, 0, 1, 0.85))


def suggesting() -> Generator:
    """The table of suggestions, and the stretch that the first one promises."""
    yield from bare()
    obj = bpy.context.object
    with inside():
        bpy.ops.mesh.orbifold_suggest_cones("INVOKE_DEFAULT", True)
    yield lambda: len(obj.data.orbifold.suggestions.rows)
    with inside():
        bpy.ops.mesh.orbifold_place_suggestion("INVOKE_DEFAULT", True, index=0)
        bpy.ops.mesh.orbifold_show_stretch()
    yield from photograph(f"{folder}/suggesting.png")
    with inside():
        bpy.ops.mesh.orbifold_hide_distortion()


def checking() -> Generator:
    """A mesh with faults: a hole, a doubled face, a flipped one."""
    yield from bare(1)
    obj = bpy.context.object
    bm = bmesh.new()
    bm.from_mesh(obj.data)
    bm.faces.ensure_lookup_table()
    near = sorted(bm.faces, key=lambda face: (face.calc_center_median() - Vector((0.5, -0.2, 1.3))).length)
    near[0].normal_flip()
    fin = bm.verts.new(near[6].calc_center_median() + Vector((0.5, -0.1, 0.3)))
    bm.faces.new((*near[6].edges[0].verts, fin))
    bmesh.ops.delete(bm, geom=near[12:15], context="FACES")
    bm.to_mesh(obj.data)
    bm.free()
    with inside():
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.orbifold_check("INVOKE_DEFAULT", True)
    yield from scroll(12)
    yield from photograph(f"{folder}/checking.png")
    yield from scroll(-12)


def painting() -> Generator:
    """The image that the script of painting.md makes, and the creature's neck, where the cut runs through it."""
    yield from petals()
    yield from photograph(f"{folder}/painting.png")
    area_of("VIEW_3D").spaces.active.show_region_ui = True
    yield


def stroke() -> Generator:
    """A stroke of the brush across the cut, with Symmetric Painting."""
    yield from petals()
    image, region = bpy.data.images["Petals"], region_of("VIEW_3D")
    before = pixels_of(image)
    with inside():
        bpy.ops.object.mode_set(mode="TEXTURE_PAINT")
        bpy.context.window_manager.orbifold_symmetric_painting = True
        bpy.context.tool_settings.image_paint.brush.color = (1.0, 1.0, 1.0)
        bpy.ops.paint.image_paint(stroke=[
            {"name": "", "location": (0, 0, 0), "mouse": place, "mouse_event": place, "x_tilt": 0.0, "y_tilt": 0.0,
             "pressure": 1.0, "size": 25, "pen_flip": False, "time": 0.05 * number, "is_start": number == 0}
            for number, place in enumerate((x * region.width, 0.35 * region.height) for x in np.linspace(0.45, 0.7, 20))
        ])
    yield from pause(40)
    changed = np.abs(pixels_of(image) - before).max(2) > 0.01
    followed = [int((changed & np.rot90(changed, quarter)).sum()) for quarter in (1, 2, 3)]
    print(f"picture: {changed.sum()} pixels painted, of which their copies have {followed}", flush=True)
    yield from photograph(f"{folder}/stroke.png")
    bpy.context.window_manager.orbifold_symmetric_painting = False
    bpy.ops.object.mode_set(mode="OBJECT")
    area_of("VIEW_3D").spaces.active.show_region_ui = True
    yield


def wallpaper() -> Generator:
    """The wallpaper that is made from a picture without any symmetry, and the creature with it."""
    yield from folded()
    yield from uv_editor(0.45)
    yield from show_image(bpy.context.object.active_material.name, flat)
    look(SIDE, (0, 0.3, 1.2), 1.1 * FAR)
    yield from photograph(f"{folder}/wallpaper.png")
    area_of("VIEW_3D").spaces.active.show_region_ui = True
    yield


def seams() -> Generator:
    """Close to the cut, at places all along its two paths: with it, and below without."""
    yield from folded()
    obj, view = bpy.context.object, bpy.context.scene.orbifold_view
    area_of("VIEW_3D").spaces.active.show_region_ui = False
    _, edges, paths = part("layouts").read_cut(obj.data)
    chosen = [edges[paths == path][int(share * (paths == path).sum())] for path in (0, 1) for share in (0.3, 0.6, 0.8)]
    view.show_cones = False
    with tempfile.TemporaryDirectory() as work:
        names = []
        for view.show_cut in (True, False):
            for number, edge in enumerate(chosen):
                ends = [obj.data.vertices[vertex] for vertex in edge]
                normal = sum((end.normal for end in ends), Vector())
                angles = np.degrees(normal.to_track_quat("Z", "Y").to_euler())
                look(tuple(angles), tuple((ends[0].co + ends[1].co) / 2), 0.9)
                names.append(os.path.join(work, f"{view.show_cut}{number}.png"))
                yield from photograph(names[-1], (0.1, 0, 0.9, 1))
        tiles = ["-tile", f"{len(chosen)}x", "-geometry", "250x250^+2+2", "-background", "white"]
        subprocess.run(["montage", *names, *tiles, f"{folder}/seams.png"], check=True)
    view.show_cut = view.show_cones = True
    area_of("VIEW_3D").spaces.active.show_region_ui = True
    yield


def transferring() -> Generator:
    """Two creatures with landmarks; the colours of one are on both."""
    yield from bare()
    obj = bpy.context.object
    obj.name = "creature"
    twin = twin_of(obj)
    points = np.array([vertex.co[:] for vertex in obj.data.vertices])
    colours = np.column_stack([0.5 + 0.45 * np.sin(4 * points + [0, 2, 4]), np.ones(len(points))])
    part("blender_mesh").write_vertex_colour(obj.data, "Stripes", colours)
    area_of("VIEW_3D").spaces.active.shading.color_type = "VERTEX"
    look((76, 0, 20), (1.6, 0, 1.5), 1.25 * FAR)
    with inside():
        bpy.ops.object.orbifold_suggest_order("INVOKE_DEFAULT", True)
        bpy.ops.object.orbifold_transfer("INVOKE_DEFAULT", True)
    yield lambda: "Stripes" in twin.data.attributes
    yield from tab("Show")
    region = region_of("VIEW_3D", "UI")
    for row in (1, 2, 4):  # fold Show and Painting, and unfold Transfer
        yield from click(region.x + 0.4 * region.width, region.y + region.height - (15 + 25 * row) * SCALE)
        yield from pause(3)
    yield from away()
    yield from photograph(f"{folder}/transferring.png", (0, 0, 1, 0.97))


SIDE, MIDDLE, FAR = (72, 0, 62), (0, 0, 1.75), 5.6  # how the creature is looked at
EARS_AND_TAIL = ("ear", "other ear", "tail")
SCENES: dict[str, Callable[[], Generator]] = {
    scene.__name__: scene
    for scene in (
        one_click, redo, picking, signatures, layout, heat, pattern, suggesting, checking, painting, stroke,
        wallpaper, seams, transferring,
    )
}


def bare(subdivisions: int = 3) -> Generator:
    """The creature as it is, in object mode; the 3D view with the panel of cones."""
    creature(subdivisions)
    yield from no_uv_editor()
    yield from tab("Orbifold UV")
    shade("SOLID")
    look(SIDE, MIDDLE, FAR)


def three_cones() -> Generator:
    """The creature in object mode, unwrapped as 442."""
    yield from bare()
    obj = bpy.context.object
    pick(obj, EARS_AND_TAIL)
    with inside():
        bpy.ops.mesh.orbifold_add_cones()
    obj.data.orbifold.signature = "442"
    bpy.ops.object.mode_set(mode="OBJECT")
    yield from unwrap(obj)


def petals() -> Generator:
    """The creature with the image of painting.md, which is beside it."""
    yield from three_cones()
    run_script()
    yield from uv_editor(0.45)
    yield from show_image("Petals")
    look((55, 0, 160), (0.1, -0.6, 2.1), 2.4)


def run_script() -> None:
    """That of painting.md."""
    with open(os.path.join(os.path.dirname(__file__), "painting.md"), encoding="utf-8") as page:
        script = page.read().partition("```python\n")[2].partition("```")[0]
    exec(compile(script, "painting.md", "exec"), {})


def show_image(name: str, shaded: Callable[[], None] = lambda: shade("MATERIAL")) -> Generator:
    """In the image editor, beside the mesh that shows it."""
    area_of("IMAGE_EDITOR").ui_type = "IMAGE_EDITOR"
    yield
    space = area_of("IMAGE_EDITOR").spaces.active
    space.image, space.show_region_ui, space.show_region_toolbar = bpy.data.images[name], False, False
    area_of("VIEW_3D").spaces.active.show_region_ui = False
    fit_uv()
    shaded()
    yield from pause(40)


def folded() -> Generator:
    """The creature with a wallpaper from a picture without any symmetry: waves of many lengths."""
    yield from three_cones()
    v, u = np.mgrid[:1024, :1024] / 1024
    chance, waves = np.random.default_rng(8), 0
    for octave in range(2, 8):
        along = chance.normal(size=(2, 3)) * 2**octave
        waves = waves + np.sin(u[:, :, None] * along[0] + v[:, :, None] * along[1] + chance.uniform(0, 6, 3))
    colours = 0.5 + 0.45 * np.tanh(0.5 * waves)
    picture = bpy.data.images.new("Picture", 1024, 1024)
    picture.pixels.foreach_set(np.dstack([colours, np.ones((1024, 1024))]).astype(np.float32).ravel())
    with inside():
        bpy.ops.image.orbifold_wallpaper(picture="Picture", size=2048, blend=0.8)
    obj = bpy.context.object
    nodes = obj.active_material.node_tree.nodes
    nodes.active = next(node for node in nodes if node.type == "TEX_IMAGE")
    flat()


def flat() -> None:
    """The image as it is, in solid shading, which is quick."""
    shade("SOLID")
    area_of("VIEW_3D").spaces.active.shading.color_type = "TEXTURE"


def twin_of(obj: bpy.types.Object) -> bpy.types.Object:
    """Another creature beside it: shorter, stouter, turned to the side, with corresponding cones."""
    points = np.array([vertex.co[:] for vertex in obj.data.vertices])
    landmarks = [nearest(obj, place) for place in PLACES.values()]
    feet = ([0.4, 0.2, 1], [-0.4, 0.2, 1], [0.4, -0.2, 1], [-0.4, -0.2, 1])
    landmarks += [int((points @ way).argmin()) for way in feet]
    other = bpy.data.objects.new("twin", obj.data.copy())
    bpy.context.scene.collection.objects.link(other)
    x, y, z = points.T
    bent = np.column_stack([1.25 * x + 0.06 * z**2, 1.1 * y, 0.72 * z])
    other.data.vertices.foreach_set("co", bent.astype(np.float32).ravel())
    other.location, other.name = (3.1, 0.6, 0), "twin"
    other.data.update()
    for one in (obj, other):
        part("properties").set_cones(one.data, landmarks, [2] * len(landmarks))
        one.select_set(True)
    return other


def pixels_of(image: bpy.types.Image) -> np.ndarray:
    pixels = np.empty((image.size[1], image.size[0], 4), np.float32)
    image.pixels.foreach_get(pixels.ravel())
    return pixels


def beside() -> Generator:
    """A coarse creature in edit mode, unwrapped as 442, and its layout."""
    yield from bare(1)
    obj = bpy.context.object
    yield from uv_editor()
    bpy.context.tool_settings.use_uv_select_sync = True
    look(SIDE, MIDDLE, 1.4 * FAR)
    pick(obj, EARS_AND_TAIL)
    with inside():
        bpy.ops.mesh.orbifold_add_cones("INVOKE_DEFAULT", True)
    obj.data.orbifold.signature = "442"
    yield from unwrap(obj)
    bpy.ops.mesh.select_all(action="SELECT")
    yield
    with inside("IMAGE_EDITOR"):
        bpy.ops.image.view_selected()
    bpy.ops.mesh.select_all(action="DESELECT")
    yield


# ------------------------------------------------------------------------------------------------------- driving


def steps() -> Generator:
    yield from pause()
    yield from arrange()
    for name in wanted or SCENES:
        print(f"picture: {name}", flush=True)
        yield from SCENES[name]()


bpy.ops.preferences.addon_enable(module=NAME)
set_up()
drive(steps())
