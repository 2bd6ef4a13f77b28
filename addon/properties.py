# SPDX-License-Identifier: GPL-3.0-or-later
"""What the add-on keeps on a mesh: the list of its cones (a mirror, cones.py) and the signature as it was typed.

Orders and signature say the same thing twice, so that either may be edited: a signature that parses gives the cones
their orders; an order that is changed in the list, and a cone that comes or goes, rewrites the signature. While fewer
cones are picked than the signature has, it stays as it was typed and the cones take their orders from it in turn.
"""

from __future__ import annotations

from typing import Optional

import bpy
from bpy.props import CollectionProperty, IntProperty, PointerProperty, StringProperty

from . import cones, core

NEW_ORDER = 2


def read_orders(text: str) -> Optional[list[int]]:
    """The orders of a signature that can be embedded; None for any other (panels/sidebar.py tells the reason)."""
    try:
        read = core.parse_signature(text)
    except core.OrbifoldError:
        return None
    return list(read.orders) if read.supported else None


def set_cones(mesh: bpy.types.Mesh, vertices: list[int], orders: list[Optional[int]]) -> None:
    """Replace the cones. An order of None is a new cone's: the signature's next one, or 2."""
    typed = read_orders(mesh.orbifold.signature) or []
    fills = None in orders and len(vertices) <= len(typed)  # a signature that was typed first
    keeps_text = fills and all(order in (None, wanted) for order, wanted in zip(orders, typed))
    chosen = [
        order if order is not None else (typed[place] if place < len(typed) else NEW_ORDER)
        for place, order in enumerate(orders)
    ]
    cones.write_cones(mesh, [cones.Cone(vertex, order) for vertex, order in zip(vertices, chosen)])
    if vertices and not keeps_text:
        write_signature(mesh, core.format_signature(chosen))


def sync(mesh: bpy.types.Mesh) -> None:
    """Bring the mirror, and the signature where it says something else, in line with the vertices."""
    cones.sync(mesh)
    orders = [item.order for item in mesh.orbifold.cones]
    typed = read_orders(mesh.orbifold.signature) or []
    if orders and typed[: len(orders)] != orders:
        write_signature(mesh, core.format_signature(orders))


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
    write_signature(mesh, core.format_signature([order for _, order in chosen]))


def _signature_changed(settings: "OrbifoldMesh", _context: bpy.types.Context) -> None:
    if cones.is_writing():
        return
    mesh = settings.id_data
    orders = read_orders(settings.signature)
    picked = cones.read_cones(mesh)
    if orders is None or len(orders) < len(picked) or not picked:
        return
    cones.write_cones(mesh, [cones.Cone(cone.vertex, order) for cone, order in zip(picked, orders)])


class OrbifoldCone(bpy.types.PropertyGroup):
    """One cone of a mesh, as the list shows it."""

    vertex: IntProperty(name="Vertex", description="Index of the vertex that becomes this cone", min=0)
    rank: IntProperty(options={"HIDDEN"})
    order: IntProperty(
        name="Order",
        description="A cone of order N has the angle 360 / N degrees in the layout. Changing it rewrites the signature",
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
            "Conway's notation: the orders of the cones, one digit each, larger ones in parentheses, as 442 or 22(12). "
            "The cones take these orders in the sequence of the list; the geometry follows from them"
        ),
        maxlen=4096,
        update=_signature_changed,
    )


CLASSES = (OrbifoldCone, OrbifoldMesh)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Mesh.orbifold = PointerProperty(type=OrbifoldMesh)


def unregister() -> None:
    del bpy.types.Mesh.orbifold
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
