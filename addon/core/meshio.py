# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads .off and plain .obj files: vertices, and polygons cut into fans of triangles. Errors name the line."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

import numpy as np


class MeshFileError(ValueError):
    """A mesh file that cannot be read; the message names the file and the line (from 1)."""


def read_mesh(path: str | os.PathLike) -> tuple[np.ndarray, np.ndarray]:
    """(n, 3) float64 vertices and (m, 3) int32 triangles of a file, by its ending."""
    readers = {".off": read_off, ".obj": read_obj}
    ending = Path(path).suffix.lower()
    if ending not in readers:
        raise MeshFileError(f"{path}: only .off and .obj are read here, not '{ending}'")
    return readers[ending](path)


def read_off(path: str | os.PathLike) -> tuple[np.ndarray, np.ndarray]:
    """OFF (also COFF, NOFF and their like: what follows the coordinates or the polygon is skipped)."""
    numbers, lines = _lines(path)
    if not lines or not lines[0].split()[0].endswith("OFF"):
        raise MeshFileError(f"{path}:{numbers[0] if numbers else 1}: the file does not begin with OFF")
    first = lines[0].split()[1:]
    at = 0 if first else 1  # the counts may stand beside OFF
    counts = first or (lines[1].split() if len(lines) > 1 else [])
    try:
        n, m = int(counts[0]), int(counts[1])
        if n < 0 or m < 0:
            raise ValueError
    except (IndexError, ValueError):
        raise MeshFileError(f"{path}:{numbers[min(at, len(lines) - 1)]}: no counts of vertices and faces") from None
    body, where = lines[at + 1 :], numbers[at + 1 :]
    if len(body) < n + m:
        raise MeshFileError(
            f"{path}:{numbers[-1]}: the file ends after {len(body)} of {n} vertices and {m} faces"
        )
    vertices = _coordinates(path, body[:n], where[:n])
    faces = body[n : n + m]
    table = _table(faces, int)
    if table is not None and table.shape[1] >= 4 and (table[:, 0] == 3).all():
        return vertices, _checked(path, table[:, 1:4], where[n : n + m], n)
    polygons = []
    for line, number in zip(faces, where[n : n + m]):
        words = line.split()
        try:
            polygon = [int(word) for word in words[1 : 1 + int(words[0])]]
            if len(polygon) != int(words[0]) or len(polygon) < 3:
                raise ValueError
        except ValueError:
            raise MeshFileError(f"{path}:{number}: not a polygon: '{line.strip()}'") from None
        polygons.append(polygon)
    return vertices, _fans(path, polygons, where[n : n + m], n)


def read_obj(path: str | os.PathLike) -> tuple[np.ndarray, np.ndarray]:
    """Lines `v` and `f` of Wavefront OBJ; normals, texture coordinates, groups and materials are skipped."""
    numbers, lines = _lines(path)
    vertex_lines: list[str] = []
    vertex_numbers: list[int] = []
    polygons: list[list[int]] = []
    polygon_numbers: list[int] = []
    for number, line in zip(numbers, lines):
        key, rest = (line.split(maxsplit=1) + [""])[:2]
        if key == "v":
            vertex_lines.append(rest)
            vertex_numbers.append(number)
        elif key == "f":
            try:
                polygon = [int(word.partition("/")[0]) for word in rest.split()]
                if len(polygon) < 3 or 0 in polygon:
                    raise ValueError
            except ValueError:
                raise MeshFileError(f"{path}:{number}: not a polygon: '{line.strip()}'") from None
            # counted from 1, or, when negative, back from the last vertex so far
            polygons.append([i - 1 if i > 0 else len(vertex_lines) + i for i in polygon])
            polygon_numbers.append(number)
    vertices = _coordinates(path, vertex_lines, vertex_numbers)
    return vertices, _fans(path, polygons, polygon_numbers, len(vertices))


def _lines(path: str | os.PathLike) -> tuple[list[int], list[str]]:
    """The lines that are not empty, less comments, and their numbers from 1."""
    text = Path(path).read_text(encoding="utf-8", errors="replace")
    if "#" in text:
        text = "\n".join(line.partition("#")[0] for line in text.split("\n"))
    pairs = [(number, line) for number, line in enumerate(text.split("\n"), 1) if line and not line.isspace()]
    return [number for number, _ in pairs], [line for _, line in pairs]


def _table(lines: Sequence[str], kind: type) -> np.ndarray | None:
    """The lines as an array, if they hold equally many numbers each."""
    if not lines:
        return None
    width = len(lines[0].split())
    try:
        flat = np.array(" ".join(lines).split(), dtype=kind)
    except ValueError:
        return None
    if flat.size != width * len(lines) or any(len(line.split()) != width for line in lines):
        return None
    return flat.reshape(len(lines), width)


def _coordinates(path: str | os.PathLike, lines: Sequence[str], numbers: Sequence[int]) -> np.ndarray:
    if not lines:
        return np.zeros((0, 3))
    table = _table(lines, float)
    if table is not None and table.shape[1] >= 3:
        return np.ascontiguousarray(table[:, :3])
    vertices = np.empty((len(lines), 3))
    for row, (line, number) in enumerate(zip(lines, numbers)):
        try:
            x, y, z = (float(word) for word in line.split()[:3])
        except ValueError:
            raise MeshFileError(f"{path}:{number}: not three coordinates: '{line.strip()}'") from None
        vertices[row] = x, y, z
    return vertices


def _fans(path: str | os.PathLike, polygons: list[list[int]], numbers: Sequence[int], n: int) -> np.ndarray:
    """Each polygon p as triangles p0 p1 p2, p0 p2 p3, ..., in the sequence of the polygons."""
    if not polygons:
        return np.zeros((0, 3), np.int32)
    size = np.array([len(polygon) for polygon in polygons])
    corners = np.concatenate([np.asarray(polygon) for polygon in polygons])
    start = np.concatenate([[0], np.cumsum(size)[:-1]])
    polygon = np.repeat(np.arange(len(polygons)), size - 2)
    first = np.repeat(start, size - 2)
    step = np.arange(len(polygon)) - np.repeat(np.concatenate([[0], np.cumsum(size - 2)[:-1]]), size - 2)
    triangles = np.stack([corners[first], corners[first + step + 1], corners[first + step + 2]], axis=1)
    return _checked(path, triangles, np.asarray(numbers)[polygon], n)


def _checked(path: str | os.PathLike, triangles: np.ndarray, numbers: Sequence[int], n: int) -> np.ndarray:
    """int32 triangles all of whose vertices exist."""
    bad = np.flatnonzero(((triangles < 0) | (triangles >= n)).any(1))
    if len(bad):
        raise MeshFileError(f"{path}:{numbers[bad[0]]}: a polygon names a vertex that is not among the {n} given")
    return np.ascontiguousarray(triangles, dtype=np.int32)
