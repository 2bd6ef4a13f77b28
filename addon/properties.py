# SPDX-License-Identifier: GPL-3.0-or-later
"""What the add-on keeps on a mesh: the list of its cones and corners (a mirror, cones.py), the signature as it was
typed, what to do with holes, and suggestions (suggestions.py).

Orders and signature say the same thing twice, so that either may be edited: a signature that parses gives the cones
their orders; an order that is changed in the list, and a cone that comes or goes, rewrites the signature. While fewer
cones are picked than the signature has, it stays as it was typed and the cones take their orders from it in turn.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Optional

import bpy
from bpy.props import BoolProperty, CollectionProperty, EnumProperty, IntProperty, PointerProperty, StringProperty

from . import arrangement, checking, cones, core, layouts, suggestions, surface

NEW_ORDER = 2
CHANGED: list[Callable[[bpy.types.Mesh], None]] = []  # called when the user has changed an order or the signature
HOLES = (
    ("refuse", "Refuse", "A border that the signature has no mirror for is an error"),
    ("fill", "Fill Holes for the Computation", "Borders without mirror corners beyond the signature's mirrors, the "
     "shortest first, are closed for the computation; the mesh stays open"),
    ("mirror", "Mirror", "Borders beyond the signature's mirrors become mirrors too"),
)


def read_signature(text: str) -> Optional[core.Signature]:
    """A signature that can be embedded; None for any other (panels/sidebar.py tells the reason)."""
    try:
        read = core.parse_signature(text)
    except core.OrbifoldError:
        return None
    return read if read.supported else None


def arranged(mesh: bpy.types.Mesh, vertices: Sequence[int], anew: bool = False) -> arrangement.Arrangement:
    """These vertices in a signature's sequence. Borders without corners are mirrors where the mesh's signature, or the
    choice for holes, says so."""
    if anew:
        surface.read(mesh)
    seen, settings = surface.around(mesh, vertices), mesh.orbifold
    typed = read_signature(settings.signature)
    all_mirrors = settings.holes == "mirror" or (typed is not None and typed.n_mirrors == len(seen.loops))
    return arrangement.arrange(vertices, seen, all_mirrors)


def default_signature(mesh: bpy.types.Mesh) -> str:
    """The signature of the mesh, or that of its surface without cones, all borders mirrors; empty for a sphere."""
    if mesh.orbifold.signature or len(mesh.orbifold.cones):
        return mesh.orbifold.signature
    return arrangement.arrange([], surface.glance(mesh), True).text([])


def set_cones(mesh: bpy.types.Mesh, vertices: list[int], orders: list[Optional[int]]) -> None:
    """Replace the cones. An order of None is a new cone's: the signature's next one, or 2."""
    places = arranged(mesh, vertices, anew=True)
    typed = read_signature(mesh.orbifold.signature)
    wanted = places.orders_from(typed) if typed is not None else None
    keeps_text = False
    if None in orders and wanted is not None:  # a signature that was typed first
        keeps_text = all(orders[place] in (None, wanted[place]) for place in places.cones)
        corners = [orders[place] for place in places.sequence if place not in places.cones]
        keeps_text = keeps_text and _among([order for order in corners if order is not None], typed)
    if keeps_text:
        chosen = wanted
    else:
        chosen = [order or (wanted[place] if wanted else NEW_ORDER) for place, order in enumerate(orders)]
    cones.write_cones(mesh, [cones.Cone(vertex, order) for vertex, order in zip(vertices, chosen)])
    if vertices and not keeps_text:
        write_signature(mesh, places.text(chosen))


def _among(orders: list[int], typed: core.Signature) -> bool:
    """Whether these can be some of the signature's corners."""
    left = list(typed.orders[typed.n_interior :])
    for order in orders:
        if order not in left:
            return False
        left.remove(order)
    return True


def sync(mesh: bpy.types.Mesh) -> None:
    """Bring the mirror, and the signature where it says something else, in line with the vertices."""
    cones.sync(mesh)
    picks = [cones.Cone(item.vertex, item.order) for item in mesh.orbifold.cones]
    orders = [pick.order for pick in picks]
    typed = read_signature(mesh.orbifold.signature)
    suggested = None
    if typed is None or not orders or len(typed.orders) != len(orders):
        suggested = suggestions.signature_for(mesh, picks)
    if suggested is not None:
        write_signature(mesh, suggested)
    elif orders:
        places = arranged(mesh, [pick.vertex for pick in picks])
        if typed is None or places.orders_from(typed) != orders:
            write_signature(mesh, places.text(orders))


def write_signature(mesh: bpy.types.Mesh, text: str) -> None:
    """Without giving the cones its orders."""
    with cones.writing():
        mesh.orbifold.signature = text


def _order_changed(item: "OrbifoldCone", _context: bpy.types.Context) -> None:
    if cones.is_writing():
        return
    mesh = item.id_data
    chosen = [(cone.vertex, cone.order) for cone in mesh.orbifold.cones]
    cones.write_cones(mesh, [cones.Cone(*pair) for pair in chosen])
    places = arranged(mesh, [vertex for vertex, _ in chosen])
    write_signature(mesh, places.text([order for _, order in chosen]))
    tell(mesh)


def tell(mesh: bpy.types.Mesh) -> None:
    """The user has changed the orbifold of a mesh."""
    for listener in CHANGED:
        listener(mesh)


def _signature_changed(settings: "OrbifoldMesh", _context: bpy.types.Context) -> None:
    if cones.is_writing():
        return
    mesh = settings.id_data
    suggestions.forget_replaced(mesh)
    read, picked = read_signature(settings.signature), cones.read_cones(mesh)
    if read is not None and picked:
        orders = arranged(mesh, [cone.vertex for cone in picked]).orders_from(read)
        if orders is not None:
            cones.write_cones(mesh, [cones.Cone(cone.vertex, order) for cone, order in zip(picked, orders)])
    tell(mesh)


class OrbifoldCone(bpy.types.PropertyGroup):
    """One cone of a mesh, as the list shows it."""

    vertex: IntProperty(name="Vertex", description="Index of the vertex that becomes this cone", min=0)
    rank: IntProperty(options={"HIDDEN"})
    mirror: BoolProperty(name="Mirror Corner", description="The vertex lies on the mesh's border", options={"HIDDEN"})
    order: IntProperty(
        name="Order",
        description="A cone of order N has the angle 360 / N degrees in the layout, a mirror corner, on the mesh's "
        "border, 180 / N. Changing it rewrites the signature",
        min=2,
        max=cones.MAX_ORDER,
        soft_max=12,
        default=NEW_ORDER,
        update=_order_changed,
    )


class OrbifoldMesh(bpy.types.PropertyGroup):
    """Kept on the mesh, and saved with it."""

    cones: CollectionProperty(type=OrbifoldCone)
    active_cone: IntProperty(name="Active Cone", description="The cone that the buttons beside the list act on", min=0)
    signature: StringProperty(
        name="Signature",
        description=(
            "Conway's notation: the orders of the cones, one digit each, larger ones in parentheses, as 442 or 22(12); "
            "a * for each border that is a mirror, then the orders of its corners, as *442 or 4*2; o for each handle, "
            "x for each cross-cap. The cones of the list take these orders in turn; the geometry follows from them"
        ),
        maxlen=4096,
        update=_signature_changed,
    )
    holes: EnumProperty(
        name="Holes",
        description="What to do with borders of the mesh that the signature has no mirror for",
        items=HOLES,
    )
    keep_away: StringProperty(
        name="Keep Away",
        description="A vertex group where suggested cones are unwelcome: the more, the greater its weight; where it is "
        "1 there is never one",
    )
    suggestions: PointerProperty(type=suggestions.OrbifoldSuggestions)
    check: PointerProperty(type=checking.OrbifoldCheck)
    layouts: CollectionProperty(type=layouts.OrbifoldLayout)
    colour_before: StringProperty(options={"HIDDEN"})  # the active colour attribute before a heat map
    unwraps: IntProperty(options={"HIDDEN"})  # how many there were: tells drawings that there is a new one


CLASSES = (OrbifoldCone, *suggestions.CLASSES, *layouts.CLASSES, *checking.CLASSES, OrbifoldMesh)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Mesh.orbifold = PointerProperty(type=OrbifoldMesh)


def unregister() -> None:
    del bpy.types.Mesh.orbifold
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
