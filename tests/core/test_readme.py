# SPDX-License-Identifier: GPL-3.0-or-later
"""The README's example works when it is pasted, and what the README names is there."""

import re
import subprocess
import sys

import numpy as np
from conftest import CHECKOUT
from meshes import icosphere

import core

README = (CHECKOUT / "README.md").read_text(encoding="utf-8")


def test_example_runs_as_it_stands(tmp_path):
    (example,) = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
    (tmp_path / "addon").symlink_to(CHECKOUT / "addon")
    (tmp_path / "meshes").mkdir()
    vertices, triangles = icosphere(3)
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (triangles + 1).tolist()]
    (tmp_path / "meshes" / "ball.obj").write_text("\n".join(lines) + "\n")
    done = subprocess.run([sys.executable, "-c", example], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("ball.obj (1280, 3, 2)")
    layout = np.load(tmp_path / "meshes" / "ball.npz")
    best = core.suggest_cones(vertices, triangles)[0]
    assert str(layout["signature"]) == best.signature and len(layout["triangles"]) == len(triangles)


def test_links_and_pictures_are_there():
    targets = [target for target in re.findall(r"\]\(([^)]+)\)", README) if "://" not in target]
    assert targets and all((CHECKOUT / target).exists() for target in targets), targets
    assert (CHECKOUT / "docs" / "creature.png").stat().st_size < 500_000
