# SPDX-License-Identifier: GPL-3.0-or-later
"""docs/orbifolds.md shows every family, pictures are there and small, and no link and no name of a file leads nowhere."""

import re
import struct

import pytest
from conftest import CHECKOUT
from conway import features
from families import EUCLIDEAN

PAGE = CHECKOUT / "docs" / "orbifolds.md"
ROWS = re.findall(r"^\| `([^`]+)` \|.*!\[([^\]]+)\]\(([^)]+)\) \|$", PAGE.read_text(encoding="utf-8"), re.M)
SPHERICAL_FAMILIES = [
    *["532", "432", "332", "22N", "NN", "*532", "*432", "*332", "*22N", "*NN", "3*2", "2*N", "N*", "Nx"],
]


def test_every_family_has_a_row():
    rows = [name for name, _, _ in ROWS]
    assert rows[:14] == SPHERICAL_FAMILIES and rows[14:31] == EUCLIDEAN and len(rows) >= 41
    for name, shown, _ in ROWS:
        n = next((digit for digit in shown if digit not in name), "")
        assert name.replace("N", n) == shown
    geometry = [features(shown).geometry for _, shown, _ in ROWS]
    assert geometry == ["spherical"] * 14 + ["euclidean"] * 17 + ["hyperbolic"] * (len(rows) - 31)


@pytest.mark.parametrize("shown, picture", [(shown, picture) for _, shown, picture in ROWS])
def test_picture_is_there_and_small(shown, picture):
    path = PAGE.parent / picture
    head = path.read_bytes()[:24]
    assert head[:8] == b"\x89PNG\r\n\x1a\n"
    width, height = struct.unpack(">II", head[16:])
    assert width <= 960 and height <= 540 and path.stat().st_size < 200_000


def test_pictures_are_small_in_all_and_each_is_shown():
    pictures = sorted((PAGE.parent / "orbifolds").iterdir())
    assert sum(path.stat().st_size for path in pictures) < 6_000_000
    assert {path.name for path in pictures} == {picture.partition("/")[2] for _, _, picture in ROWS}


def test_the_table_of_cones_keeps_what_it_promises():
    """One click is at most 1.1 times the best of 200 random triples, and the prediction near what was measured."""
    text = (CHECKOUT / "docs" / "cones.md").read_text(encoding="utf-8")
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in text.splitlines() if line.count("|") == 12]
    rows = [row for row in rows[2:] if row[0]]
    assert len(rows) == 11
    for name, _, signature, cones, predicted, measured, angles, random_best, median, _, _ in rows:
        said, spread, best = float(predicted), float(measured), float(random_best)
        assert features(signature.strip("`")).geometry == "euclidean" and len(cones.split(",")) <= 4, name
        assert spread <= 1.1 * best <= 1.1 * float(median) and abs(said / spread - 1) < 0.05, name
        assert 1 <= float(angles) < 1.3, name


def links(page):
    """What is named by relative links, and shown."""
    found = re.findall(r"\]\(([^)#]+)[^)]*\)", page.read_text(encoding="utf-8"))
    return [page.parent / link for link in found if not re.match(r"[a-z]+:", link)]


def test_links_lead_somewhere():
    for page in [CHECKOUT / "README.md", *(CHECKOUT / "docs").glob("*.md")]:
        for link in links(page):
            assert link.exists(), f"{page.name}: {link}"


def test_the_index_has_every_page():
    docs = CHECKOUT / "docs"
    assert {path.name for path in links(docs / "README.md")} >= {path.name for path in docs.glob("*.md")} - {"README.md"}


def test_pictures_of_the_window_are_small_and_each_is_shown():
    docs = CHECKOUT / "docs"
    pictures = set((docs / "window").iterdir())
    assert pictures and all(path.stat().st_size < 150_000 for path in pictures)
    assert sum(path.stat().st_size for path in pictures) < 2_000_000
    assert pictures == {link for page in docs.glob("*.md") for link in links(page) if link.parent.name == "window"}


def test_files_that_pages_name_are_there():
    """In code, with a folder before the name; NAME and the like stand for others."""
    for page in [CHECKOUT / "README.md", *(CHECKOUT / "docs").glob("*.md")]:
        for name in re.findall(r"`((?:addon|native|tests|docs)/[^`\s]*)`", page.read_text(encoding="utf-8")):
            if not re.search(r"[A-Z]{3,}|liborbifold|[*{]", name):
                assert (CHECKOUT / name).exists(), f"{page.name}: {name}"
