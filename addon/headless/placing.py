# SPDX-License-Identifier: GPL-3.0-or-later
"""Signature, cones and embedding of a run: cones as they are given, or the best suggestion that can be embedded."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Optional

from .. import core
from .arguments import DEFAULT_SIGNATURE, Arguments
from .errors import RunError

if TYPE_CHECKING:
    from .. import blender_mesh


@dataclass(frozen=True)
class Placed:
    result: core.Result
    suggestion: Optional[core.Suggestion]  # None: the cones were given, or there are none
    remarks: list[str]


def embed_placed(arguments: Arguments, arrays: blender_mesh.MeshArrays) -> Placed:
    signature = arguments.signature
    if signature is None and (arguments.cones is not None or arguments.orders is not None):
        signature = DEFAULT_SIGNATURE
    if arguments.cones is None and (signature is None or core.parse_signature(signature).orders):
        return _embed_suggested(arguments, arrays, signature)
    return Placed(_embed(arguments, arrays, signature, arguments.cones or (), arguments.orders), None, [])


def _embed_suggested(arguments: Arguments, arrays: blender_mesh.MeshArrays, signature: Optional[str]) -> Placed:
    if signature is not None and arguments.orders is not None:
        _check_orders(signature, arguments.orders)
    found = core.suggest_cones(arrays.vertices, arrays.triangles, signature, holes=arguments.holes)
    failed: list[core.OrbifoldError] = []
    tried = core.worth_trying(found, arguments.weights)
    for suggestion in tried:
        cones = suggestion.cones
        if arguments.orders is not None:
            cones = _in_sequence(suggestion, arguments.orders)
        try:
            result = _embed(arguments, arrays, suggestion.signature, cones, arguments.orders)
        except core.OrbifoldError as error:
            if error.status not in core.DEPENDS_ON_CONES:
                raise
            failed.append(error)
        else:
            return Placed(result, suggestion, [_remark(failed, tried)] if failed else [])
    raise failed[0]


def _embed(arguments: Arguments, arrays: blender_mesh.MeshArrays, signature: str, cones: tuple[int, ...],
           orders: Optional[tuple[int, ...]]) -> core.Result:
    return core.embed(arrays.vertices, arrays.triangles, signature, cones, orders, arguments.weights,
                      holes=arguments.holes)


def _check_orders(signature: str, orders: tuple[int, ...]) -> None:
    wanted = core.parse_signature(signature).orders
    if sorted(orders) != sorted(wanted):
        raise RunError(f"--orders {','.join(map(str, orders))}: these are not the orders of {signature}, which are "
                       f"{','.join(map(str, wanted))} in any sequence")


def _in_sequence(suggestion: core.Suggestion, orders: tuple[int, ...]) -> tuple[int, ...]:
    """The suggested cones, each keeping its order, in the sequence that `--orders` asks for."""
    left = list(zip(suggestion.orders, suggestion.cones))
    chosen = []
    for order in orders:
        place = next(place for place, (own, _) in enumerate(left) if own == order)
        chosen.append(left.pop(place)[1])
    return tuple(chosen)


def _remark(failed: list[core.OrbifoldError], tried: list[core.Suggestion]) -> str:
    """Why the best suggestion is not the one that was used."""
    names = " and ".join(suggestion.signature for suggestion in tried[: len(failed)])
    best = "the best suggestion" if len(failed) == 1 else f"the best {len(failed)} suggestions"
    return f"{best}, {names}, could not be embedded ({failed[0]}); this is the next one"
