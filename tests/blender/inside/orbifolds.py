# SPDX-License-Identifier: GPL-3.0-or-later
"""Open meshes, handles, cross-caps: picking corners, what the menu offers, unwrapping, holes, fixed boundaries."""

import os
import sys
from types import SimpleNamespace

import bmesh
import bpy
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(HERE, "..", "..", "core")]
import grids  # noqa: E402
from conway import features  # noqa: E402
from harness import (  # noqa: E402
    blob, click, edit_mode, enable, mesh_object, object_mode, part, picked, raises, run_checks,
)
from picks import inside, picks_for  # noqa: E402

enable()
core, blender_mesh, faces, charts = part("core"), part("blender_mesh"), part("faces"), part("core.charts")
properties, surface = part("properties"), part("surface")


# ---------------------------------------------------------------------------------------------------- meshes


def made(mesh):
    return lambda quads=False, **size: mesh_object(*mesh(quads, **size), "Grid")


disk, annulus, mobius, klein, torus = map(made, (grids.disk, grids.annulus, grids.mobius, grids.klein, grids.torus))


def holed_blob(quads=False):
    """A sphere with two holes, of which the second is the smaller one."""
    obj = blob(4)
    vertices = [list(v.co) for v in obj.data.vertices]
    triangles = [list(p.vertices) for p in obj.data.polygons]
    ring = {v for t in triangles if 0 in t for v in t}
    return mesh_object(vertices, [t for t in triangles if not ring & set(t) and t != triangles[700]], "Holed")


CASES = [
    (disk, "*442"), (disk, "*632"), (disk, "*2222"), (disk, "4*2"), (disk, "2*22"), (disk, "22*"), (disk, "*432"),
    (disk, "3*2"), (disk, "5*"), (disk, "2*4"), (disk, "*33"), (disk, "*237"), (disk, "5*3"), (annulus, "**"),
    (annulus, "2**"), (mobius, "*x"), (mobius, "2*x"), (klein, "xx"), (klein, "2xx"), (torus, "o"), (torus, "o2"),
]


def prepare(make, signature, quads=False):
    """An object with cones far from one another and the border; its arrays and the result of core."""
    obj = make(quads)
    arrays = blender_mesh.read_mesh(obj.data)
    chosen = picks_for(arrays.vertices, arrays.triangles, features(signature))
    result = core.embed(arrays.vertices, arrays.triangles, signature, chosen, weights="conformal")
    obj.data.orbifold.signature = signature
    properties.set_cones(obj.data, chosen, [None] * len(chosen))
    assert obj.data.orbifold.signature == signature and [order for _, order in picked(obj)] == result.orders.tolist()
    return obj, arrays, result


def corner_uv(obj, arrays):
    return blender_mesh.read_uv(obj.data)[arrays.loops]


def same_uv(obj, arrays, result):
    """But for the clamp, which Blender rounds to 32 bits, and in the plane for whole periods."""
    apart = corner_uv(obj, arrays) - result.uv
    if result.geometry == "euclidean":
        apart -= np.round(apart[0, 0])
    return np.abs(apart).max() < 1e-6


def seam_pairs(obj):
    mesh = obj.data
    return {tuple(sorted(pair)) for pair in blender_mesh.read_edges(mesh)[blender_mesh.read_seams(mesh)].tolist()}


# --------------------------------------------------------------------------------------------------- picking


def on_the_border(obj, count):
    loop = surface.read(obj.data).loops[0]
    return [int(v) for v in loop[:: len(loop) // count][:count]]


def check_vertices_on_the_border_are_corners():
    obj = disk()
    corners = on_the_border(obj, 3)
    edit_mode()
    click(corners)
    bpy.ops.mesh.orbifold_add_cones()
    settings = obj.data.orbifold
    assert settings.signature == "*222" and all(item.mirror for item in settings.cones)
    settings.signature = "*632"
    assert picked(obj) == list(zip(corners, (6, 3, 2)))
    inside = 5 * 13 + 6
    click([inside])
    bpy.ops.mesh.orbifold_add_cones()
    assert settings.signature == "2*632" and [item.mirror for item in settings.cones] == [True] * 3 + [False]
    settings.cones[3].order = 5
    assert settings.signature == "5*632"
    bpy.ops.mesh.orbifold_remove_cone(index=1)
    assert settings.signature == "5*62"
    object_mode()
    assert [item.mirror for item in settings.cones] == [True, True, False]


def check_a_cone_becomes_a_corner_where_a_face_is_deleted():
    obj = blob()
    edit_mode()
    click([50, 7, 100])
    bpy.ops.mesh.orbifold_add_cones()
    assert not any(item.mirror for item in obj.data.orbifold.cones)
    bm = bmesh.from_edit_mesh(obj.data)
    bm.verts.ensure_lookup_table()
    bmesh.ops.delete(bm, geom=[bm.verts[7].link_faces[0]], context="FACES")
    bmesh.update_edit_mesh(obj.data)
    bpy.context.view_layer.update()
    assert [item.mirror for item in obj.data.orbifold.cones] == [False, True, False]


def check_corners_follow_the_border_in_any_sequence_of_picking():
    obj = disk()
    a, b, c, d = on_the_border(obj, 4)
    obj.data.orbifold.signature = "*2323"
    properties.set_cones(obj.data, [a, c, b, d], [None] * 4)
    assert dict(picked(obj)) == {a: 2, b: 3, c: 2, d: 3} or dict(picked(obj)) == {a: 2, c: 2, b: 3, d: 3}
    assert bpy.ops.uv.orbifold_unwrap() == {"FINISHED"}


def check_the_menu_offers_exactly_what_fits():
    fitting = part("panels.menus").fitting
    obj = disk()
    assert [offer.signature for offer in fitting(obj.data)][:1] in ([], ["*"])
    corners = on_the_border(obj, 3)
    properties.set_cones(obj.data, corners, [2, 2, 2])
    offers = [offer.signature for offer in fitting(obj.data)]
    assert {"*442", "*333", "*632", "*432", "*532", "*332", "*22(12)", "*237"} <= set(offers)
    assert all(offer.startswith("*") for offer in offers)
    properties.set_cones(obj.data, [6 * 13 + 6], [2])
    assert "5*" in [offer.signature for offer in fitting(obj.data)]
    for make, signature in ((annulus, "**"), (mobius, "*x"), (klein, "xx"), (torus, "o")):
        assert [offer.signature for offer in fitting(make().data)] == [signature]
    obj = holed_blob()
    properties.set_cones(obj.data, inside_of(obj), [4, 4, 2])
    assert all(offer.n_mirrors == 2 for offer in fitting(obj.data))
    obj.data.orbifold.holes = "fill"
    assert {0, 1, 2} == {offer.n_mirrors for offer in fitting(obj.data)}
    assert "442" in [offer.signature for offer in fitting(obj.data)]


def check_every_offer_has_a_drawing():
    previews = part("previews")
    for signature in ("442", "*632", "4*2", "**", "xx", "oo", "*237", "5*", "33"):
        assert previews.tile(signature) == previews.tile(signature)
    previews.clear()


def check_the_panel_says_what_is_missing():
    sidebar = part("panels.sidebar")
    assert "add 2 mirror corners on the border" in sidebar.signature_state("*632", 0, 1).text
    assert "remove 1 cone inside" in sidebar.signature_state("*632", 1, 3).text
    good = sidebar.signature_state("4*2", 1, 1)
    assert good.good and "cone of 90 degrees and a mirror corner of 90 degrees" in good.text
    assert sidebar.surface_problem("o", surface.read(torus().data), "refuse") is None
    assert "torus" in sidebar.surface_problem("442", surface.read(torus().data), "fill")
    seen = surface.read(holed_blob().data)
    assert sidebar.surface_problem("442", seen, "fill") is None
    assert "borders" in sidebar.surface_problem("442", seen, "refuse")
    assert "annulus" in sidebar.surface_problem("***", surface.read(annulus().data), "refuse")


class Recorder:
    """A layout that notes what is drawn."""

    def __init__(self):
        self.__dict__["drawn"] = []

    def __setattr__(self, name, value):
        pass

    def __getattr__(self, name):
        def draw(*arguments, **settings):
            self.drawn.append((name, arguments, settings))
            return self

        return draw

    def texts(self):
        return [settings["text"] for _, _, settings in self.drawn if settings.get("text")]


def drawn(cls, obj):
    owner = SimpleNamespace(layout=Recorder())
    cls.draw(owner, SimpleNamespace(active_object=obj, region=SimpleNamespace(width=300)))
    return owner.layout


def check_menu_and_panel_are_drawn():
    menu, panel = part("panels.menus").MESH_MT_orbifold_signatures, part("panels.sidebar").OrbifoldPanel
    obj = disk()
    properties.set_cones(obj.data, on_the_border(obj, 3), [4, 4, 2])
    texts = drawn(menu, obj).texts()
    assert "Orders of the List: *442" in texts and "Spherical" in texts
    assert "*632: disk with mirror corners of 30, 60 and 90 degrees" in texts
    assert not any("without a mirror" in text for text in drawn(panel, obj).texts())
    assert ("operator", ("uv.orbifold_fixed_boundary",), {}) in drawn(panel, obj).drawn
    obj = holed_blob()
    properties.set_cones(obj.data, inside_of(obj), [4, 4, 2])
    layout = drawn(panel, obj)
    assert "2 borders without a mirror:" in layout.texts()
    assert any(name == "prop" and arguments[1] == "holes" for name, arguments, _ in layout.drawn)
    for make in (torus, klein, blob, annulus):
        drawn(panel, make())
        drawn(menu, make())


# ------------------------------------------------------------------------------------------------- unwrapping


def check_every_signature_gives_the_uv_of_core():
    for make, signature in CASES:
        obj, arrays, result = prepare(make, signature)
        assert bpy.ops.uv.orbifold_unwrap() == {"FINISHED"}, signature
        assert same_uv(obj, arrays, result), signature
        layout = faces.layout_of(result, arrays, result.chart)
        assert seam_pairs(obj) == {tuple(sorted(pair)) for pair in layout.seams.tolist()}, signature
        edges = {tuple(sorted(edge)) for edge in blender_mesh.read_edges(obj.data).tolist()}
        cut = {tuple(sorted(pair)) for pair in result.seams.tolist()}
        assert layout.mended or seam_pairs(obj) == cut & edges, signature
        assert obj.data.orbifold.signature == signature


def check_surfaces_without_cones_need_no_signature():
    for make, signature in ((torus, "o"), (annulus, "**"), (klein, "xx"), (mobius, "*x")):
        obj = make()
        assert bpy.ops.uv.orbifold_unwrap() == {"FINISHED"}, signature
        assert obj.data.orbifold.signature == signature and "Orbifold" in obj.data.uv_layers


def check_faces_stay_whole_and_continue_across_all_other_edges():
    """Of quads; where the surface turns over, a face may lie on its back, but none is torn."""
    mended = 0
    for make, signature in CASES:
        obj, arrays, result = prepare(make, signature, quads=True)
        for chart in core.CHARTS[result.geometry]:
            layout = faces.layout_of(result, arrays, chart)
            mended += layout.mended
            at = {}
            seams = {tuple(sorted(pair)) for pair in layout.seams.tolist()}
            for face, triangle, corners in zip(arrays.polygons, arrays.triangles.tolist(), layout.embedding):
                for s in range(3):
                    a, b = triangle[s], triangle[(s + 1) % 3]
                    place = np.stack([corners[s], corners[(s + 1) % 3]])
                    at.setdefault((min(a, b), max(a, b)), []).append((face, place if a < b else place[::-1]))
            for edge, sides in at.items():
                if len(sides) == 1:
                    assert edge not in seams, (signature, edge)
                    continue
                (face, one), (other_face, other) = sides
                apart = np.abs(one - other).max() > 1e-9
                assert not (apart and face == other_face), (signature, chart, edge)
                if chart not in charts.DISCONTINUOUS:
                    assert apart == (edge in seams), (signature, chart, edge)
            areas = charts.areas(layout.uv)
            areas = np.sign(np.where(np.abs(areas) < 1e-12, 0, areas))
            if result.report["mesh"]["orientable"] and chart not in charts.DISCONTINUOUS:
                assert (areas <= 0).sum() == layout.flat, (signature, chart)
            turned = np.array([areas[arrays.polygons == face].min() * areas[arrays.polygons == face].max()
                               for face in range(len(obj.data.polygons))])
            assert layout.flat or (turned >= 0).all(), (signature, chart, "a face is folded")
    assert mended > 0


def check_pattern_is_left_alone_by_the_group():
    """At points of the tile and their images under every generator, reflections and glides among them."""
    pattern = part("pattern")
    for make, signature in CASES:
        obj, arrays, result = prepare(make, signature)
        curvature = charts.CURVATURE[result.geometry]
        layout = faces.plain_layout(result)
        chart = charts.chart_of(result.chart, result.geometry, layout.embedding, layout.uv)
        spacing = pattern.ring_spacing(result)
        orbits = pattern.orbits_of(result, layout, chart, spacing)
        colours = {}
        border = np.isin(result.cut_to_vertex, result.seams)
        for copy in np.flatnonzero(border):
            colour = pattern.colour_at(result.embedding[copy][None], orbits, curvature, spacing)[0]
            colours.setdefault(int(result.cut_to_vertex[copy]), []).append(colour)
        several = [np.ptp(same, axis=0).max() for same in colours.values() if len(same) > 1]
        assert not len(result.seams) or len(several) >= 3, signature
        assert not several or max(several) < 5e-3, (signature, max(several))
        edges, step = mirror_points(result, curvature)
        for point, aside in zip(edges, step):  # just off a mirror on both sides
            pair = [on_model(point + way * aside, curvature) for way in (1, -1)]
            one, other = (pattern.colour_at(p[None], orbits, curvature, spacing)[0] for p in pair)
            assert np.abs(one - other).max() < 5e-3, (signature, one, other)


def on_model(point, curvature):
    return part("group").on_model(point, curvature)


def mirror_points(result, curvature):
    """Middles of edges on mirrors, and a short way across."""
    keys = {}
    for copies, vertices in zip(result.cut_triangles.tolist(), result.triangles.tolist()):
        for k in range(3):
            edge = vertices[k], vertices[(k + 1) % 3]
            keys.setdefault(tuple(sorted(edge)), []).append((copies[k], copies[(k + 1) % 3]))
    ends = np.array([sides[0] for sides in keys.values() if len(sides) == 1], int).reshape(-1, 2)
    a, b = result.embedding[ends[:, 0]], result.embedding[ends[:, 1]]
    middle = on_model((a + b) / 2, curvature) if len(ends) else a
    form = np.array([1.0, 1.0, curvature])
    if curvature == 0:
        across = np.stack([a[:, 1] - b[:, 1], b[:, 0] - a[:, 0], np.zeros(len(a))], 1)
    else:
        across = np.cross(a, b) * [1.0, 1.0, curvature]
    length = np.sqrt(np.maximum((across**2 * form).sum(1), 1e-300))
    return middle[::5], (0.01 * across / length[:, None])[::5]


def check_pattern_material_is_made():
    for make, signature in ((disk, "*442"), (klein, "xx"), (torus, "o"), (disk, "*237"), (disk, "3*2")):
        obj, _, _ = prepare(make, signature)
        bpy.ops.uv.orbifold_unwrap(pattern=True)
        assert obj.data.materials[0].name == "Orbifold Grid"


def check_sphere_key_of_a_mirror_disk_is_a_patch():
    obj, arrays, result = prepare(disk, "*432")
    assert bpy.ops.uv.orbifold_unwrap() == {"FINISHED"}
    points = blender_mesh.read_shape_key(obj).astype(np.float64)
    a = np.c_[2 * points, np.ones(len(points))]
    centre = np.linalg.lstsq(a, (points**2).sum(1), rcond=None)[0][:3]
    radii = np.linalg.norm(points - centre, axis=1)
    assert np.ptp(radii) < 1e-4 * radii.mean()
    assert (np.linalg.det((points - centre)[arrays.triangles]) > -1e-9 * radii.mean() ** 3).all()
    base = blender_mesh.read_vertices(obj.data)
    sizes = []
    for vertices in (points, base):
        p, q, r = vertices[arrays.triangles].transpose(1, 0, 2)
        sizes.append(np.linalg.norm(np.cross(q - p, r - p), axis=1).sum() / 2)
    assert abs(sizes[0] / sizes[1] - 1) < 1e-3
    assert np.linalg.norm(points.mean(0) - base.mean(0)) < 0.3 * np.ptp(base, axis=0).max()


def check_other_spherical_orbifolds_have_uvs_and_no_key():
    for make, signature in ((disk, "3*2"), (disk, "5*"), (disk, "2*4")):
        obj, _, _ = prepare(make, signature)
        assert bpy.ops.uv.orbifold_unwrap() == {"FINISHED"}
        assert obj.data.shape_keys is None and "Orbifold" in obj.data.uv_layers
        assert "sphere" in raises(bpy.ops.object.orbifold_sphere)
        assert bpy.ops.object.orbifold_sphere(target="SPLIT") == {"FINISHED"}


# ------------------------------------------------------------------------------------------------------ holes


def inside_of(obj):
    arrays = blender_mesh.read_mesh(obj.data)
    return inside(arrays.vertices, arrays.triangles, 3)


def check_holes_are_refused_filled_or_mirrored():
    obj = holed_blob()
    chosen = inside_of(obj)
    properties.set_cones(obj.data, chosen, [4, 4, 2])
    assert obj.data.orbifold.signature == "442"
    count = len(obj.data.vertices), len(obj.data.polygons)
    assert "hole" in raises(bpy.ops.uv.orbifold_unwrap).lower()
    assert "Orbifold" not in obj.data.uv_layers
    assert bpy.ops.uv.orbifold_unwrap(holes="fill") == {"FINISHED"}
    assert (len(obj.data.vertices), len(obj.data.polygons)) == count
    arrays = blender_mesh.read_mesh(obj.data)
    result = core.embed(arrays.vertices, arrays.triangles, "442", chosen, holes="fill", weights="conformal")
    assert result.filled_holes == 2
    assert same_uv(obj, arrays, result)
    assert (charts.areas(corner_uv(obj, arrays).astype(float)) > 0).all()
    obj.data.orbifold.holes = "mirror"
    assert bpy.ops.uv.orbifold_unwrap() == {"FINISHED"}
    result = core.embed(arrays.vertices, arrays.triangles, "442", chosen, holes="mirror", weights="conformal")
    assert same_uv(obj, arrays, result)


def check_a_filled_sphere_has_its_shape_key():
    obj = holed_blob()
    properties.set_cones(obj.data, inside_of(obj), [4, 3, 2])
    assert bpy.ops.uv.orbifold_unwrap(holes="fill", pattern=True) == {"FINISHED"}
    points = blender_mesh.read_shape_key(obj)
    assert len(points) == len(obj.data.vertices) and np.isfinite(points).all()


# --------------------------------------------------------------------------------------------- fixed boundary


def check_fixed_boundary():
    for geometry in ("euclidean", "spherical", "hyperbolic"):
        obj = disk()
        assert bpy.ops.uv.orbifold_fixed_boundary(geometry=geometry, sides=5) == {"FINISHED"}
        arrays = blender_mesh.read_mesh(obj.data)
        result = core.embed(arrays.vertices, arrays.triangles, polygon=core.Polygon(geometry, n=5),
                            weights="conformal")
        assert same_uv(obj, arrays, result), geometry
        assert not seam_pairs(obj)
        corners = on_the_border(obj, 3)
        properties.set_cones(obj.data, corners, [2, 2, 2])
        before = obj.data.orbifold.signature
        assert bpy.ops.uv.orbifold_fixed_boundary(geometry=geometry, pattern=True) == {"FINISHED"}
        result = core.embed(arrays.vertices, arrays.triangles, cones=corners, polygon=core.Polygon(geometry, n=3),
                            weights="conformal")
        assert same_uv(obj, arrays, result), geometry
        assert obj.data.orbifold.signature == before
    blob()
    assert "no border" in raises(bpy.ops.uv.orbifold_fixed_boundary)


run_checks(globals())
