# SPDX-License-Identifier: GPL-3.0-or-later
"""What a menu offers for a surface and picks on it, and how it is said."""

from fractions import Fraction

import numpy as np
import pytest
from surfaces import bare

import core

SMALL = range(2, 13)
# (euler, loops, genus, orientable, interior picks, picks on the loops): all that are not hyperbolic
COMPLETE = {
    (2, 0, 0, True, 2, ()): [f"{n}{n}" if n < 10 else f"({n})({n})" for n in SMALL],
    (2, 0, 0, True, 3, ()): ["442", "333", "632", "432", "532", "332"]
    + [f"22{n}" if n < 10 else f"22({n})" for n in SMALL],
    (2, 0, 0, True, 4, ()): ["2222"],
    (1, 1, 0, True, 0, (2,)): [f"*{n}{n}" if n < 10 else f"*({n})({n})" for n in SMALL],
    (1, 1, 0, True, 0, (3,)): ["*442", "*333", "*632", "*432", "*532", "*332"]
    + [f"*22{n}" if n < 10 else f"*22({n})" for n in SMALL],
    (1, 1, 0, True, 0, (4,)): ["*2222"],
    (1, 1, 0, True, 1, (0,)): [f"{n}*" if n < 10 else f"({n})*" for n in SMALL],
    (1, 1, 0, True, 1, (1,)): ["3*2", "4*2", "3*3"] + [f"2*{n}" if n < 10 else f"2*({n})" for n in SMALL],
    (1, 1, 0, True, 1, (2,)): ["2*22"],
    (1, 1, 0, True, 2, ()): ["22*"],
    (1, 0, 1, False, 1, ()): [f"{n}x" if n < 10 else f"({n})x" for n in SMALL],
    (1, 0, 1, False, 2, ()): ["22x"],
    (0, 2, 0, True, 0, ()): ["**"],
    (0, 1, 1, False, 0, ()): ["*x"],
    (0, 0, 2, False, 0, ()): ["xx"],
    (0, 0, 1, True, 0, ()): ["o"],
}


@pytest.mark.parametrize("case", COMPLETE, ids=str)
def test_spherical_and_euclidean_families_are_complete(case):
    offers = core.fitting_signatures(*case)
    assert len({offer.signature for offer in offers}) == len(offers)
    assert {o.signature for o in offers if o.geometry != "hyperbolic"} == set(COMPLETE[case])


@pytest.mark.parametrize("n_cones", range(7))
@pytest.mark.parametrize("counts", [(), (0,), (1,), (3,), (5,), (2, 0), (1, 3)], ids=str)
@pytest.mark.parametrize("genus, orientable", [(0, True), (1, True), (2, True), (1, False), (2, False)])
def test_all_offers_fit(n_cones, counts, genus, orientable):
    euler = 2 - (2 if orientable else 1) * genus - len(counts)
    offers = core.fitting_signatures(euler, len(counts), genus, orientable, n_cones, counts)
    for offer in offers:
        assert offer.supported and offer.n_interior == n_cones
        assert sorted(map(len, offer.borders)) == sorted(counts)
        handles = offer.n_handles, 0
        assert (offer.n_handles, offer.n_crosscaps) == ((genus, 0) if orientable else (0, genus)), handles
        chi = euler - sum((Fraction(n - 1, n) for n in offer.cone_orders), Fraction(0))
        chi -= sum((Fraction(n - 1, 2 * n) for n in offer.orders[n_cones:]), Fraction(0))
        assert offer.geometry == ("spherical" if chi > 0 else "euclidean" if chi == 0 else "hyperbolic")
        assert offer.euler == pytest.approx(float(chi), abs=1e-12)
    order = [("euclidean", "spherical", "hyperbolic").index(offer.geometry) for offer in offers]
    assert order == sorted(order)
    if n_cones + sum(counts) > 4 or (euler < 0 and len(counts) < 3):
        assert offers, "nothing hyperbolic is offered"


def test_surfaces_that_do_not_exist_have_no_offers():
    assert core.fitting_signatures(2, 0, 1, True, 3) == []
    assert core.fitting_signatures(4, 0, 0, True, 3) == []  # two spheres
    assert core.fitting_signatures(2, 0, 0, True, 0) == core.fitting_signatures(2, 0, 0, True, 1) == []


def test_the_usual_ones_come_first():
    three = [offer.signature for offer in core.fitting_signatures(2, 0, 0, True, 3)]
    assert set(three[:3]) == {"442", "333", "632"} and set(three[3:6]) == {"532", "432", "332"}
    assert three[6:9] == ["222", "223", "224"] and "237" in three
    assert core.fitting_signatures(2, 0, 0, True, 10)[0].signature == "2" * 10
    assert core.fitting_signatures(-2, 0, 2, True, 0)[0].signature == "oo"


WORDS = {
    "432": "432: sphere with cones of 90, 120 and 180 degrees",
    "4*2": "4*2: disk with a cone of 90 degrees and a mirror corner of 90 degrees",
    "*632": "*632: disk with mirror corners of 30, 60 and 90 degrees",
    "**": "**: annulus, both borders mirrors",
    "*x": "*x: Möbius band, its border a mirror",
    "xx": "xx: Klein bottle",
    "22x": "22x: projective plane with cones of 180 and 180 degrees",
    "7*": "7*: disk with a cone of 51.43 degrees, its border a mirror",
    "o": "o: torus",
    "oo": "oo: surface of genus 2",
    "o2": "o2: torus with a cone of 180 degrees",
    "2222222": "2222222: sphere with 7 cones of 180 degrees",
    "***": "***: sphere with 3 borders, all 3 borders mirrors",
}


@pytest.mark.parametrize("signature", WORDS)
def test_in_words(signature):
    assert core.describe(signature) == WORDS[signature]


def test_borders_and_counts():
    read = core.parse_signature("53*2(12)*")
    assert read.cone_orders == (5, 3) and read.borders == ((2, 12), ()) and read.n_interior == 2
    assert core.format_signature((5, 3), [(2, 12), ()]) == "53*2(12)*"
    assert core.format_signature((), [()], crosscaps=1) == "*x" and core.format_signature((2,), handles=1) == "o2"


OUTLINES = ["442", "2222", "432", "33", "237", "*632", "*2222", "*33", "3*2", "2*5", "5*", "5x", "4*2", "3*3", "2*22",
            "22*", "22x", "**", "*x", "xx", "o", "*237", "oo", "5*3", "22222", "o2", "2*", "22"]


@pytest.mark.parametrize("signature", OUTLINES)
def test_tile_outlines_and_their_drawings(signature):
    outline = core.tile_outline(signature)
    k = len(outline.corners)
    assert outline.corners.shape == (k, 3) and outline.mirrors.shape == (k,) and k >= 2
    form = (outline.corners**2 * [1, 1, outline.curvature]).sum(1)
    if outline.curvature:
        assert np.allclose(form, outline.curvature, atol=1e-9 * np.abs(outline.corners).max() ** 2)
    assert outline.mirrors.any() == ("*" in signature)
    pixels = bare("tile_icon").tile_pixels(signature, 64)
    assert pixels.shape == (64, 64, 4) and pixels.dtype == np.float32
    assert np.isfinite(pixels).all() and pixels.min() >= 0 and pixels.max() <= 1 + 1e-6
    covered = pixels[..., 3].mean()
    assert 0.05 < covered < 0.9, covered
    assert pixels[:3, :, 3].max() == pixels[:, -3:, 3].max() == 0, "drawn beyond the margin"
