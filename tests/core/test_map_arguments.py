# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line of `./build.sh run --map-to` (addon/headless/arguments.py), and lists of such jobs."""

import json
from pathlib import Path

import pytest
import surfaces

arguments, joblist = surfaces.bare("headless.arguments"), surfaces.bare("headless.joblist")
RunError = surfaces.bare("headless.errors").RunError
read_request = arguments.read_request


def jobs(words):
    return [
        (job.title, job.map_cones, job.name) if isinstance(job, arguments.Arguments) else (job[0], str(job[1]))
        for job in joblist.jobs_of(read_request(words), (".obj", ".off"))
    ]


def test_one_map():
    words = ["--cones", "1,2,3", "--map-to", "b.off", "--map-cones=4,5,6", "--transfer", "form,heat"]
    read = read_request(["a.obj", *words])
    one = read.arguments
    assert not read.is_batch and one.signature is None and (one.title, one.name) == ("a.obj to b.off", "b")
    assert (one.map_to, one.cones, one.map_cones) == (Path("b.off"), (1, 2, 3), (4, 5, 6))
    assert one.transfer == ("form", "heat")
    alone = read_request(["--map-to", "b.off"]).arguments
    assert alone.title == "creature to b.off" and alone.cones is None and alone.map_cones is None


@pytest.mark.parametrize(("words", "cause"), [
    (["--map-cones", "1,2"], "--map-cones goes with --map-to"),
    (["--transfer", "form"], "--transfer goes with --map-to"),
    (["--map-object", "Cube"], "--map-object goes with --map-to"),
    (["--map-to", "b.obj", "--cones", "auto"], "--cones auto"),
    (["--map-to", "b.obj", "--orders", "2,2"], "--orders"),
    (["--map-to", "b.obj", "--map-cones", "1,x"], "--map-cones 1,x: expected whole numbers"),
    (["--map-to", "b.obj", "--map-to", "c.obj", "--map-cones", "1,2"], "1 --map-cones for 2 --map-to"),
])
def test_what_is_refused(words, cause):
    with pytest.raises(RunError, match=cause):
        read_request(["a.obj", *words])


def test_several_targets_are_several_jobs(tmp_path):
    for name in ("a.obj", "b.off", "c.obj", "notes.txt"):
        (tmp_path / name).write_text("")
    two = ["--map-to", "x/b.obj", "--map-cones", "4,5", "--map-to", "x/c.obj", "--map-cones", "6,7"]
    assert jobs(["a.obj", *two]) == [("a.obj to b.obj", (4, 5), "b"), ("a.obj to c.obj", (6, 7), "c")]
    assert [title for title, *_ in jobs(two)] == ["creature to b.obj", "creature to c.obj"]
    folder = jobs([str(tmp_path / "a.obj"), "--map-to", str(tmp_path)])
    assert folder == [("a.obj to b.off", None, "b"), ("a.obj to c.obj", None, "c")], "the source is no target"
    assert jobs(["a.obj", "--map-to", "x/b.obj", "--map-to", "y/b.off"])[1] == (
        "a.obj to b.off", "a.obj to b.obj writes the same files; give the two different outputs"
    )


def test_a_list_of_maps(tmp_path):
    rows = [
        {"mesh": "a.obj", "cones": [1, 2, 3], "map-to": "b.obj", "map-cones": [4, 5, 6], "transfer": ["form", "heat"]},
        {"mesh": "a.obj", "map-to": "d.obj", "map-cones": "7 8 9"},
        {"mesh": "a.obj", "cones": "auto", "map-to": "c.obj"},
        {"mesh": "a.obj", "orders": "2,2,2"},
    ]
    path = tmp_path / "jobs.json"
    path.write_text(json.dumps(rows))
    first, second, third, fourth = joblist.jobs_of(read_request(["--jobs", str(path), "--map-to", "e.obj"]), ())
    assert (first.map_to, first.map_cones, first.transfer) == (tmp_path / "b.obj", (4, 5, 6), ("form", "heat"))
    assert (second.map_to, second.map_cones, second.transfer) == (tmp_path / "d.obj", (7, 8, 9), None)
    assert third[0] == "a.obj" and "--cones auto" in str(third[1])
    assert fourth[0] == "a.obj" and "--orders" in str(fourth[1])
