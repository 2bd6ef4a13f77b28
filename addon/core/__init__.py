# SPDX-License-Identifier: GPL-3.0-or-later
"""Orbifold embeddings of triangle meshes, without Blender: NumPy and the native library beside this file.

    import core
    result = core.embed(vertices, triangles, "442", [100, 1000, 2000])
"""

from .binding import library
from .embed import CHARTS, EmbeddingJob, Result, embed, start_embedding
from .errors import OrbifoldError
from .meshio import MeshFileError, read_mesh
from .signatures import Signature, format_signature, geometry_of, parse_signature, suggest_signatures

__all__ = [
    "CHARTS",
    "EmbeddingJob",
    "MeshFileError",
    "OrbifoldError",
    "Result",
    "Signature",
    "embed",
    "format_signature",
    "geometry_of",
    "library",
    "parse_signature",
    "read_mesh",
    "start_embedding",
    "suggest_signatures",
]
