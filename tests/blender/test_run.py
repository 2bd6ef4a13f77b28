# SPDX-License-Identifier: GPL-3.0-or-later
"""The headless command in real Blender: its four files, and what it says when it fails.

ORBIFOLD_BLENDER is the Blender to test (default: the one in PATH). Meshes are made here; those of ../shared/meshes are
used where that folder is there."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from inside import grids

CHECKOUT = Path(__file__).resolve().parents[2]
SHARED = CHECKOUT.parent / "shared"
CHECK_LAYOUT = SHARED / "tools" / "check_layout.py"
SPOT = SHARED / "meshes" / "spot.obj"
BLENDER = os.environ.get("ORBIFOLD_BLENDER") or shutil.which("blender")
ENDINGS = {".blend", ".json", ".npz", ".png"}
NO_PICTURE = ["--files", "blend,json,npz"]  # it takes most of the time: some of each kind have one
sys.path.insert(0, str(CHECKOUT / "addon"))
import core  # noqa: E402

START = [BLENDER, "--background", "--factory-startup", "--python-exit-code", "1", "--python"]

pytestmark = pytest.mark.skipif(BLENDER is None, reason="no Blender: set ORBIFOLD_BLENDER")


# ---------------------------------------------------------------------------------------------------- helpers


def run(*words: object, cwd: Path | None = None) -> subprocess.CompletedProcess:
    command = [*START, str(CHECKOUT / "addon" / "run.py"), "--", *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, timeout=300, cwd=cwd)


def in_blender(script: str, *words: object) -> dict:
    """Runs a script of this folder; it writes JSON into the file that is its first argument."""
    answer = Path(str(words[0]))
    command = [*START, str(Path(__file__).with_name(script)), "--", *map(str, words)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr
    return json.loads(answer.read_text())


def sphere_mesh(rings: int = 16, around: int = 24) -> tuple[np.ndarray, np.ndarray]:
    """A closed, slightly pear-shaped sphere: two poles and rings of vertices."""
    polar = np.pi * np.arange(1, rings) / rings
    angle = 2 * np.pi * np.arange(around) / around
    width = np.sin(polar)[:, None] * (1 + 0.3 * np.cos(polar))[:, None]
    ring = np.stack([width * np.cos(angle), width * np.sin(angle), np.broadcast_to(np.cos(polar)[:, None],
                                                                                   (rings - 1, around))], -1)
    vertices = np.concatenate([ring.reshape(-1, 3), [[0, 0, 1], [0, 0, -1]]])
    top, bottom = len(vertices) - 2, len(vertices) - 1
    k = np.arange(around)
    after = (k + 1) % around
    triangles = [np.stack([np.full(around, top), k, after], 1)]
    for row in range(rings - 2):
        a, b = row * around + k, row * around + after
        c, d = a + around, b + around
        triangles += [np.stack([a, c, b], 1), np.stack([b, c, d], 1)]
    last = (rings - 2) * around
    triangles.append(np.stack([np.full(around, bottom), last + after, last + k], 1))
    return vertices, np.concatenate(triangles)


def write_obj(path: Path, vertices: np.ndarray, triangles: np.ndarray) -> Path:
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (triangles + 1).tolist()]
    path.write_text("\n".join(lines) + "\n")
    return path


def write_off(path: Path, vertices: np.ndarray, triangles: np.ndarray) -> Path:
    lines = ["OFF", f"{len(vertices)} {len(triangles)} 0"]
    lines += [f"{x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()]
    lines += [f"3 {a} {b} {c}" for a, b, c in triangles.tolist()]
    path.write_text("\n".join(lines) + "\n")
    return path


@pytest.fixture
def pear(tmp_path: Path) -> Path:
    return write_obj(tmp_path / "pear.obj", *sphere_mesh())


def check_files(folder: Path, name: str, signature: str, cones: list[int], suggested: bool = False) -> dict:
    """All that is promised of the four files, or of those without a picture; the report."""
    picture = (folder / f"{name}.png").is_file()
    endings = ENDINGS if picture else ENDINGS - {".png"}
    assert {path.name for path in folder.iterdir()} == {name + ending for ending in endings}
    report = json.loads((folder / f"{name}.json").read_text())
    keys = {
        "mesh": "vertices triangles components euler boundary_loops genus orientable",
        "orbifold": "signature geometry euler cones moduli modulus",
        "solver": "iterations energy relative_gradient clamped_weights factor_nonzeros",
        "certificate": "flipped flipped_float32 seam_residual angle_residual area_residual bijective",
        "distortion": "quasi_conformal_mean quasi_conformal_median quasi_conformal_max log_area_std "
        "symmetric_dirichlet",
        "seconds": "topology cut tile initial assemble analyze factor solve certify total",
    }
    if suggested:
        keys["suggested"] = "predicted measured symmetric"
    assert {group: set(report[group]) for group in report} == {group: set(of.split()) for group, of in keys.items()}
    assert report["orbifold"]["signature"] == signature
    assert [cone["vertex"] for cone in report["orbifold"]["cones"]] == cones
    assert report["certificate"]["bijective"] is True and report["certificate"]["flipped"] == 0
    if CHECK_LAYOUT.is_file():
        judged = subprocess.run([sys.executable, CHECK_LAYOUT, folder / f"{name}.npz"], capture_output=True, text=True)
        assert judged.returncode == 0, judged.stdout
    seen = in_blender("look_into.py", folder.parent / f"{name}-seen.json", folder / f"{name}.blend",
                      folder / f"{name}.png" if picture else "-")
    layout = np.load(folder / f"{name}.npz")
    refined = "refined_from" in layout
    assert seen["objects"] == 1 and (refined or seen["vertices"] == len(layout["vertices"]))
    assert seen["vertices"] == report["mesh"]["vertices"]
    assert "Orbifold" in seen["uv_maps"] and seen["active_uv"] == "Orbifold"
    mirrored = "*" in signature
    assert mirrored or seen["uv_triangles_without_area"] == 0
    assert seen["seams"] >= (1 if "*" not in signature[:1] else 0)
    assert mirrored or seen["seams"] >= len(cones) - 1
    has_key = report["orbifold"]["geometry"] == "spherical" and not {"*", "x"} & set(signature[1:])
    assert ("Orbifold Sphere" in seen["shape_keys"]) == has_key
    assert not any(seen["shape_key_values"]), "the object is not shown as it is"
    assert seen["materials"] == 1 and seen["material_reads_uv"] and seen["images_without_data"] == []
    # the two sides of a seam show the same colours, up to what the texture resolves
    assert seen["seam_colour_gap"] < 0.2 * seen["seam_colour_spread"], "the pattern breaks at the seams"
    if picture:
        assert seen["png_size"] == [960, 540]
        assert min(seen["png_spread"]) > 0.03, "a half of the picture is blank"
    return report


# ---------------------------------------------------------------------------------------------- what succeeds


@pytest.mark.parametrize(("signature", "cones"), [("442", [0, 100, 250]), ("432", [0, 100, 250]),
                                                  ("237", [0, 100, 250]), ("2222", [0, 100, 250, 361]),
                                                  ("22222", [0, 60, 100, 250, 361]), ("33", [0, 250])])
def test_four_files(pear: Path, tmp_path: Path, signature: str, cones: list[int]) -> None:
    words = [pear, "--orbifold", signature, "--cones", ",".join(map(str, cones)), "--output", tmp_path / "out"]
    done = run(*words)
    assert done.returncode == 0, done.stderr
    assert "orbifold error" not in done.stderr
    assert "orbifold: certified" in done.stdout
    check_files(tmp_path / "out", "pear", signature, cones)


def test_off_orders_and_defaults(tmp_path: Path) -> None:
    """.off; orders in another sequence than the signature's; out/ by default; suggested cones, twice the same."""
    mesh = write_off(tmp_path / "pear.off", *sphere_mesh())
    done = run(mesh, "--orders", "2,4,4", "--blender", "ignored", "--files", "json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    report = json.loads((tmp_path / "out" / "pear.json").read_text())
    cones = report["orbifold"]["cones"]
    assert [cone["order"] for cone in cones] == [2, 4, 4] and report["orbifold"]["signature"] == "442"
    words = ["--orders", "2,4,4", "--cones", "auto", "--weights", "mean-value", "--files", "json"]
    again = run(mesh, *words, cwd=tmp_path)
    assert again.returncode == 0, again.stderr
    assert json.loads((tmp_path / "out" / "pear.json").read_text())["orbifold"]["cones"] == cones


def test_the_best_suggestion_is_used(pear: Path, tmp_path: Path) -> None:
    """No signature and no cones: the first of what core suggests; with a signature the cones for that one."""
    for words, orbifold in (([], None), (["--cones", "auto", "--orbifold", "632"], "632")):
        out = tmp_path / f"out {orbifold}"
        done = run(pear, *words, "--output", out, *NO_PICTURE)
        assert done.returncode == 0, done.stderr
        layout = np.load(out / "pear.npz")  # Blender keeps 32 bits of each coordinate
        best = core.suggest_cones(layout["vertices"], layout["triangles"], orbifold)[0]
        report = check_files(out, "pear", best.signature, list(best.cones), suggested=True)
        assert report["suggested"]["predicted"] == pytest.approx(best.predicted, rel=1e-3)
        assert report["suggested"]["measured"] == best.measured
        spread = "measured spread of areas and angles" if best.measured else "predicted area spread"
        assert f"the cones were suggested: {spread} {best.predicted:.2f}" in done.stdout


def test_cones_without_a_signature_are_those_of_442(pear: Path, tmp_path: Path) -> None:
    done = run(pear, "--cones", "0,100,250", "--output", tmp_path / "out", *NO_PICTURE)
    assert done.returncode == 0 and "suggested" not in done.stdout
    check_files(tmp_path / "out", "pear", "442", [0, 100, 250])


def test_certified_uvs_are_kept_where_the_whole_sphere_is_too_coarse(tmp_path: Path) -> None:
    """An icosahedron has too few triangles round a cone of order 100 to cover the sphere once."""
    g = (1 + np.sqrt(5)) / 2
    vertices = np.array([(0, s, t * g) for s in (-1, 1) for t in (-1, 1)])
    vertices = np.concatenate([vertices, vertices[:, [2, 0, 1]], vertices[:, [1, 2, 0]]])
    near = np.linalg.norm(vertices[:, None] - vertices[None], axis=2) < 2.1
    triples = [(i, j, k) for i in range(12) for j in range(i) for k in range(j)]
    triangles = [(i, j, k) for i, j, k in triples if near[i, j] and near[j, k] and near[k, i]]
    outwards = np.array([t if np.linalg.det(vertices[list(t)]) > 0 else t[::-1] for t in triangles])
    poles = [0, int(np.argmin(vertices @ vertices[0]))]
    mesh = write_off(tmp_path / "ico.off", vertices, outwards)
    done = run(mesh, "--orbifold", "(100)(100)", "--cones", ",".join(map(str, poles)), "--weights", "cotan",
               "--output", tmp_path / "out", *NO_PICTURE)
    assert done.returncode == 0, done.stderr
    assert "no shape key" in done.stdout
    assert {path.suffix for path in (tmp_path / "out").iterdir()} == ENDINGS - {".png"}


def test_creature(tmp_path: Path) -> None:
    done = run("--output", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    report = json.loads((tmp_path / "out" / "creature.json").read_text())
    cones = [cone["vertex"] for cone in report["orbifold"]["cones"]]
    check_files(tmp_path / "out", "creature", report["orbifold"]["signature"], cones, suggested=True)
    assert 15_000 < report["mesh"]["vertices"] < 25_000
    assert report["mesh"]["components"] == 1 and report["mesh"]["genus"] == 0


ROWS = [(grids.disk, "4*2", 2), (grids.disk, "*432", 3), (grids.disk, "*237", 3), (grids.annulus, "**", 0),
        (grids.mobius, "*x", 0), (grids.klein, "xx", 0), (grids.torus, "o2", 1)]


@pytest.mark.parametrize(("make", "signature", "n_cones"), ROWS, ids=[row[1] for row in ROWS])
def test_other_surfaces(tmp_path: Path, make, signature: str, n_cones: int) -> None:
    """Mirrors, handles and cross-caps, cones and corners suggested."""
    mesh = write_off(tmp_path / "mesh.off", *make())
    files = [] if signature in ("4*2", "*x", "o2") else NO_PICTURE
    done = run(mesh, "--orbifold", signature, "--output", tmp_path / "out", *files)
    assert done.returncode == 0, done.stderr
    cones = [cone["vertex"] for cone in json.loads((tmp_path / "out" / "mesh.json").read_text())["orbifold"]["cones"]]
    assert len(cones) == n_cones
    report = check_files(tmp_path / "out", "mesh", signature, cones, suggested=n_cones > 0)
    assert [cone["mirror"] for cone in report["orbifold"]["cones"]] == [
        number >= interior_orders(signature) for number in range(n_cones)
    ]
    assert report["mesh"]["orientable"] == ("x" not in signature)


def interior_orders(signature: str) -> int:
    return sum(character.isdigit() for character in signature.partition("*")[0])


@pytest.mark.parametrize(("holes", "signature"), [("fill", "442"), ("mirror", "442**")])
def test_holes(tmp_path: Path, holes: str, signature: str) -> None:
    vertices, triangles = sphere_mesh()
    cap = (triangles == len(vertices) - 2).any(1)
    mesh = write_off(tmp_path / "mesh.off", vertices, triangles[~cap][:-1])
    words = [mesh, "--cones", "100,150,250", "--output", tmp_path / "out"]
    check_failure(run(*words), "hole|border|boundary|open")
    done = run(*words, "--holes", holes, "--weights", "delaunay", *NO_PICTURE)
    assert done.returncode == 0, done.stderr
    assert ("2 holes were filled" in done.stdout) == (holes == "fill")
    report = check_files(tmp_path / "out", "mesh", signature, [100, 150, 250])
    assert report["mesh"]["boundary_loops"] == 2


@pytest.mark.skipif(not SPOT.is_file(), reason="../shared/meshes/spot.obj is not there")
@pytest.mark.parametrize(("signature", "cones"), [("432", [100, 1000, 2000]), ("442", [100, 1000, 2000]),
                                                  ("237", [100, 1000, 2000]), ("2222", [100, 1000, 2000, 500])])
def test_spot(tmp_path: Path, signature: str, cones: list[int]) -> None:
    words = ["--orbifold", signature, "--cones", ",".join(map(str, cones)), "--output", tmp_path / "out"]
    done = run(SPOT, *words, *NO_PICTURE)
    assert done.returncode == 0, done.stderr
    check_files(tmp_path / "out", "spot", signature, cones)
    in_file = [line.split()[1:4] for line in SPOT.read_text().splitlines() if line.startswith("v ")]
    vertices = np.load(tmp_path / "out" / "spot.npz")["vertices"]
    assert np.allclose(vertices, np.array(in_file, float), atol=1e-6), "vertices are not in the file's sequence"


def test_help() -> None:
    done = run("--help")
    assert done.returncode == 0 and "--orbifold" in done.stdout and done.stderr == ""


# ------------------------------------------------------------------------------------------------- what fails


def two_spheres() -> tuple[np.ndarray, np.ndarray]:
    vertices, triangles = sphere_mesh(8, 12)
    return np.concatenate([vertices, vertices + 5]), np.concatenate([triangles, triangles + len(vertices)])


def open_sphere() -> tuple[np.ndarray, np.ndarray]:
    vertices, triangles = sphere_mesh(8, 12)
    return vertices, triangles[1:]


FAILURES = {
    "signature": (sphere_mesh, ["--orbifold", "4z2"], "signature"),
    "no such orbifold": (sphere_mesh, ["--orbifold", "23", "--cones", "0,5"], "23"),
    "boundary": (open_sphere, ["--cones", "30,40,50"], "the mesh is open"),
    "components": (two_spheres, ["--cones", "30,40,50"], "component|piece|part"),
    "cone out of range": (sphere_mesh, ["--cones", "1,2,99999"], "99999"),
    "cone twice": (sphere_mesh, ["--cones", "1,2,2"], r"\b2\b"),
    "number of cones": (sphere_mesh, ["--cones", "1,2"], "cones"),
    "cones not numbers": (sphere_mesh, ["--cones", "1,2,x"], "--cones 1,2,x"),
    "orders": (sphere_mesh, ["--cones", "1,2,3", "--orders", "5,5,5"], "order"),
    "orders of suggested cones": (sphere_mesh, ["--orders", "6,3,2"], "4,4,2 in any sequence"),
    "no cones and open": (open_sphere, ["--orbifold", "442"], "open|hole|boundary"),
    "unknown option": (sphere_mesh, ["--colour", "blue"], "--colour"),
    "unknown weights": (sphere_mesh, ["--weights", "lead"], "lead"),
}


@pytest.mark.parametrize("case", FAILURES)
def test_failure_is_one_line_and_no_file(tmp_path: Path, case: str) -> None:
    make, words, cause = FAILURES[case]
    mesh = write_obj(tmp_path / "mesh.obj", *make())
    done = run(mesh, "--output", tmp_path / "new" / "out", *words)
    check_failure(done, cause)
    assert not (tmp_path / "new").exists()


def test_missing_and_broken_files(tmp_path: Path) -> None:
    """Nothing of what was in the output folder before is touched."""
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "mesh.json").write_text("old")
    (tmp_path / "mesh.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n")
    (tmp_path / "mesh.txt").write_text("")
    for name, cause in (("nothing.obj", "no such file"), ("mesh.off", r"mesh\.off:6"), ("mesh.txt", "ending")):
        check_failure(run(tmp_path / name, "--output", tmp_path / "out"), cause)
        assert [path.name for path in (tmp_path / "out").iterdir()] == ["mesh.json"]
        assert (tmp_path / "out" / "mesh.json").read_text() == "old"


def check_failure(done: subprocess.CompletedProcess, cause: str) -> None:
    assert done.returncode == 1, done.stdout + done.stderr
    lines = done.stderr.splitlines()
    assert len(lines) == 1, done.stderr
    assert lines[0].startswith("orbifold error: ") and re.search(cause, lines[0]), lines[0]
    assert "internal fault" not in lines[0]


# ---------------------------------------------------------------------------------------------- mesh files


def test_vertex_numbers_are_the_file_s(tmp_path: Path) -> None:
    """Every kind of file: numbers, unused vertices, several objects."""
    seen = in_blender("import_files.py", tmp_path / "seen.json", CHECKOUT / "addon", tmp_path)
    assert seen == {case: "as in the file" for case in seen} and len(seen) >= 11
