# SPDX-License-Identifier: GPL-3.0-or-later
"""binding.py says what the headers say: a C compiler and the linker are asked."""

import re
import shutil
import subprocess

import pytest
from conftest import CHECKOUT

import core
from core import binding

HEADER = CHECKOUT / "native" / "include" / "orbifold.h"
OTHERS = [HEADER.with_name(f"orbifold_{name}.h") for name in ("cones", "maps", "images")]  # these include it
HEADERS = "".join(
    re.sub(r"/\*.*?\*/", "", path.read_text(), flags=re.DOTALL) for path in (HEADER, *OTHERS)
)  # without comments
STRUCTURES = {
    "orb_error": binding.Error,
    "orb_mesh_arrays": binding.MeshArrays,
    "orb_request": binding.Request,
    "orb_signature_info": binding.SignatureInfo,
    "orb_view": binding.View,
    "orb_report": binding.Report,
    "orb_polygon": binding.Polygon,
    "orb_suggest_request": binding.SuggestRequest,
    "orb_suggestion": binding.Suggestion,
    "orb_map_report": binding.MapReport,
    "orb_map_distortion": binding.MapDistortion,
    "orb_stretch": binding.Stretch,
    "orb_image": binding.Image,
    "orb_wallpaper_view": binding.WallpaperView,
}
CONSTANTS = {
    "ORB_OK": binding.OK,
    "ORB_MAX_ELEMENTS": binding.MAX_ELEMENTS,
    "ORB_NOTHING": binding.ELEMENTS.index(None),
    "ORB_VERTEX": binding.ELEMENTS.index("vertex"),
    "ORB_EDGE": binding.ELEMENTS.index("edge"),
    "ORB_TRIANGLE": binding.ELEMENTS.index("triangle"),
    "ORB_CHARACTER": binding.ELEMENTS.index("character"),
    "ORB_WEIGHTS_COTANGENT": binding.WEIGHTS["cotan"],
    "ORB_WEIGHTS_MEAN_VALUE": binding.WEIGHTS["mean-value"],
    "ORB_WEIGHTS_UNIFORM": binding.WEIGHTS["uniform"],
    "ORB_WEIGHTS_GIVEN": binding.WEIGHTS_GIVEN,
    "ORB_SYMMETRY_PLANE": binding.SYMMETRY_PLANE,
    **{f"ORB_SYMMETRY_{name.upper()}": number for name, number in binding.SYMMETRIES.items()},
    **{f"ORB_CUT_{name.upper()}": number for name, number in binding.CUTS.items()},
    **{f"ORB_HOLES_{name.upper()}": number for name, number in binding.HOLES.items()},
    "ORB_TEXEL_UINT8": binding.TEXELS["uint8"],
    "ORB_TEXEL_UINT16": binding.TEXELS["uint16"],
    "ORB_TEXEL_FLOAT": binding.TEXELS["float32"],
    **{f"ORB_FROM_{name.upper()}": number for name, number in binding.SOURCES.items()},
    **{f"ORB_CHART_{name.upper()}": number for name, number in binding.CHARTS.items()},
}


def ask_compiler(folder, expressions):
    """The values of integer expressions, as C computes them."""
    compiler = shutil.which("gcc") or shutil.which("clang") or shutil.which("cc")
    if not compiler:
        pytest.skip("no C compiler")
    lines = "\n".join(f'printf("%ld\\n", (long)({expression}));' for expression in expressions)
    source = folder / "ask.c"
    headers = "".join(f'#include "{path}"\n' for path in OTHERS)
    source.write_text(
        f"#include <stddef.h>\n#include <stdio.h>\n{headers}"
        f"int main(void) {{\n{lines}\nreturn 0; }}\n"
    )
    subprocess.run([compiler, "-std=c11", "-o", folder / "ask", source], check=True)
    return [int(line) for line in subprocess.check_output([folder / "ask"], text=True).split()]


def test_structures_have_the_headers_layout(tmp_path):
    ours, expressions = [], []
    for name, structure in STRUCTURES.items():
        expressions.append(f"sizeof({name})")
        ours.append((name, binding.ctypes.sizeof(structure)))
        for field, *_ in structure._fields_:
            member = getattr(structure, field)
            expressions += [f"offsetof({name}, {field})", f"sizeof((({name} *)0)->{field})"]
            ours += [(f"{name}.{field} at", member.offset), (f"{name}.{field} size", member.size)]
    theirs = ask_compiler(tmp_path, expressions)
    assert ours == [(what, value) for (what, _), value in zip(ours, theirs)]


def test_structures_have_every_field_of_the_headers():
    for name, structure in STRUCTURES.items():
        body = re.search(rf"typedef struct {name} {{(.*?)}} {name};", HEADERS, re.DOTALL).group(1)
        fields = [
            re.search(r"(\w+)\s*(\[\w+\])?$", part.strip()).group(1)
            for line in body.split(";")
            if line.strip()
            for part in line.split(",")
        ]
        assert [field for field, *_ in structure._fields_] == fields, name


def test_constants_are_the_headers(tmp_path):
    theirs = ask_compiler(tmp_path, CONSTANTS)
    assert dict(zip(CONSTANTS, theirs)) == CONSTANTS
    for prefix in ("ORB_CHART_", "ORB_HOLES_", "ORB_SYMMETRY_", "ORB_FROM_", "ORB_TEXEL_"):
        theirs = set(re.findall(rf"\b{prefix}\w+", HEADERS))
        assert theirs == {name for name in CONSTANTS if name.startswith(prefix)}


def test_every_function_of_the_headers_is_declared_with_its_arguments():
    declared = {
        name: 0 if arguments.strip() == "void" else arguments.count(",") + 1
        for name, arguments in re.findall(r"ORB_API [^;(]*?\b(orb_\w+)\(([^)]*)\);", HEADERS)
    }
    assert declared == {name: len(arguments) for name, (_, arguments) in binding.PROTOTYPES.items()}


def test_library_exports_these_functions_and_nothing_else():
    if not shutil.which("nm"):
        pytest.skip("no nm")
    core.library()
    listing = subprocess.check_output(["nm", "-D", "--defined-only", binding.LIBRARY], text=True)
    assert {line.split()[-1] for line in listing.splitlines()} == set(binding.PROTOTYPES)


def test_every_status_has_its_name():
    body = re.search(r"enum orb_status {(.*?)}", HEADER.read_text(), re.DOTALL).group(1)
    names = re.findall(r"^\s+(ORB_\w+)", body, re.MULTILINE)
    assert [core.library().orb_status_name(k).decode() for k in range(len(names))] == names


def test_missing_library_is_said(monkeypatch, tmp_path):
    binding.library.cache_clear()
    monkeypatch.setattr(binding, "LIBRARY", tmp_path / "liborbifold.so")
    try:
        with pytest.raises(core.OrbifoldError, match="build.sh native") as caught:
            core.geometry_of("(97)(97)")
        assert caught.value.status == "ORB_NO_LIBRARY"
        (tmp_path / "liborbifold.so").write_text("no library at all")
        with pytest.raises(core.OrbifoldError, match="cannot be loaded") as caught:
            core.library()
        assert caught.value.status == "ORB_NO_LIBRARY"
    finally:
        binding.library.cache_clear()
