# SPDX-License-Identifier: GPL-3.0-or-later
"""Orbifold embeddings of triangle meshes, without Blender: NumPy and the native library beside this file.

    import core
    result = core.embed(vertices, triangles, "442", [100, 1000, 2000])
"""

from .binding import library
from .defects import Defect, find_defects
from .embed import EmbeddingJob, embed, start_embedding
from .errors import OrbifoldError
from .fitting import fitting_signatures
from .jobs import Job, Progress, wait_for, wait_until_over
from .meshio import MeshFileError, read_mesh
from .polygon import Polygon
from .predict import Prediction, PredictionJob, predict, start_predicting
from .prepare import PreparedMesh, prepare
from .result import CHARTS, Result
from .signatures import (
    Outline,
    Signature,
    describe,
    format_signature,
    geometry_of,
    parse_signature,
    surface_name,
    tile_outline,
)
from .suggest import (
    DEPENDS_ON_CONES,
    Suggestion,
    SuggestionJob,
    start_suggesting,
    suggest_cones,
    worth_trying,
)
from .surface_map import MapDistortion, SurfaceMap, Trace, interpolated, landmark_sequence, surface_map
from .topology import Topology, topology_of, vertex_components
from .wallpaper import Wallpaper, fill_seam_margin
from .whole import WholeLayout, edge_keys, whole_layout

__all__ = [
    "CHARTS",
    "DEPENDS_ON_CONES",
    "Defect",
    "EmbeddingJob",
    "Job",
    "MapDistortion",
    "MeshFileError",
    "OrbifoldError",
    "Outline",
    "Polygon",
    "Prediction",
    "PredictionJob",
    "PreparedMesh",
    "Progress",
    "Result",
    "Signature",
    "Suggestion",
    "SuggestionJob",
    "SurfaceMap",
    "Trace",
    "Topology",
    "Wallpaper",
    "WholeLayout",
    "describe",
    "edge_keys",
    "embed",
    "fill_seam_margin",
    "find_defects",
    "fitting_signatures",
    "format_signature",
    "geometry_of",
    "interpolated",
    "landmark_sequence",
    "library",
    "parse_signature",
    "predict",
    "prepare",
    "read_mesh",
    "start_embedding",
    "start_predicting",
    "start_suggesting",
    "suggest_cones",
    "surface_name",
    "surface_map",
    "tile_outline",
    "topology_of",
    "vertex_components",
    "wait_for",
    "wait_until_over",
    "whole_layout",
    "worth_trying",
]
