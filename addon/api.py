# SPDX-License-Identifier: GPL-3.0-or-later
"""For scripts inside Blender; the add-on has to be enabled. The names are those of the package:

    import orbifold_uv                                      # Blender 3.4 to 4.1: a legacy add-on
    from bl_ext.user_default import orbifold_uv             # Blender 4.2 and later: an extension

    report = orbifold_uv.unwrap(bpy.data.objects["Cow"], cones=[100, 1000, 2000], signature="442")
    print(report["distortion"]["quasi_conformal_mean"])

Any mesh object, in edit or object mode, active or not: no context has to be overridden. What fails raises
OrbifoldError, which names what is wrong and where, and leaves the mesh as it was. Nothing here makes an undo step.
docs/batch.md has examples.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from typing import Optional

import bpy

from . import blender_mesh, checking, cones as cone_lists, core, suggestions
from .core import OrbifoldError
from .transferring import Transferring, Wishes
from .unwrapping import Settings, Unwrapping

__all__ = ["OrbifoldError", "check", "sphere", "suggest", "transfer", "unwrap"]


def unwrap(
    obj: bpy.types.Object,
    cones: Optional[Sequence[int]] = None,
    signature: Optional[str] = None,
    orders: Optional[Sequence[int]] = None,
    *,
    weights: str = "conformal",
    clamp: float = 0.01,
    holes: Optional[str] = None,
    chart: Optional[str] = None,
    flat: bool = True,
    mark_seams: bool = True,
    sphere_key: bool = True,
    pattern: bool = False,
    progress: Optional[core.Progress] = None,
) -> dict:
    """The UV map `Orbifold` of an object's mesh, and the report: that of NAME.json with `object`, `uv_map`,
    `shape_key`, `components` (a report for each component that was treated), `untreated`, `warnings`.

    cones       vertices, in the signature's sequence unless `orders` says otherwise; they replace those of the mesh.
                None: those of the mesh; where it has none, or one, the best ones are placed
    signature   Conway's notation. None: that of the mesh; with `cones` and `orders` it follows from these
    orders      the order of each cone. Cones on several components need them, for each component has a signature
    weights     as `core.embed`
    clamp       least cotangent weight
    holes       "refuse", "fill" or "mirror". None: the choice that is kept with the mesh
    chart       of the UVs, one of core.CHARTS[geometry]; None: the geometry's first
    flat        where cones are placed for any signature: only those of the plane
    mark_seams, sphere_key, pattern   as in the redo panel of Orbifold Unwrap
    progress    called as progress(stage, fraction); returning False cancels (ORB_CANCELLED)
    """
    with _expected(obj):
        charts = {} if chart is None else {_geometry(chart): chart}
        settings = Settings(
            signature=signature, weights=weights, clamp=clamp, holes=_holes(obj, holes), flat=flat, charts=charts,
            mark_seams=mark_seams, sphere_key=sphere_key, pattern=pattern,
        )
        work = _computed(obj, settings, _picked(obj, cones, signature, orders), progress)
        if chart is not None and any(piece.layout.chart != chart for piece in work.pieces):
            geometry = work.pieces[0].result.geometry
            raise OrbifoldError(
                "ORB_BAD_ARGUMENT", f"the chart '{chart}' is not of {geometry} geometry: use one of "
                f"{', '.join(core.CHARTS[geometry])}"
            )
        work.write()
        return work.report()


def sphere(
    obj: bpy.types.Object,
    cones: Optional[Sequence[int]] = None,
    signature: Optional[str] = None,
    orders: Optional[Sequence[int]] = None,
    *,
    weights: str = "conformal",
    clamp: float = 0.01,
    holes: Optional[str] = None,
    progress: Optional[core.Progress] = None,
) -> dict:
    """The shape key `Orbifold Sphere` of a spherical orbifold, and no UV map. Arguments and report are those of
    `unwrap`; where cones are placed for any signature, only spherical ones come into question."""
    with _expected(obj):
        settings = Settings(
            signature=signature, weights=weights, clamp=clamp, holes=_holes(obj, holes), sphere_only=True
        )
        work = _computed(obj, settings, _picked(obj, cones, signature, orders), progress)
        work.write()
        return work.report()


def suggest(
    obj: bpy.types.Object,
    signatures: Optional[str | Sequence[str]] = None,
    fixed: Sequence[int] = (),
    *,
    flat: bool = False,
    holes: Optional[str] = None,
    symmetry: str | Sequence[float] = "detect",
    progress: Optional[core.Progress] = None,
) -> list[dict]:
    """Cones with which areas are stretched least, best first, as dictionaries with signature, cones, orders, predicted,
    conformal, measured and symmetric (core.Suggestion). The mesh's vertex group to keep cones away from is respected;
    the mesh and its table of suggestions stay as they are. Arguments are those of core.suggest_cones."""
    with _expected(obj):
        with blender_mesh.object_mode(obj):
            arrays, keep_away = blender_mesh.read_mesh(obj.data), suggestions.keep_away(obj)
        found = core.suggest_cones(
            *(arrays.vertices, arrays.triangles, signatures, fixed, keep_away),
            flat=flat, holes=_holes(obj, holes), symmetry=symmetry, progress=progress,
        )
    return [{**asdict(one), "cones": list(one.cones), "orders": list(one.orders)} for one in found]


def check(obj: bpy.types.Object) -> dict:
    """What stands in the way of unwrapping: `object`, `ready` (nothing has to be mended), and `defects`, each with
    kind, text, count, blocks, element ("vertex", "edge", "face") and elements; edges are pairs of vertices."""
    with _expected(obj):
        with blender_mesh.object_mode(obj):
            found = checking.defects_of(obj.data)
    defects = [
        {
            "kind": defect.kind, "text": defect.text, "count": defect.count, "blocks": defect.blocks,
            "element": defect.element, "elements": defect.elements.tolist(),
        }
        for defect in found
    ]
    return {"object": obj.name, "ready": not any(defect.blocks for defect in found), "defects": defects}


def transfer(
    source: bpy.types.Object,
    targets: bpy.types.Object | Sequence[bpy.types.Object],
    landmarks: Optional[Sequence[Sequence[int]]] = None,
    *,
    groups: bool = True,
    colours: bool = True,
    attributes: bool = True,
    uv_maps: bool = True,
    cut_seams: bool = False,
    texture: bool = False,
    form: bool = False,
    form_back: bool = False,
    shape_keys: bool = False,
    heat: bool = False,
    heat_area: bool = False,
    signature: str = "",
    weights: str = "conformal",
    clamp: float = 0.01,
    holes: Optional[str] = None,
    progress: Optional[core.Progress] = None,
) -> dict:
    """What the source's mesh has -> the targets' meshes, by maps that are one to one and take landmarks to landmarks.
    The report: `source`, `signature`, `geometry`, and `targets`, for each `object`, `written` (names, by kind),
    `crossing_faces` (that a seam of the source's UV maps runs through), `cut_faces` (how many were cut), `cut_pieces`
    (into how many), `locked_groups`, `distortion`, `flipped`,
    `landmark_residual`, `bijective`, and `cut_ratio`: how many times as long as its own the source's landmark paths
    become. Where one target fails nothing is written to any.

    landmarks   for the source and each target as many vertices, those that correspond in the same places (core has
                landmark_sequence for a good sequence); None: the cones of the meshes
    groups ... heat_area   what is written, as the check boxes of the panel Transfer
    signature   empty: by the number of landmarks
    weights, clamp   as core.embed; holes: None: the choice that is kept with each mesh
    progress    called as progress(stage, fraction), for each mesh in turn; returning False cancels (ORB_CANCELLED)
    """
    chosen = [targets] if isinstance(targets, bpy.types.Object) else list(targets)
    if landmarks is not None and len(landmarks) != 1 + len(chosen):
        raise OrbifoldError(
            "ORB_BAD_ARGUMENT", f"there are {len(landmarks)} lists of landmarks for {1 + len(chosen)} meshes: give one "
            "for each, that of the source first"
        )
    wishes = Wishes(
        groups=groups, colours=colours, attributes=attributes, uv_maps=uv_maps, cut_seams=cut_seams, texture=texture,
        form=form, form_back=form_back, shape_keys=shape_keys, heat=heat, heat_area=heat_area, signature=signature,
        weights=weights, clamp=clamp, holes=holes,
    )
    with _expected(source, *chosen):
        work = Transferring(source, chosen, wishes, landmarks)
        job = work.start()
        while job is not None:
            core.wait_until_over(job, progress)
            job = work.proceed(job)
        work.write()
        return work.report()


# ------------------------------------------------------------------------------------------------------ inside


@contextmanager
def _expected(*objects: bpy.types.Object) -> Iterator[None]:
    """Everything that is for the caller to mend is an OrbifoldError."""
    if not all(isinstance(obj, bpy.types.Object) and obj.type == "MESH" for obj in objects):
        raise OrbifoldError("ORB_BAD_ARGUMENT", "this is no mesh object: give one, as bpy.data.objects['Cube']")
    if not hasattr(bpy.types.Mesh, "orbifold"):
        raise OrbifoldError("ORB_BAD_ARGUMENT", "the add-on Orbifold UV is not enabled: enable it in the preferences")
    try:
        yield
    except blender_mesh.BlenderMeshError as error:
        raise OrbifoldError("ORB_BAD_ARGUMENT", str(error)) from error


def _computed(
    obj: bpy.types.Object, settings: Settings, picked: Optional[list[cone_lists.Cone]],
    progress: Optional[core.Progress],
) -> Unwrapping:
    work = Unwrapping(obj, settings, picked)
    job = work.start()
    while job is not None:
        core.wait_until_over(job, progress)
        job = work.proceed(job)
    return work


def _picked(
    obj: bpy.types.Object, cones: Optional[Sequence[int]], signature: Optional[str], orders: Optional[Sequence[int]]
) -> Optional[list[cone_lists.Cone]]:
    if cones is None:
        if orders is not None:
            raise OrbifoldError("ORB_BAD_ARGUMENT", "there are orders but no cones: give both, or only a signature")
        return None
    vertices = [int(vertex) for vertex in cones]
    if len(set(vertices)) < len(vertices):
        twice = next(vertex for vertex in vertices if vertices.count(vertex) > 1)
        raise OrbifoldError("ORB_BAD_CONE", f"vertex {twice} is given twice: name each cone once", [twice], "vertex")
    if orders is None and signature is None and vertices:
        raise OrbifoldError("ORB_BAD_ARGUMENT", "cones need a signature such as '442', or the order of each")
    if orders is not None and len(orders) != len(vertices):
        raise OrbifoldError(
            "ORB_BAD_ORDER", f"there are {len(orders)} orders for {len(vertices)} cones: give one for each"
        )
    if orders is not None and min(orders, default=2) < 2:
        raise OrbifoldError("ORB_BAD_ORDER", f"the order {min(orders)} is below 2")
    if orders is None:
        read = core.parse_signature(signature) if vertices else None
        orders = [*read.orders, *[2] * len(vertices)][: len(vertices)] if read is not None else []
    elif signature is not None:
        vertices, orders = _in_sequence(vertices, orders, signature)
    return [cone_lists.Cone(vertex, int(order)) for vertex, order in zip(vertices, orders)]


def _in_sequence(
    vertices: Sequence[int], orders: Sequence[int], signature: str
) -> tuple[list[int], Sequence[int]]:
    """The cones, each keeping its order, in the sequence of the signature."""
    wanted = core.parse_signature(signature).orders
    if sorted(wanted) != sorted(orders):
        raise OrbifoldError(
            "ORB_BAD_ORDER", f"the orders {', '.join(map(str, orders))} are not those of {signature}, which are "
            f"{', '.join(map(str, wanted))} in any sequence"
        )
    left = list(zip(orders, vertices))
    found = []
    for order in wanted:
        place = next(place for place, (own, _) in enumerate(left) if own == order)
        found.append(left.pop(place)[1])
    return found, wanted


def _holes(obj: bpy.types.Object, holes: Optional[str]) -> str:
    return obj.data.orbifold.holes if holes is None else holes


def _geometry(chart: str) -> str:
    for geometry, charts in core.CHARTS.items():
        if chart in charts:
            return geometry
    known = ", ".join(name for charts in core.CHARTS.values() for name in charts)
    raise OrbifoldError("ORB_BAD_ARGUMENT", f"there is no chart '{chart}'; there are {known}")
