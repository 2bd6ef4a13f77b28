# SPDX-License-Identifier: GPL-3.0-or-later
"""native/include/orbifold.h, orbifold_cones.h, orbifold_maps.h and orbifold_images.h, declared for Python. Nothing else
uses ctypes.

`library()` loads it from this folder at the first call. Names and the sequence of fields are the
headers'; tests/core/test_binding.py compares them with what a C compiler makes of them."""

from __future__ import annotations

import ctypes
import functools
import sys
import weakref
from collections.abc import Sequence
from ctypes import POINTER, Structure, c_bool, c_char, c_char_p, c_double, c_int, c_int32, c_int64, c_uint16, c_void_p
from pathlib import Path

import numpy as np

from .errors import OrbifoldError

VERSION = "0.2.0"
NAMES = {"win32": "liborbifold.dll", "darwin": "liborbifold.dylib"}  # by sys.platform; else
LIBRARY = Path(__file__).with_name(NAMES.get(sys.platform, "liborbifold.so"))

OK = 0
MAX_ELEMENTS = 16
STAGE_LENGTH = 32
ELEMENTS = (None, "vertex", "edge", "triangle", "character")
WEIGHTS = {
    "cotan": 0,
    "mean-value": 1,
    "uniform": 2,
    "conformal": 4,
    "delaunay": 5,
    "mean-value-exact": 6,
}
WEIGHTS_GIVEN = 3
HOLES = {"refuse": 0, "fill": 1, "mirror": 2}
CUTS = {"automatic": 0, "path": 1}
SYMMETRIES = {"detect": 0, "ignore": 1}
SYMMETRY_PLANE = 2
SOURCES = {"tile": 0, "all": 1, "painted": 2}
TEXELS = {"uint8": 0, "uint16": 1, "float32": 2}
CHARTS = {
    "default": 0,
    "periodic": 1,
    "conformal": 2,
    "stereographic": 3,
    "equirectangular": 4,
    "octahedral": 5,
    "poincare": 6,
    "klein": 7,
}

DOUBLES = POINTER(c_double)
INT32S = POINTER(c_int32)
BOOLS = POINTER(c_bool)
Progress = ctypes.CFUNCTYPE(c_bool, c_char_p, c_double, c_void_p)


class Error(Structure):
    _fields_ = [
        ("status", c_int),
        ("element", c_int),
        ("n_elements", c_int32),
        ("elements", c_int32 * MAX_ELEMENTS),
        ("n_found", c_int64),
        ("message", c_char * 320),
    ]


class MeshArrays(Structure):
    _fields_ = [
        ("n_vertices", c_int32),
        ("vertices", DOUBLES),
        ("n_triangles", c_int32),
        ("triangles", INT32S),
    ]


class Polygon(Structure):
    _fields_ = [
        ("curvature", c_int32),
        ("n_corners", c_int32),
        ("corners", DOUBLES),
        ("radius", c_double),
    ]


class Request(Structure):
    _fields_ = [
        ("signature", c_char_p),
        ("n_cones", c_int32),
        ("cones", INT32S),
        ("orders", INT32S),
        ("holes", c_int),
        ("cut", c_int),
        ("polygon", POINTER(Polygon)),
        ("weights", c_int),
        ("clamp", c_double),
        ("n_edge_weights", c_int32),
        ("edge_weights", DOUBLES),
        ("prepared", c_void_p),
        ("progress", Progress),
        ("user", c_void_p),
    ]


class SignatureInfo(Structure):
    _fields_ = [
        ("curvature", c_int32),
        ("geometry", c_char_p),
        ("euler", c_double),
        ("n_cones", c_int32),
        ("supported", c_bool),
        *((name, c_int32) for name in ("n_interior", "n_mirrors", "n_crosscaps", "n_handles")),
    ]


class View(Structure):
    _fields_ = [
        *((name, c_int32) for name in ("n_vertices", "n_triangles", "n_copies", "n_cones", "n_edges", "n_seams")),
        ("n_input_triangles", c_int32),
        ("vertices", DOUBLES),
        ("triangles", INT32S),
        ("refined_from", INT32S),
        ("input_corners", INT32S),
        ("cut_triangles", INT32S),
        ("cut_to_vertex", INT32S),
        ("embedding", DOUBLES),
        ("embedding_low", DOUBLES),
        ("cones", INT32S),
        ("orders", INT32S),
        ("mirrors", BOOLS),
        ("weights", DOUBLES),
        ("n_generators", c_int32),
        ("generators", DOUBLES),
        ("seams", INT32S),
        ("signature", c_char_p),
        ("geometry", c_char_p),
    ]


class Report(Structure):
    _fields_ = [
        *((name, c_int32) for name in ("vertices", "triangles", "components", "euler", "boundary_loops", "genus")),
        ("orientable", c_bool),
        ("filled_holes", c_int32),
        ("refined_edges", c_int32),
        ("orbifold_euler", c_double),
        ("n_moduli", c_int32),
        ("modulus", c_double * 2),
        ("iterations", c_int32),
        ("energy", c_double),
        ("relative_gradient", c_double),
        *((name, c_int64) for name in ("clamped_weights", "factor_nonzeros", "flipped", "flipped_float32")),
        *((name, c_double) for name in ("seam_residual", "angle_residual", "area_residual")),
        *(
            (name, c_double)
            for name in (
                "quasi_conformal_mean",
                "quasi_conformal_median",
                "quasi_conformal_max",
                "log_area_std",
                "symmetric_dirichlet",
                "seconds_topology",
                "seconds_cut",
                "seconds_tile",
                "seconds_initial",
                "seconds_assemble",
                "seconds_analyze",
                "seconds_factor",
                "seconds_solve",
                "seconds_certify",
                "seconds_total",
            )
        ),
    ]


class SuggestRequest(Structure):
    _fields_ = [
        ("n_signatures", c_int32),
        ("signatures", POINTER(c_char_p)),
        ("flat", c_bool),
        ("n_fixed", c_int32),
        ("fixed", INT32S),
        ("keep_away", DOUBLES),
        ("holes", c_int),
        ("symmetry", c_int),
        ("plane", c_double * 4),
        ("progress", Progress),
        ("user", c_void_p),
    ]


class Suggestion(Structure):
    _fields_ = [
        ("signature", c_char_p),
        ("n_cones", c_int32),
        ("cones", INT32S),
        ("orders", INT32S),
        ("predicted", c_double),
        ("conformal", c_double),
        ("measured", c_bool),
        ("symmetric", c_bool),
    ]


class MapReport(Structure):
    _fields_ = [("steps", c_int64), ("elements", c_int32), ("in_holes", c_int32), ("landmark_residual", c_double)]


class Stretch(Structure):
    _fields_ = [("edge", c_int32), ("triangle", c_int32), ("at", c_double * 2), ("barycentric", c_double * 3 * 2)]


class MapDistortion(Structure):
    _fields_ = [
        *(
            (name, c_double)
            for name in ("quasi_conformal_mean", "quasi_conformal_max", "log_area_mean", "log_area_std")
        ),
        ("flipped", c_int64),
        ("left_out", c_int64),
    ]


class Image(Structure):  # orb_image
    _fields_ = [
        ("width", c_int32), ("height", c_int32), ("channels", c_int32), ("texel", c_int), ("pixels", c_void_p),
    ]


class WallpaperView(Structure):  # orb_wallpaper_view
    _fields_ = [("order", c_int32), ("exact", c_bool), ("motions", DOUBLES), ("to_tile", POINTER(c_uint16))]


EMBEDDING = c_void_p  # orb_embedding *
SUGGESTIONS = c_void_p  # orb_suggestions *
TRACE = c_void_p  # orb_trace *
WALLPAPER = c_void_p  # orb_wallpaper *
JOB = c_void_p  # orb_job *
PREPARED = c_void_p  # orb_prepared *

# name: (result, arguments)
PROTOTYPES = {
    "orb_status_name": (c_char_p, [c_int]),
    "orb_request_default": (Request, []),
    "orb_signature_read": (c_int, [c_char_p, POINTER(SignatureInfo), INT32S, c_int32, POINTER(Error)]),
    "orb_signature_tile": (c_int, [c_char_p, DOUBLES, BOOLS, c_int32, INT32S, POINTER(Error)]),
    "orb_embed": (c_int, [POINTER(MeshArrays), POINTER(Request), POINTER(EMBEDDING), POINTER(Error)]),
    "orb_prepare": (c_int, [POINTER(MeshArrays), POINTER(PREPARED), POINTER(Error)]),
    "orb_prepared_free": (None, [PREPARED]),
    "orb_embedding_free": (None, [EMBEDDING]),
    "orb_embedding_view": (None, [EMBEDDING, POINTER(View)]),
    "orb_embedding_report": (None, [EMBEDDING, POINTER(Report)]),
    "orb_uv": (c_int, [EMBEDDING, c_int, DOUBLES, POINTER(c_int64), POINTER(Error)]),
    "orb_whole_sphere": (c_int, [EMBEDDING, DOUBLES, POINTER(c_int64), POINTER(Error)]),
    "orb_job_start": (c_int, [POINTER(MeshArrays), POINTER(Request), POINTER(JOB), POINTER(Error)]),
    "orb_job_poll": (c_bool, [JOB, c_char_p, POINTER(c_double)]),
    "orb_job_cancel": (None, [JOB]),
    "orb_job_finish": (c_int, [JOB, POINTER(EMBEDDING), POINTER(Error)]),
    "orb_version": (c_char_p, []),
    "orb_suggest_cones": (c_int, [POINTER(MeshArrays), POINTER(SuggestRequest), POINTER(SUGGESTIONS), POINTER(Error)]),
    "orb_suggestions_free": (None, [SUGGESTIONS]),
    "orb_suggestions_count": (c_int32, [SUGGESTIONS]),
    "orb_suggestions_view": (Suggestion, [SUGGESTIONS, c_int32]),
    "orb_suggestions_plane": (c_bool, [SUGGESTIONS, DOUBLES]),
    "orb_predict": (c_int, [POINTER(MeshArrays), POINTER(Request), DOUBLES, DOUBLES, POINTER(Error)]),
    "orb_job_start_suggest": (c_int, [POINTER(MeshArrays), POINTER(SuggestRequest), POINTER(JOB), POINTER(Error)]),
    "orb_job_finish_suggest": (c_int, [JOB, POINTER(SUGGESTIONS), POINTER(Error)]),
    "orb_job_start_predict": (c_int, [POINTER(MeshArrays), POINTER(Request), POINTER(JOB), POINTER(Error)]),
    "orb_job_finish_predict": (c_int, [JOB, DOUBLES, DOUBLES, POINTER(Error)]),
    "orb_surface_map": (
        c_int,
        [EMBEDDING, EMBEDDING, c_int32, INT32S, DOUBLES, INT32S, DOUBLES, POINTER(MapReport), POINTER(Error)],
    ),
    "orb_surface_map_distortion": (
        c_int,
        [EMBEDDING, EMBEDDING, DOUBLES, DOUBLES, POINTER(MapDistortion), POINTER(Error)],
    ),
    "orb_surface_map_trace": (c_int, [EMBEDDING, EMBEDDING, c_int32, INT32S, POINTER(TRACE), POINTER(Error)]),
    "orb_trace_free": (None, [TRACE]),
    "orb_trace_count": (c_int64, [TRACE]),
    "orb_trace_read": (None, [TRACE, c_void_p]),
    "orb_wallpaper_create": (
        c_int,
        [c_int32, c_int32, c_int32, DOUBLES, c_int32, DOUBLES, c_int32, POINTER(WALLPAPER), POINTER(Error)],
    ),
    "orb_wallpaper_free": (None, [WALLPAPER]),
    "orb_wallpaper_look": (WallpaperView, [WALLPAPER]),
    "orb_wallpaper_apply": (
        c_int, [WALLPAPER, POINTER(Image), c_int, c_void_p, INT32S, c_int32, POINTER(Error)],
    ),
    "orb_fill_seam_margin": (c_int, [POINTER(Image), c_bool, c_int32, INT32S, DOUBLES, c_int32, POINTER(Error)]),
    "orb_landmark_sequence": (c_int, [POINTER(MeshArrays), c_int32, INT32S, INT32S, INT32S, POINTER(Error)]),
}


@functools.cache
def library() -> ctypes.CDLL:
    """The native library with every prototype set. OrbifoldError "ORB_NO_LIBRARY" where it cannot be used."""
    if not LIBRARY.is_file():
        raise OrbifoldError(
            "ORB_NO_LIBRARY", f"the native library {LIBRARY.name} is not in {LIBRARY.parent}; run `./build.sh native`"
        )
    try:
        loaded = ctypes.CDLL(str(LIBRARY))
        for name, (result, arguments) in PROTOTYPES.items():
            function = getattr(loaded, name)
            function.restype, function.argtypes = result, arguments
    except (OSError, AttributeError) as reason:
        raise OrbifoldError("ORB_NO_LIBRARY", f"the native library cannot be loaded here: {reason}") from reason
    version = loaded.orb_version().decode()
    if version != VERSION:  # structures may differ then
        raise OrbifoldError(
            "ORB_NO_LIBRARY", f"the native library is version {version}, not {VERSION}; build it again"
        )
    return loaded


def error_from(record: Error) -> OrbifoldError:
    """The C library's error record as an exception."""
    element = ELEMENTS[record.element]
    entries = list(record.elements[: record.n_elements])
    return OrbifoldError(
        library().orb_status_name(record.status).decode(),
        record.message.decode(errors="replace"),
        list(zip(entries[::2], entries[1::2])) if element == "edge" else entries,
        element,
        record.n_found,
    )


def check(status: int, record: Error) -> None:
    if status != OK:
        raise error_from(record)


def doubles(array: np.ndarray | None):
    """Pointer to a contiguous float64 array, which the caller keeps alive; None is NULL."""
    return None if array is None else array.ctypes.data_as(DOUBLES)


def int32s(array: np.ndarray | None):
    """Pointer to a contiguous int32 array, which the caller keeps alive; None is NULL."""
    return None if array is None else array.ctypes.data_as(INT32S)


def copied(pointer, *shape: int) -> np.ndarray:
    """A NumPy array of its own, copied from the library's."""
    if 0 in shape:
        return np.zeros(shape, np.dtype(pointer._type_))
    return np.ctypeslib.as_array(pointer, shape).copy()


def read_signature(text: str) -> tuple[SignatureInfo, list[int]]:
    """orb_signature_read: the information and the orders of all cones and corners."""
    encoded = encode_signature(text)
    info, record = SignatureInfo(), Error()
    native = library()
    check(native.orb_signature_read(encoded, info, None, 0, record), record)
    orders = (c_int32 * info.n_cones)()
    check(native.orb_signature_read(encoded, info, orders, info.n_cones, record), record)
    return info, list(orders)


def signature_tile(text: str) -> tuple[np.ndarray, np.ndarray]:
    """orb_signature_tile: the corners (k, 3), counter-clockwise, and whether each side, from its corner to the next,
    is a mirror (k,)."""
    encoded, native = encode_signature(text), library()
    count, record = c_int32(), Error()
    check(native.orb_signature_tile(encoded, None, None, 0, count, record), record)
    points, mirrors = np.empty((count.value, 3)), np.empty(count.value, bool)
    filled = native.orb_signature_tile(
        encoded, doubles(points), mirrors.ctypes.data_as(BOOLS), count.value, count, record
    )
    check(filled, record)
    return points, mirrors


def landmark_sequence(
    vertices: np.ndarray, triangles: np.ndarray, landmarks: np.ndarray, orders: np.ndarray | None
) -> np.ndarray:
    """orb_landmark_sequence: numbers of landmarks (k,)."""
    sequence, record = np.empty(len(landmarks), np.int32), Error()
    found = library().orb_landmark_sequence(
        mesh_arrays(vertices, triangles), len(landmarks), int32s(landmarks), int32s(orders), int32s(sequence), record
    )
    check(found, record)
    return sequence


def encode_signature(text: str) -> bytes:
    """A signature for C: UTF-8 without a NUL, at which C would stop reading."""
    if not isinstance(text, str):
        raise OrbifoldError("ORB_BAD_ARGUMENT", f"a signature is a string such as '442', not {type(text).__name__}")
    if "\0" in text:
        raise OrbifoldError(
            "ORB_BAD_SIGNATURE", "the signature contains a NUL character", [text.index("\0")], "character"
        )
    return text.encode(errors="replace")


class Embedding:
    """An orb_embedding, freed with this object. Arrays that it gives are copies."""

    def __init__(self, pointer: c_void_p) -> None:
        self._pointer = pointer
        self._native = library()
        weakref.finalize(self, self._native.orb_embedding_free, pointer)

    def view(self) -> View:
        """Pointers into the embedding: valid only while this object is."""
        view = View()
        self._native.orb_embedding_view(self._pointer, view)
        return view

    def report(self) -> Report:
        report = Report()
        self._native.orb_embedding_report(self._pointer, report)
        return report

    def uv(self, chart: int, n_triangles: int) -> tuple[np.ndarray, int]:
        """(n_triangles, 3, 2) coordinates and the triangles that are not positive once these are float32."""
        uv, flipped, record = np.empty((n_triangles, 3, 2)), c_int64(), Error()
        check(self._native.orb_uv(self._pointer, chart, doubles(uv), flipped, record), record)
        return uv, flipped.value

    def whole_sphere(self, n_vertices: int) -> tuple[np.ndarray, int]:
        """(n_vertices, 3) points and the triangles that were mended."""
        positions, mended, record = np.empty((n_vertices, 3)), c_int64(), Error()
        check(self._native.orb_whole_sphere(self._pointer, doubles(positions), mended, record), record)
        return positions, mended.value

    def map_points(
        self, target: Embedding, triangles: np.ndarray | None, barycentric: np.ndarray | None, n_points: int
    ) -> tuple[np.ndarray, np.ndarray, MapReport]:
        """orb_surface_map from this mesh: points (p,), (p, 3), or None: its n_points vertices."""
        found, weights = np.empty(n_points, np.int32), np.empty((n_points, 3))
        report, record = MapReport(), Error()
        points = (0 if triangles is None else n_points, int32s(triangles), doubles(barycentric))
        mapped = self._native.orb_surface_map(
            *(self._pointer, target._pointer, *points, int32s(found), doubles(weights), report, record)
        )
        check(mapped, record)
        return found, weights, report

    def map_distortion(self, target: Embedding, n_triangles: int) -> tuple[np.ndarray, np.ndarray, MapDistortion]:
        """orb_surface_map_distortion from this mesh: two arrays (n_triangles,)."""
        ratio, log_area, measured, record = np.empty(n_triangles), np.empty(n_triangles), MapDistortion(), Error()
        done = self._native.orb_surface_map_distortion(
            *(self._pointer, target._pointer, doubles(ratio), doubles(log_area), measured, record)
        )
        check(done, record)
        return ratio, log_area, measured

    def trace(self, target: Embedding, corners: np.ndarray) -> np.ndarray:
        """orb_surface_map_trace from this mesh: Stretch records of the edges that begin with corners (k,)."""
        native, pointer, record = self._native, TRACE(), Error()
        check(native.orb_surface_map_trace(
            self._pointer, target._pointer, len(corners), int32s(corners), pointer, record
        ), record)
        try:
            stretches = np.empty(native.orb_trace_count(pointer), np.dtype(Stretch))
            native.orb_trace_read(pointer, stretches.ctypes.data)
        finally:
            native.orb_trace_free(pointer)
        return stretches


class Wallpaper:
    """An orb_wallpaper, freed with this object."""

    def __init__(self, width: int, height: int, motions: np.ndarray, uv: np.ndarray, threads: int) -> None:
        """Motions (n, 6); uv (m, 6), which may be empty."""
        native, self._pointer, record = library(), WALLPAPER(), Error()
        made = native.orb_wallpaper_create(
            width, height, len(motions), doubles(motions), len(uv), doubles(uv), threads, self._pointer, record
        )
        check(made, record)
        weakref.finalize(self, native.orb_wallpaper_free, self._pointer)
        self.view: WallpaperView = native.orb_wallpaper_look(self._pointer)

    def apply(
        self, pixels: np.ndarray, source: int, painted: np.ndarray | None, area: np.ndarray | None, threads: int
    ) -> None:
        """orb_wallpaper_apply on contiguous (h, w, channels), in place; painted (h, w) uint8, area (4,) int32."""
        mask, record = None if painted is None else painted.ctypes.data, Error()
        done = library().orb_wallpaper_apply(
            self._pointer, image_of(pixels), source, mask, int32s(area), threads, record
        )
        check(done, record)


def image_of(pixels: np.ndarray) -> Image:
    """Of a contiguous (h, w, channels), which has to live as long."""
    height, width, channels = pixels.shape
    return Image(width, height, channels, TEXELS[pixels.dtype.name], pixels.ctypes.data)


def fill_seam_margin(pixels: np.ndarray, repeats: bool, triangles: np.ndarray, uv: np.ndarray, texels: int) -> None:
    """orb_fill_seam_margin on contiguous (h, w, channels), in place; triangles (m, 3), uv (m, 3, 2)."""
    record = Error()
    filled = library().orb_fill_seam_margin(
        image_of(pixels), repeats, len(triangles), int32s(triangles), doubles(uv), texels, record
    )
    check(filled, record)


class Prepared:
    """An orb_prepared, freed with this object, or with the last job that uses it."""

    def __init__(self, vertices: np.ndarray, triangles: np.ndarray) -> None:
        native = library()
        self.pointer, record = c_void_p(), Error()
        check(native.orb_prepare(mesh_arrays(vertices, triangles), self.pointer, record), record)
        weakref.finalize(self, native.orb_prepared_free, self.pointer)


class Suggestions:
    """An orb_suggestions, freed with this object."""

    def __init__(self, pointer: c_void_p) -> None:
        self._pointer = pointer
        self._native = library()
        weakref.finalize(self, self._native.orb_suggestions_free, pointer)

    def views(self) -> list[Suggestion]:
        """Best first; pointers into the suggestions, valid only while this object is."""
        count = self._native.orb_suggestions_count(self._pointer)
        return [self._native.orb_suggestions_view(self._pointer, number) for number in range(count)]


def request_of(
    signature: str | None,
    cones: np.ndarray,
    orders: np.ndarray | None,
    holes: int,
    polygon: Polygon | None = None,
    edge_weights: np.ndarray | None = None,
    **settings: int | float,
) -> Request:
    """The library's usual request with these arrays, which the caller keeps alive, and other fields by their names."""
    request = library().orb_request_default()
    if signature is not None:
        request.signature = encode_signature(signature)
    request.n_cones, request.cones, request.orders = len(cones), int32s(cones), int32s(orders)
    request.holes = holes
    if polygon is not None:
        request.polygon = ctypes.pointer(polygon)
    if edge_weights is not None:
        request.n_edge_weights, request.edge_weights = len(edge_weights), doubles(edge_weights)
    for name, value in settings.items():
        setattr(request, name, value)
    return request


def suggest_request_of(
    signatures: Sequence[str] | None,
    flat: bool,
    fixed: np.ndarray,
    keep_away: np.ndarray | None,
    holes: int,
    symmetry: int,
    plane: Sequence[float],
) -> SuggestRequest:
    """Arrays are kept alive by the caller; `signatures` None: the usual ones."""
    names = [encode_signature(signature) for signature in signatures or ()]
    request = SuggestRequest(n_signatures=len(names), signatures=(c_char_p * len(names))(*names), flat=flat)
    request.n_fixed, request.fixed, request.keep_away = len(fixed), int32s(fixed), doubles(keep_away)
    request.holes, request.symmetry, request.plane = holes, symmetry, tuple(plane)
    return request


def mesh_arrays(vertices: np.ndarray, triangles: np.ndarray) -> MeshArrays:
    return MeshArrays(len(vertices), doubles(vertices), len(triangles), int32s(triangles))


class Job:
    """An orb_job: one of the three kinds below. One that is dropped without `finish` is cancelled, and its thread
    cleans up after itself."""

    START: str  # the library's function

    def __init__(self, mesh: MeshArrays | None, request: Request | SuggestRequest) -> None:
        """mesh: None where the request has a prepared one. The library copies the arrays before this returns."""
        native = self._native = library()
        self._pointer, record = c_void_p(), Error()
        check(getattr(native, self.START)(mesh, request, self._pointer, record), record)
        self._abandon = weakref.finalize(self, Job._cancel_and_finish, native, self._pointer)

    @staticmethod
    def _cancel_and_finish(native: ctypes.CDLL, pointer: c_void_p) -> None:
        native.orb_job_cancel(pointer)
        native.orb_job_finish(pointer, None, None)  # any kind: it was cancelled

    def poll(self) -> tuple[str, float, bool]:
        """(stage, fraction, whether it is done or cancelled)"""
        stage, fraction = ctypes.create_string_buffer(STAGE_LENGTH), c_double()
        over = self._native.orb_job_poll(self._pointer, stage, fraction)
        return stage.value.decode(errors="replace"), fraction.value, over

    def cancel(self) -> None:
        self._native.orb_job_cancel(self._pointer)

    def finish(self) -> object:
        """Waits, and gives what was computed or raises OrbifoldError; the job is gone then."""
        self._abandon.detach()
        pointer, self._pointer = self._pointer, c_void_p()  # a finished job takes no calls (NULL is harmless)
        return self._take(pointer)

    def _take(self, pointer: c_void_p) -> object:
        raise NotImplementedError


class EmbeddingJob(Job):
    START = "orb_job_start"

    def _take(self, pointer: c_void_p) -> Embedding:
        made, record = c_void_p(), Error()
        check(self._native.orb_job_finish(pointer, made, record), record)
        return Embedding(made)


class SuggestionJob(Job):
    START = "orb_job_start_suggest"

    def _take(self, pointer: c_void_p) -> Suggestions:
        made, record = c_void_p(), Error()
        check(self._native.orb_job_finish_suggest(pointer, made, record), record)
        return Suggestions(made)


class PredictionJob(Job):
    """Its result: the spread of log area, and the log scale at each vertex (n,)."""

    START = "orb_job_start_predict"

    def __init__(self, mesh: MeshArrays, request: Request) -> None:
        super().__init__(mesh, request)
        self._n_vertices = mesh.n_vertices

    def _take(self, pointer: c_void_p) -> tuple[float, np.ndarray]:
        spread, scale, record = c_double(), np.empty(self._n_vertices), Error()
        check(self._native.orb_job_finish_predict(pointer, spread, doubles(scale), record), record)
        return spread.value, scale
