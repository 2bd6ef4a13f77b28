# SPDX-License-Identifier: GPL-3.0-or-later
"""How `./build.sh run` comes to its cones (addon/headless/placing.py): what is suggested, and what is tried in turn."""

from types import SimpleNamespace

import pytest
import shapes
import surfaces
from meshes import icosphere

placing = surfaces.bare("headless.placing")
core = placing.core
read_request = surfaces.bare("headless.arguments").read_request


@pytest.fixture
def ball():
    vertices, triangles = icosphere(3)
    return SimpleNamespace(vertices=vertices * [1.0, 1.5, 2.2], triangles=triangles)


def placed(mesh, *words):
    return placing.embed_placed(read_request(words).arguments, mesh)


def failing(monkeypatch, signatures, status="ORB_CERTIFICATE_FAILED"):
    """Embeddings of these signatures fail; the list in which all that were tried are noted."""
    tried, real = [], core.embed

    def embed(vertices, triangles, signature, *rest, **settings):
        tried.append(signature)
        if signatures is None or signature in signatures:
            raise core.OrbifoldError(status, f"no luck with {signature}")
        return real(vertices, triangles, signature, *rest, **settings)

    monkeypatch.setattr(core, "embed", embed)
    return tried


def test_without_a_word_the_best_suggestion(ball):
    found = placed(ball)
    assert found.suggestion == core.suggest_cones(ball.vertices, ball.triangles)[0] and found.remarks == []
    assert tuple(found.result.cones) == found.suggestion.cones


def test_with_cones_nothing_is_suggested(ball):
    found = placed(ball, "--cones", "0,10,20")
    assert found.suggestion is None and found.result.signature == "442"
    assert found.result.cones.tolist() == [0, 10, 20]


def test_a_signature_without_cones_needs_no_suggestion():
    vertices, triangles = shapes.torus()
    found = placed(SimpleNamespace(vertices=vertices, triangles=triangles), "--orbifold", "o")
    assert found.suggestion is None and found.result.signature == "o"


@pytest.mark.parametrize("orders", [(4, 4, 2), (4, 2, 4), (2, 4, 4)])
@pytest.mark.parametrize("words", [(), ("--orbifold", "442"), ("--orbifold", "442", "--cones", "auto")])
def test_orders_in_any_sequence_keep_each_cone_s_own(ball, orders, words):
    found = placed(ball, "--orders", ",".join(map(str, orders)), *words)
    assert tuple(found.result.orders) == orders
    own = dict(zip(found.suggestion.cones, found.suggestion.orders))
    assert {int(v): int(n) for v, n in zip(found.result.cones, found.result.orders)} == own


def test_orders_of_corners_too():
    vertices, triangles = shapes.disk(16)
    found = placed(SimpleNamespace(vertices=vertices, triangles=triangles), "--orbifold", "*432", "--orders", "2,4,3")
    own = dict(zip(found.suggestion.cones, found.suggestion.orders))
    assert {int(v): int(n) for v, n in zip(found.result.cones, found.result.orders)} == own


@pytest.mark.parametrize("orders", ["6,3,2", "4,4", "4,4,2,2"])
def test_orders_of_another_signature_are_refused(ball, orders):
    with pytest.raises(surfaces.bare("headless.errors").RunError, match="4,4,2 in any sequence"):
        placed(ball, "--orders", orders)


def test_the_next_suggestion_is_tried_and_the_run_says_so(ball, monkeypatch):
    found = core.suggest_cones(ball.vertices, ball.triangles)
    tried = failing(monkeypatch, {found[0].signature, found[1].signature})
    used = placed(ball)
    assert used.suggestion == found[2] and tried == [one.signature for one in found[:3]]
    (remark,) = used.remarks
    assert found[0].signature in remark and found[1].signature in remark and "no luck" in remark


def test_at_most_five_are_tried_and_the_best_one_s_error_is_raised(ball, monkeypatch):
    found = core.suggest_cones(ball.vertices, ball.triangles)
    tried = failing(monkeypatch, None)
    with pytest.raises(core.OrbifoldError, match=f"no luck with {found[0].signature}"):
        placed(ball)
    assert len(tried) == min(5, len(found))


def test_errors_of_the_mesh_are_not_tried_again(ball, monkeypatch):
    tried = failing(monkeypatch, None, "ORB_ZERO_AREA_TRIANGLE")
    with pytest.raises(core.OrbifoldError):
        placed(ball)
    assert len(tried) == 1


def test_weights_for_the_plane_take_a_suggestion_in_the_plane(ball):
    assert placed(ball, "--weights", "mean-value-exact").result.geometry == "euclidean"
