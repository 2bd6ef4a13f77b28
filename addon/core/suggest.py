# SPDX-License-Identifier: GPL-3.0-or-later
"""Where to put the cones. `suggest_cones` waits, `start_suggesting` gives a job to poll.

    best = suggest_cones(vertices, triangles)[0]
    result = embed(vertices, triangles, best.signature, best.cones)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from . import binding
from .arrays import holes_of, integers, mesh_of, unknown
from .errors import OrbifoldError
from .jobs import Job, Progress, wait_for
from .signatures import geometry_of

ATTEMPTS = 5  # suggestions to try before giving up, where an embedding fails for its cones
PLANE_ONLY = "mean-value-exact"  # weights
# What may go well with other cones on the same mesh.
DEPENDS_ON_CONES = ("ORB_CUT_BLOCKED", "ORB_NOT_CONVERGED", "ORB_CERTIFICATE_FAILED", "ORB_LINEAR_SOLVER")


@dataclass(frozen=True)
class Suggestion:
    """Cones for a mesh. Spreads are area-weighted standard deviations of log(area on the tile / area on the mesh)."""

    signature: str
    cones: tuple[int, ...]  # vertices, in the signature's sequence, as `embed` takes them
    orders: tuple[int, ...]  # that sequence
    predicted: float  # the spread of the conformal map; where `measured`, of the embedding, distorted angles included
    conformal: float  # the spread of a conformal map with these cones
    measured: bool  # four hyperbolic cones and more: the tile is not the conformal one, so the embedding was made
    symmetric: bool  # the cones are their own mirror image


class SuggestionJob(Job[list[Suggestion]]):
    """`start_suggesting` makes it; `finish` gives the suggestions, best first."""

    def __init__(self, job: binding.SuggestionJob) -> None:
        super().__init__(job, _suggestions_of)


def start_suggesting(
    vertices: ArrayLike,
    triangles: ArrayLike,
    signatures: str | Sequence[str] | None = None,
    fixed: Sequence[int] | np.ndarray = (),
    keep_away: ArrayLike | None = None,
    *,
    flat: bool = False,
    holes: str = "refuse",
    symmetry: str | Sequence[float] = "detect",
) -> SuggestionJob:
    """Starts what `suggest_cones` does and returns at once. Arrays may change afterwards."""
    points, faces = mesh_of(vertices, triangles)
    names = [signatures] if isinstance(signatures, str) else signatures
    if names is not None and not len(names):
        raise OrbifoldError("ORB_BAD_ARGUMENT", "there are no signatures in the list; leave it out for the usual ones")
    kept = integers(fixed, (-1,), "fixed cones", "ORB_BAD_CONE", "vertex")
    weights = None if keep_away is None else _weights_of(keep_away, len(points))
    way, plane = _symmetry_of(symmetry)
    request = binding.suggest_request_of(names, bool(flat), kept, weights, holes_of(holes), way, plane)
    return SuggestionJob(binding.SuggestionJob(binding.mesh_arrays(points, faces), request))


def suggest_cones(
    vertices: ArrayLike,
    triangles: ArrayLike,
    signatures: str | Sequence[str] | None = None,
    fixed: Sequence[int] | np.ndarray = (),
    keep_away: ArrayLike | None = None,
    *,
    flat: bool = False,
    holes: str = "refuse",
    symmetry: str | Sequence[float] = "detect",
    progress: Progress | None = None,
) -> list[Suggestion]:
    """For each signature the cones with the least spread of log area; the least `predicted` first. The same arguments
    always give the same cones.

    signatures  one, or several; None: what is usual for the mesh's topology
    fixed       vertices that are cones (on the boundary: mirror corners) of every suggestion
    keep_away   (n,) >= 0: what a cone at each vertex costs, in squared log area; infinite: never there
    flat        of the usual signatures only those of the plane, where there are any: an image repeats over their tile
    holes       as for `embed`
    symmetry    "detect" the mesh's mirror plane and suggest symmetric cones, "ignore" it, or a plane: the four numbers
                of a x + b y + c z = d
    progress    as for `embed`

    Raises OrbifoldError. Signatures that do not fit are left out, unless that leaves nothing.
    """
    job = start_suggesting(
        *(vertices, triangles, signatures, fixed, keep_away), flat=flat, holes=holes, symmetry=symmetry
    )
    return wait_for(job, progress)


def worth_trying(suggestions: Sequence[Suggestion], weights: str = "conformal") -> list[Suggestion]:
    """Those to embed in turn, with these weights, until one does not fail with a status of DEPENDS_ON_CONES."""
    if weights == PLANE_ONLY:
        suggestions = [one for one in suggestions if geometry_of(one.signature) == "euclidean"] or suggestions
    return list(suggestions[:ATTEMPTS])


def _suggestions_of(native: binding.Suggestions) -> list[Suggestion]:
    """Copies out of the library's."""
    return [
        Suggestion(
            view.signature.decode(),
            tuple(view.cones[: view.n_cones]) if view.n_cones else (),
            tuple(view.orders[: view.n_cones]) if view.n_cones else (),
            *(view.predicted, view.conformal, view.measured, view.symmetric),
        )
        for view in native.views()
    ]


def _weights_of(keep_away: ArrayLike, n_vertices: int) -> np.ndarray:
    try:
        weights = np.array(keep_away, dtype=np.float64, order="C")
    except (TypeError, ValueError) as reason:
        raise OrbifoldError("ORB_BAD_ARGUMENT", f"keep_away is not an array of numbers: {reason}") from reason
    if weights.shape != (n_vertices,):
        raise OrbifoldError(
            "ORB_BAD_ARGUMENT", f"keep_away has the shape {weights.shape}; give one number for each of the "
            f"{n_vertices} vertices"
        )
    return weights


def _symmetry_of(symmetry: str | Sequence[float]) -> tuple[int, tuple[float, ...]]:
    """The C enum's entry and the plane's four numbers."""
    if isinstance(symmetry, str):
        if symmetry not in binding.SYMMETRIES:
            raise unknown("way to treat symmetry", symmetry, (*binding.SYMMETRIES, "four numbers of a plane"))
        return binding.SYMMETRIES[symmetry], (0.0, 0.0, 0.0, 0.0)
    try:
        a, b, c, d = (float(number) for number in symmetry)
    except (TypeError, ValueError) as reason:
        raise OrbifoldError(
            "ORB_BAD_ARGUMENT", "the symmetry is neither 'detect' nor 'ignore' nor four numbers (a, b, c, d) of the "
            "plane a x + b y + c z = d"
        ) from reason
    return binding.SYMMETRY_PLANE, (a, b, c, d)
