# SPDX-License-Identifier: GPL-3.0-or-later
import pytest

import core

KNOWN = {
    "spherical": ["22", "33", "(12)(12)", "222", "22(5)", "22(12)", "332", "432", "234", "532", "*432", "3*2", "2x"],
    "euclidean": ["442", "333", "632", "236", "2222", "*442", "4*2", "22*", "22x", "**", "*x", "xx", "o"],
    "hyperbolic": ["237", "245", "444", "2223", "22222", "2" * 10, "(50)(50)(50)", "*237", "oo"],
}


@pytest.mark.parametrize("geometry, signature", [(g, s) for g, all_of_it in KNOWN.items() for s in all_of_it])
def test_geometry(geometry, signature):
    assert core.geometry_of(signature) == geometry


def test_parse():
    read = core.parse_signature("22(12)")
    assert read.orders == (2, 2, 12) and read.geometry == "spherical" and read.curvature == 1 and read.supported
    assert read.euler == pytest.approx(1 / 12, abs=1e-15)
    assert core.parse_signature("*442").supported


@pytest.mark.parametrize(
    "signature, status, position",
    [
        ("", "ORB_BAD_SIGNATURE", 0),
        ("44q", "ORB_BAD_SIGNATURE", 2),
        ("4(4", "ORB_BAD_SIGNATURE", None),
        ("44)", "ORB_BAD_SIGNATURE", 2),
        ("4()2", "ORB_BAD_SIGNATURE", None),
        ("4\x002", "ORB_BAD_SIGNATURE", 1),
        ("441", "ORB_BAD_ORDER", None),
        ("440", "ORB_BAD_ORDER", None),
        ("23", "ORB_BAD_ORBIFOLD", None),
        ("5", "ORB_BAD_ORBIFOLD", None),
    ],
)
def test_bad_signatures(signature, status, position):
    with pytest.raises(core.OrbifoldError) as caught:
        core.parse_signature(signature)
    assert caught.value.status == status
    if position is not None:
        assert caught.value.elements == [position] and caught.value.element == "character"


def test_format_is_the_inverse_of_parse():
    for orders in [(4, 4, 2), (2, 2, 12), (10, 10), (9, 9), (2, 3, 7), (2,) * 30, (100, 2, 3, 11)]:
        assert core.parse_signature(core.format_signature(orders)).orders == orders
    assert core.format_signature([2, 2, 12]) == "22(12)"
