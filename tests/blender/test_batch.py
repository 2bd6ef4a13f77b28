# SPDX-License-Identifier: GPL-3.0-or-later
"""Many meshes: folders, lists of jobs, the table and the exit status, a mesh that fails in the middle, and objects that
go back in the format that they came in."""

from __future__ import annotations

import json
import os
import pty
import subprocess
from pathlib import Path

import numpy as np
import pytest
from test_run import BLENDER, CHECKOUT, START, open_sphere, run, sphere_mesh, two_spheres, write_obj, write_off

pytestmark = pytest.mark.skipif(BLENDER is None, reason="no Blender: set ORBIFOLD_BLENDER")
QUICK = ("--files", "json,npz")


@pytest.fixture
def three(tmp_path: Path) -> Path:
    """A folder of three meshes; the one in the middle is open."""
    folder = tmp_path / "meshes"
    folder.mkdir()
    write_obj(folder / "a.obj", *sphere_mesh())
    write_obj(folder / "b.obj", *open_sphere())
    write_off(folder / "c.off", *sphere_mesh(12, 16))
    (folder / "notes.txt").write_text("no mesh")
    return folder


def names(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


def table(done: subprocess.CompletedProcess) -> list[str]:
    lines = [line.removeprefix("orbifold: ") for line in done.stdout.splitlines() if line.startswith("orbifold: ")]
    return lines[next(number for number, line in enumerate(lines) if line.startswith("mesh ")) :]


def complaint(done: subprocess.CompletedProcess) -> str:
    lines = done.stderr.splitlines()
    assert done.returncode == 1 and len(lines) == 1 and lines[0].startswith("orbifold error: "), done.stderr
    assert "internal fault" not in lines[0], lines[0]
    return lines[0]


def test_a_folder_with_a_failing_mesh_in_the_middle(three: Path, tmp_path: Path) -> None:
    done = run(three, "--orbifold", "442", "--output", tmp_path / "out")
    assert "1 of 3 meshes failed: b.obj (" in complaint(done)
    assert names(tmp_path / "out") == {f"{name}.{end}" for name in "ac" for end in ("blend", "json", "npz", "png")}
    rows = table(done)
    assert [row.split()[0] for row in rows[2:5]] == ["a.obj", "b.obj", "c.off"] and "failed: " in rows[3]
    report = json.loads((tmp_path / "out" / "a.json").read_text())
    cones = " ".join(str(cone["vertex"]) for cone in report["orbifold"]["cones"])
    mean = f"{report['distortion']['quasi_conformal_mean']:.3f}"
    assert rows[2].split()[1:6] == ["442", *cones.split(), "0"] and mean in rows[2].split()
    assert rows[5].startswith("2 of 3 meshes done in ")
    assert "orbifold: 2/3 b.obj: failed: " in done.stdout  # told as it goes, not at the end only


def test_several_meshes_and_status_zero(three: Path, tmp_path: Path) -> None:
    done = run(three / "c.off", "--orbifold", "333", three / "a.obj", "--output", tmp_path / "out", *QUICK)
    assert done.returncode == 0 and done.stderr == "", done.stderr
    assert names(tmp_path / "out") == {"a.json", "a.npz", "c.json", "c.npz"}
    assert [row.split()[:2] for row in table(done)[2:4]] == [["c.off", "333"], ["a.obj", "333"]]


CSV = """\
mesh, orbifold, cones, orders, weights, holes, output
meshes/a.obj, 442, 0 100 250, 2 4 4, cotan,,
meshes/b.obj, , , , , fill, filled
meshes/missing.obj,,,,,,
meshes/c.off, 632, "0,60,100", , , , other
meshes/a.obj, 442, 0 x 5, , , , bad
"""
JOBS = [
    {"mesh": "meshes/a.obj", "orbifold": 442, "cones": [0, 100, 250], "orders": [2, 4, 4], "weights": "cotan"},
    {"mesh": "meshes/b.obj", "holes": "fill", "output": "filled"},
    {"mesh": "meshes/missing.obj"},
    {"mesh": "meshes/c.off", "orbifold": "632", "cones": "0,60,100", "output": "other", "weights": None},
    {"mesh": "meshes/a.obj", "orbifold": "442", "cones": "0 x 5", "output": "bad"},
]


@pytest.mark.parametrize("kind", ["csv", "json"])
def test_lists_of_jobs(three: Path, tmp_path: Path, kind: str) -> None:
    """Paths are relative to the list; what a row does not say is as on the command line; bad rows are failures."""
    jobs = tmp_path / f"jobs.{kind}"
    jobs.write_text(CSV if kind == "csv" else json.dumps(JOBS))
    done = run("--jobs", jobs, "--weights", "delaunay", "--output", tmp_path / "out", *QUICK, cwd="/")
    said = complaint(done)
    assert "2 of 5 meshes failed: missing.obj (there is no such file); a.obj (--cones 0,x,5: expected" in said
    assert names(tmp_path / "out") == {"a.json", "a.npz"} and names(tmp_path / "other") == {"c.json", "c.npz"}
    cones = json.loads((tmp_path / "out" / "a.json").read_text())["orbifold"]["cones"]
    assert [(cone["vertex"], cone["order"]) for cone in cones] == [(0, 2), (100, 4), (250, 4)]
    cones = json.loads((tmp_path / "other" / "c.json").read_text())["orbifold"]["cones"]
    assert [(cone["vertex"], cone["order"]) for cone in cones] == [(0, 6), (60, 3), (100, 2)]
    assert json.loads((tmp_path / "filled" / "b.json").read_text())["mesh"]["boundary_loops"] == 1


@pytest.mark.parametrize(("name", "text", "cause"), [
    ("jobs.csv", "mesh,colour\na.obj,red\n", "no column colour"),
    ("jobs.csv", "orbifold\n442\n", "job 1 names no mesh"),
    ("jobs.csv", "mesh\n", "no job"),
    ("jobs.json", "{}", "no list of objects"),
    ("jobs.json", "[{", "cannot be read"),
    ("jobs.txt", "", ".csv or a .json"),
])
def test_lists_that_cannot_be_read(tmp_path: Path, name: str, text: str, cause: str) -> None:
    (tmp_path / name).write_text(text)
    assert cause in complaint(run("--jobs", tmp_path / name, "--output", tmp_path / "out"))
    assert not (tmp_path / "out").exists()


def test_an_empty_folder_and_two_meshes_of_one_name(three: Path, tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    assert "no mesh file in this folder" in complaint(run(tmp_path / "empty"))
    write_off(three / "a.off", *sphere_mesh())
    done = run(three / "a.obj", three / "a.off", "--orbifold", "442", "--output", tmp_path / "out", *QUICK)
    assert "a.off (" in complaint(done) and "a.obj writes the same files" in done.stderr
    assert names(tmp_path / "out") == {"a.json", "a.npz"}


def test_a_bar_on_a_terminal(three: Path, tmp_path: Path) -> None:
    """No lines in between there; a terminal is stdout itself or the one that ORBIFOLD_TERMINAL names."""
    words = [str(three), "--orbifold", "442", "--output", str(tmp_path / "out"), *QUICK]
    command = [*START, str(CHECKOUT / "addon" / "run.py"), "--", *words]
    for named in (False, True):
        master, slave = pty.openpty()
        environment = {**os.environ, **({"ORBIFOLD_TERMINAL": os.ttyname(slave)} if named else {})}
        done = subprocess.run(command, stdout=subprocess.PIPE if named else slave, stderr=subprocess.PIPE, text=True,
                              env=environment, timeout=300)
        os.set_blocking(master, False)
        os.close(slave)
        seen = b""
        while True:
            try:
                part = os.read(master, 65536)
            except (BlockingIOError, OSError):
                break
            if not part:
                break
            seen += part
        os.close(master)
        shown = seen.decode()
        assert done.returncode == 1 and "] 0/3  a.obj: reading" in shown and "2/3, 1 failed  c.off" in shown, shown
        assert "1/3 a.obj: 442" not in shown + (done.stdout or "")
        assert "2 of 3 meshes done" in (done.stdout if named else shown)


# --------------------------------------------------------------------------------------------------- export

FORMATS = ("obj", "ply", "glb", "fbx", "blend")
MAKE = """
import bpy, bmesh, sys
sys.path.insert(0, {inside!r})
bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
bm = bmesh.new()
bmesh.ops.create_cube(bm, size=2)
bmesh.ops.subdivide_edges(bm, edges=bm.edges[:], cuts=5, use_grid_fill=True)
for v in bm.verts:
    v.co.normalize()
    v.co.x *= 1.4 + 0.3 * v.co.y
mesh = bpy.data.meshes.new("shape")
bm.to_mesh(mesh)
obj = bpy.data.objects.new("shape", mesh)
obj.location, obj.rotation_euler = (1, 2, 3), (0.3, 0.2, 0.1)
bpy.context.scene.collection.objects.link(obj)
bpy.context.view_layer.objects.active = obj
obj.select_set(True)
obj.modifiers.new("Subdivision", "SUBSURF")
bpy.ops.wm.save_as_mainfile(filepath={folder!r} + "/blend.blend")
obj.modifiers.clear()
bpy.ops.wm.obj_export(filepath={folder!r} + "/obj.obj")
ply = bpy.ops.wm.ply_export if "ply_export" in dir(bpy.ops.wm) else bpy.ops.export_mesh.ply
ply(filepath={folder!r} + "/ply.ply")
stl = bpy.ops.wm.stl_export if "stl_export" in dir(bpy.ops.wm) else bpy.ops.export_mesh.stl
stl(filepath={folder!r} + "/stl.stl")
bpy.ops.export_scene.gltf(filepath={folder!r} + "/glb.glb")
bpy.ops.export_scene.fbx(filepath={folder!r} + "/fbx.fbx")
"""


def test_objects_go_back_with_their_texture_coordinates(tmp_path: Path) -> None:
    """Corners and texture coordinates of the file that comes out are those of NAME.blend; .stl and .off are refused
    before any work."""
    folder, out = tmp_path / "meshes", tmp_path / "out"
    folder.mkdir()
    write_off(folder / "off.off", *sphere_mesh())
    script = tmp_path / "make.py"
    script.write_text(MAKE.format(inside=str(Path(__file__).parent / "inside"), folder=str(folder)))
    made = subprocess.run([*START, str(script)], capture_output=True, text=True, timeout=300)
    assert made.returncode == 0, made.stdout + made.stderr
    done = run(folder, "--orbifold", "442", "--output", out, "--files", "blend", "--export")
    said = complaint(done)
    assert "2 of 7 meshes failed: off.off (.off holds no texture coordinates; leave out --export" in said
    assert "stl.stl (.stl holds no texture" in said
    assert names(out) == {f"{name}.blend" for name in FORMATS} | {f"{name}.{name}" for name in FORMATS}
    files = [out / f"{name}.{ending}" for name in FORMATS for ending in ("blend", name)]
    script = str(Path(__file__).with_name("corners.py"))
    read = subprocess.run([*START, script, "--", str(tmp_path / "seen.npz"), str(CHECKOUT / "addon"), *map(str, files)],
                          capture_output=True, text=True, timeout=300)
    assert read.returncode == 0, read.stdout + read.stderr
    seen = np.load(tmp_path / "seen.npz")
    for name in FORMATS:
        ours, back = seen[f"{name}.blend"], seen[f"{name}.{name}"]
        if len(ours) != len(back):  # .glb has triangles only
            ours, back = np.unique(ours.round(4), axis=0), np.unique(back.round(4), axis=0)
        gap = np.abs(ours[:, None] - back[None]).max(2)
        assert gap.min(1).max() < 2e-4 and gap.min(0).max() < 2e-4, (name, gap.min(1).max(), gap.min(0).max())
        assert np.ptp(ours[:, 3:], axis=0).min() > 0.4, name


def test_export_of_one_mesh_never_writes_over_it(tmp_path: Path) -> None:
    mesh = write_obj(tmp_path / "a.obj", *sphere_mesh())
    text = mesh.read_text()
    assert "would write over it" in complaint(run(mesh, "--export", "--output", tmp_path))
    assert mesh.read_text() == text and names(tmp_path) == {"a.obj"}
    assert "name a mesh" in complaint(run("--export", "--output", tmp_path / "out"))
    done = run(mesh, "--orbifold", "442", "--export", "--output", tmp_path / "out", "--files", "json")
    assert done.returncode == 0 and names(tmp_path / "out") == {"a.json", "a.obj"}
    assert f"wrote {tmp_path / 'out' / 'a.json'}, {tmp_path / 'out' / 'a.obj'} in" in done.stdout


def test_components_in_a_batch_are_failures_too(tmp_path: Path) -> None:
    one, other = write_obj(tmp_path / "a.obj", *two_spheres()), write_obj(tmp_path / "b.obj", *two_spheres())
    assert "2 of 2 meshes failed" in complaint(run(one, other, "--output", tmp_path / "out"))
    assert not (tmp_path / "out").exists()
