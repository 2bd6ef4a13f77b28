# SPDX-License-Identifier: GPL-3.0-or-later
"""`run --map-to` in real Blender: four files, what comes over, landmarks that a .blend keeps, batches, failures."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from test_batch import complaint, names, table
from test_run import BLENDER, check_failure, open_sphere, run, sphere_mesh, write_obj, write_off

pytestmark = pytest.mark.skipif(BLENDER is None, reason="no Blender: set ORBIFOLD_BLENDER")
LANDMARKS = [0, 100, 250, 361]


@pytest.fixture
def pair(tmp_path: Path) -> tuple[Path, Path, np.ndarray]:
    """A pear with a UV map; one twice as large, its vertices in another sequence; the place of each vertex in that."""
    vertices, triangles = sphere_mesh()
    place = np.random.default_rng(5).permutation(len(vertices))
    moved = np.empty_like(vertices)
    moved[place] = 2 * vertices
    pear = write_obj(tmp_path / "pear.obj", vertices, triangles)
    lines = pear.read_text().splitlines()
    faces = [line.split()[1:] for line in lines if line.startswith("f ")]
    lines = [line for line in lines if line.startswith("v ")] + [f"vt {x / 4} {z / 4}" for x, _, z in vertices.tolist()]
    pear.write_text("\n".join(lines + ["f " + " ".join(f"{v}/{v}" for v in face) for face in faces]) + "\n")
    return pear, write_off(tmp_path / "large.off", moved, place[triangles]), place


def words_of(pear: Path, large: Path, place: np.ndarray) -> list[object]:
    there = ",".join(map(str, place[LANDMARKS].tolist()))
    return [pear, "--cones", ",".join(map(str, LANDMARKS)), "--map-to", large, "--map-cones", there]


def mapped(arrays: dict[str, np.ndarray], source: str, target: str) -> np.ndarray:
    """(n, 3) where the map of NAME.npz takes the vertices of one mesh."""
    weights = arrays[f"{source}_to_{target}_barycentric"]
    corners = arrays[f"{target}_triangles"][arrays[f"{source}_to_{target}_triangles"]]
    assert weights.dtype == np.float64 and weights.min() > -1e-9 and np.allclose(weights.sum(1), 1)
    return np.einsum("nc,nci->ni", weights, arrays[f"{target}_vertices"][corners])


def test_four_files_and_landmarks_that_are_kept(pair: tuple, tmp_path: Path) -> None:
    pear, large, place = pair
    done = run(*words_of(*pair), "--transfer", "uv_maps,form", "--output", tmp_path / "out")
    assert done.returncode == 0 and done.stderr == "", done.stderr
    assert "pear.obj to large.off: 362 and 362 vertices by 2222, 4 landmarks" in done.stdout
    assert names(tmp_path / "out") == {f"large.{ending}" for ending in ("blend", "json", "npz", "png")}
    report = json.loads((tmp_path / "out" / "large.json").read_text())
    assert report["meshes"] == {"source": "pear.obj", "target": "large.off"} and report["signature"] == "2222"
    assert report["landmarks"] == {"source": LANDMARKS, "target": place[LANDMARKS].tolist()}
    (target,) = report["targets"]
    assert target["bijective"] and target["flipped"] == 0
    assert {kind: len(written) for kind, written in target["written"].items()} == {"UV maps": 1, "shape keys": 1}
    with np.load(tmp_path / "out" / "large.npz") as file:
        arrays = dict(file)
    images = {"source": mapped(arrays, "source", "target"), "target": mapped(arrays, "target", "source")}
    vertices = arrays["source_vertices"]
    for name, own, other in (("source", LANDMARKS, place[LANDMARKS]), ("target", place[LANDMARKS], LANDMARKS)):
        there = arrays["target_vertices" if name == "source" else "source_vertices"]
        assert np.abs(images[name][own] - there[other]).max() < 1e-9
    assert np.abs(images["target"][place] - vertices).max() < 1e-5
    assert np.abs(images["source"] - 2 * vertices).max() < 1e-5
    assert str(arrays["geometry"]) == "euclidean" and arrays["target_landmarks"].tolist() == place[LANDMARKS].tolist()
    # the other way, by the cones that the .blend keeps; the object goes out in its own format
    bare = write_obj(tmp_path / "bare.obj", *sphere_mesh())
    back = ["--object", target["object"], "--map-to", bare, "--map-cones", "0,100,250,361"]
    done = run(tmp_path / "out" / "large.blend", *back, "--files", "npz", "--export", "--output", tmp_path / "back")
    assert done.returncode == 0, done.stderr
    assert names(tmp_path / "back") == {"bare.npz", "bare.obj"}
    with np.load(tmp_path / "back" / "bare.npz") as file:
        assert file["source_landmarks"].tolist() == place[LANDMARKS].tolist()
        assert np.abs(mapped(dict(file), "target", "source") - 2 * vertices).max() < 1e-5
    lines = [line.split() for line in (tmp_path / "back" / "bare.obj").read_text().splitlines()]
    uv = np.array([line[1:] for line in lines if line[:1] == ["vt"]], float)
    corners = np.array([corner.split("/")[:2] for line in lines if line[:1] == ["f"] for corner in line[1:]], int) - 1
    assert np.abs(uv[corners[:, 1]] - vertices[corners[:, 0]][:, [0, 2]] / 4).max() < 1e-4


def test_a_batch_with_a_failure_in_the_middle(pair: tuple, tmp_path: Path) -> None:
    pear, large, place = pair
    write_off(tmp_path / "open.off", *open_sphere())
    write_off(tmp_path / "same.off", *sphere_mesh())
    (tmp_path / "jobs.csv").write_text(
        "mesh, cones, map-to, map-cones, transfer\n"
        f"pear.obj, 0 100 250 361, large.off, {' '.join(map(str, place[LANDMARKS]))}, uv_maps\n"
        "pear.obj, 0 100 250 361, open.off, 10 20 40 60, uv_maps\n"
        "pear.obj, 0 100 250 361, same.off, 0 100 250 361, uv_maps heat\n"
    )
    done = run("--jobs", tmp_path / "jobs.csv", "--files", "json,npz", "--output", tmp_path / "out")
    assert "1 of 3 meshes failed: pear.obj to open.off (open: the mesh is open" in complaint(done)
    assert names(tmp_path / "out") == {f"{name}.{end}" for name in ("large", "same") for end in ("json", "npz")}
    row = next(row for row in table(done) if row.startswith("pear.obj to same.off"))
    assert row.split()[3:10] == ["2222", "0", "100", "250", "361", "0", "1.000"]
    written = json.loads((tmp_path / "out" / "same.json").read_text())["targets"][0]["written"]
    assert set(written) == {"UV maps", "heat maps"}
    with np.load(tmp_path / "out" / "same.npz") as file:  # the source's embedding is that of the first job
        assert np.abs(mapped(dict(file), "target", "source") - file["target_vertices"]).max() < 1e-6


@pytest.mark.parametrize(("words", "cause"), [
    (["--map-to", "large.off"], "pear has no landmarks: name vertices with --cones"),
    (["--cones", "0,9,99", "--map-to", "large.off"], "large has no landmarks: name vertices with --map-cones"),
    (["--cones", "0,9,99", "--map-to", "large.off", "--map-cones", "0,9"], "pear has 3 landmarks and large has 2"),
    (["--cones", "0,9,99", "--map-to", "large.off", "--map-cones", "0,9,999"], "no vertex 999"),
    (["--cones", "0,9,99", "--map-to", "large.off", "--transfer", "heat,smell"], "--transfer smell"),
    (["--cones", "0,9,99", "--map-to", "pear.obj", "--map-cones", "0,9,99"], "it has the name of the mesh"),
    (["--cones", "0,9,99", "--map-to", "large.off", "--map-cones", "0,9,99", "--export"], "no texture coordinates"),
])
def test_failure_is_one_line_and_no_file(pair: tuple, tmp_path: Path, words: list[str], cause: str) -> None:
    check_failure(run(pair[0], *words, "--output", tmp_path / "new", cwd=tmp_path), cause)
    assert not (tmp_path / "new").exists()
