# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

import core

SQUARE = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"


def read(tmp_path, name, text):
    path = tmp_path / name
    path.write_text(text)
    return core.read_mesh(path)


@pytest.mark.parametrize(
    "text, triangles",
    [
        (f"OFF\n4 2 0\n{SQUARE}3 0 1 2\n3 0 2 3\n", [[0, 1, 2], [0, 2, 3]]),
        (f"OFF\n4 1 0\n{SQUARE}4 0 1 2 3\n", [[0, 1, 2], [0, 2, 3]]),
        (f"OFF 4 2 0 # here\n\n# a comment\n{SQUARE}3 0 1 2 255 0 0\n4 3 2 1 0\n", [[0, 1, 2], [3, 2, 1], [3, 1, 0]]),
        ("COFF\r\n3 1 0\r\n0 0 0 255 0 0\r\n1 0 0 255 0 0\r\n0 1 0 255 0 0\r\n3 0 1 2\r\n", [[0, 1, 2]]),
        ("OFF\n0 0 0\n", np.zeros((0, 3))),
    ],
)
def test_off(tmp_path, text, triangles):
    vertices, faces = read(tmp_path, "mesh.off", text)
    assert vertices.dtype == np.float64 and faces.dtype == np.int32
    assert np.array_equal(faces, triangles)
    assert vertices.shape == (0 if len(triangles) == 0 else faces.max() + 1, 3)


@pytest.mark.parametrize(
    "text, line",
    [
        ("OF\n", 1),
        ("OFF\nmany few\n", 2),
        (f"OFF\n4 2 0\n{SQUARE}3 0 1 2\n", 7),
        ("OFF\n3 1 0\n0 0 0\n0 zero 0\n0 0 0\n3 0 1 2\n", 4),
        ("OFF\n3 1 0\n0 0 0\n# between\n0 0\n0 0 0\n3 0 1 2\n", 5),
        (f"OFF\n4 2 0\n{SQUARE}3 0 1 2\n4 0 1 2\n", 8),
        (f"OFF\n4 2 0\n{SQUARE}3 0 1 2\n2 0 1\n", 8),
        (f"OFF\n4 2 0\n{SQUARE}3 0 1 4\n3 0 1 2\n", 7),
        (f"OFF\n4 2 0\n{SQUARE}4 0 1 2 3\n3 0 1 -2\n", 8),
    ],
)
def test_off_errors_name_the_line(tmp_path, text, line):
    with pytest.raises(core.MeshFileError, match=rf"mesh\.off:{line}: "):
        read(tmp_path, "mesh.off", text)


def test_obj(tmp_path):
    text = "# made by hand\no thing\n" + "".join(f"v {line}\n" for line in SQUARE.split("\n") if line)
    text += "vt 0 0\nvn 0 0 1\nusemtl none\nf 1/1/1 2/1/1 3/1/1 4/1/1\nv\t0 0 1\nf -1 1//1 2\n"
    vertices, faces = read(tmp_path, "mesh.obj", text)
    assert np.array_equal(faces, [[0, 1, 2], [0, 2, 3], [4, 0, 1]])
    assert np.array_equal(vertices[[2, 4]], [[1, 1, 0], [0, 0, 1]])


@pytest.mark.parametrize("bad, line", [("f 1 2", 4), ("f 1 2 x", 4), ("f 1 2 0", 4), ("f 1 2 9", 4), ("v 1 2", 4)])
def test_obj_errors_name_the_line(tmp_path, bad, line):
    with pytest.raises(core.MeshFileError, match=rf"mesh\.obj:{line}: "):
        read(tmp_path, "mesh.obj", f"v 0 0 0\nv 1 0 0\nv 0 1 0\n{bad}\n")


def test_other_endings_are_refused(tmp_path):
    with pytest.raises(core.MeshFileError, match="only .off and .obj"):
        core.read_mesh(tmp_path / "mesh.stl")
