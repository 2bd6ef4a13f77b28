# SPDX-License-Identifier: GPL-3.0-or-later
"""What given cones do to areas. `predict` waits, `start_predicting` gives a job to poll."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from . import binding
from .arrays import holes_of, mesh_of, picks_of
from .jobs import Job, Progress, wait_for


@dataclass(frozen=True, eq=False)
class Prediction:
    """Of the conformal map with given cones."""

    spread: float  # of log area
    scale: np.ndarray  # (n,) u: lengths are stretched by e^u; area-weighted mean 0, and 0 at isolated vertices


class PredictionJob(Job[Prediction]):
    """`start_predicting` makes it; `finish` gives the prediction."""

    def __init__(self, job: binding.PredictionJob) -> None:
        super().__init__(job, lambda made: Prediction(*made))


def predict(
    vertices: ArrayLike,
    triangles: ArrayLike,
    signature: str,
    cones: Sequence[int] | np.ndarray,
    orders: Sequence[int] | np.ndarray | None = None,
    *,
    holes: str = "refuse",
    progress: Progress | None = None,
) -> Prediction:
    """What the conformal map with these cones does to areas: one linear solve. Arguments are those of `embed`."""
    return wait_for(start_predicting(vertices, triangles, signature, cones, orders, holes=holes), progress)


def start_predicting(
    vertices: ArrayLike,
    triangles: ArrayLike,
    signature: str,
    cones: Sequence[int] | np.ndarray,
    orders: Sequence[int] | np.ndarray | None = None,
    *,
    holes: str = "refuse",
) -> PredictionJob:
    """Starts what `predict` does and returns at once; arrays may change afterwards."""
    points, faces = mesh_of(vertices, triangles)
    picked, orders = picks_of(cones, orders)
    request = binding.request_of(signature, picked, orders, holes_of(holes))
    return PredictionJob(binding.PredictionJob(binding.mesh_arrays(points, faces), request))
