# SPDX-License-Identifier: GPL-3.0-or-later
"""Suggested cones through Python: what comes back, what may be asked for, what is refused; jobs."""

import dataclasses
import gc
import time

import numpy as np
import pytest
import shapes
from meshes import icosphere
from test_job import threads, wait_for_threads

import core


def egg(subdivisions=4):
    """A sphere without symmetry, longer than wide, so that some cones are better than others."""
    vertices, triangles = icosphere(subdivisions)
    x, y, z = vertices.T
    return np.stack([x * (1 + 0.3 * y), 2.0 * y + 0.15 * x * z, z + 0.3 * np.exp(-((x - 0.5) ** 2))], 1), triangles


@pytest.fixture(scope="module")
def mesh():
    return egg()


@pytest.fixture(scope="module")
def usual(mesh):
    return core.suggest_cones(*mesh)


def test_the_usual_ones_are_best_first_and_embed(mesh, usual):
    assert len(usual) > 4 and {"442", "2222", "432"} <= {suggestion.signature for suggestion in usual}
    predicted = [suggestion.predicted for suggestion in usual]
    assert predicted == sorted(predicted) and predicted[0] > 0
    for suggestion in usual:
        assert suggestion.orders == core.parse_signature(suggestion.signature).orders
        assert len(set(suggestion.cones)) == len(suggestion.cones) == len(suggestion.orders)
    best = usual[0]
    assert core.embed(*mesh, best.signature, best.cones).report["certificate"]["bijective"]


def test_a_suggestion_is_plain_python_and_cannot_be_changed(usual):
    best = usual[0]
    assert isinstance(best.signature, str) and isinstance(best.predicted, float) and isinstance(best.conformal, float)
    assert isinstance(best.measured, bool) and isinstance(best.symmetric, bool)
    assert all(type(number) is int for number in (*best.cones, *best.orders))
    with pytest.raises(dataclasses.FrozenInstanceError):
        best.cones = ()


def test_the_same_arguments_give_the_same_cones(mesh, usual):
    assert core.suggest_cones(*mesh) == usual


def test_one_signature_or_several(mesh):
    (alone,) = core.suggest_cones(*mesh, "632")
    assert alone.signature == "632" and alone.orders == (6, 3, 2)
    several = core.suggest_cones(*mesh, ["632", "33", "2222"])
    assert {suggestion.signature for suggestion in several} == {"632", "33", "2222"}
    same = next(suggestion for suggestion in several if suggestion.signature == "632")
    assert same.predicted == pytest.approx(alone.predicted, rel=0.01)  # the search shares what it knows


def test_only_the_plane_where_an_image_is_to_repeat(mesh, usual):
    flat = core.suggest_cones(*mesh, flat=True)
    assert {core.geometry_of(suggestion.signature) for suggestion in flat} == {"euclidean"}
    of_all = [suggestion for suggestion in usual if core.geometry_of(suggestion.signature) == "euclidean"]
    assert [one.signature for one in flat] == [one.signature for one in of_all]


def test_fixed_cones_stay(mesh):
    fixed = [100, 700]
    for suggestion in core.suggest_cones(*mesh, ["442", "2222", "33"], fixed):
        assert set(fixed) <= set(suggestion.cones), suggestion.signature


def test_cones_keep_away(mesh):
    vertices, triangles = mesh
    keep_away = np.where(vertices[:, 1] > 0, np.inf, 0.0)
    for suggestion in core.suggest_cones(vertices, triangles, ["442", "2222"], (), keep_away):
        assert (vertices[list(suggestion.cones), 1] <= 0).all(), suggestion.signature


@pytest.mark.parametrize("symmetry", ["detect", "ignore", (1, 0, 0, 0.0), np.array([0.0, 2.0, 0.0, 0.5])])
def test_symmetry_by_name_or_plane(mesh, symmetry):
    (suggestion,) = core.suggest_cones(*mesh, "442", symmetry=symmetry)
    assert len(suggestion.cones) == 3


def test_mirror_corners_lie_on_the_border():
    vertices, triangles = shapes.disk(24)
    border = set(core.topology_of(triangles).loops[0].tolist())
    for suggestion in core.suggest_cones(vertices, triangles, ["*442", "4*2"]):
        read = core.parse_signature(suggestion.signature)
        on_border = [cone in border for cone in suggestion.cones]
        assert on_border == [place >= read.n_interior for place in range(len(read.orders))]
        assert core.embed(vertices, triangles, suggestion.signature, suggestion.cones).orders.tolist()


def test_prediction_of_a_suggestion(mesh, usual):
    vertices, triangles = mesh
    suggestion = next(suggestion for suggestion in usual if suggestion.signature == "442")
    prediction = core.predict(vertices, triangles, "442", suggestion.cones)
    assert prediction.scale.shape == (len(vertices),) and np.isfinite(prediction.scale).all()
    assert prediction.spread == pytest.approx(suggestion.predicted, rel=1e-6)
    assert set(np.argsort(prediction.scale)[-3:]) & set(suggestion.cones), "the map is largest at its cones"
    turned = core.predict(vertices, triangles, "442", suggestion.cones[::-1], suggestion.orders[::-1])
    assert turned.spread == pytest.approx(prediction.spread, rel=1e-9)


def test_prediction_is_near_what_an_embedding_has(mesh):
    (suggestion,) = core.suggest_cones(*mesh, "442")
    report = core.embed(*mesh, "442", suggestion.cones, weights="conformal").report
    assert report["distortion"]["log_area_std"] == pytest.approx(suggestion.predicted, rel=0.25)


REFUSED = {
    "no signature": (dict(signatures=[]), "ORB_BAD_ARGUMENT", "usual"),
    "a number for a signature": (dict(signatures=[442]), "ORB_BAD_ARGUMENT", "string"),
    "a bad signature": (dict(signatures="44y"), "ORB_BAD_SIGNATURE", "character 3"),
    "unknown symmetry": (dict(symmetry="left"), "ORB_BAD_ARGUMENT", "detect"),
    "half a plane": (dict(symmetry=(1, 0)), "ORB_BAD_ARGUMENT", "four numbers"),
    "unknown holes": (dict(holes="plug"), "ORB_BAD_ARGUMENT", "fill"),
    "weights of another mesh": (dict(keep_away=[0.0, 1.0]), "ORB_BAD_ARGUMENT", "shape"),
    "weights that are words": (dict(keep_away=["a"]), "ORB_BAD_ARGUMENT", "numbers"),
    "a fixed cone beyond 32 bits": (dict(fixed=[2**40]), "ORB_BAD_CONE", "beyond"),
    "a fixed cone that is not there": (dict(fixed=[10**6]), "ORB_BAD_CONE", "1000000"),
    "too many fixed cones": (dict(signatures="442", fixed=[1, 2, 3, 4]), "ORB_CONE_COUNT", ""),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_is_refused_is_said(mesh, case):
    settings, status, words = REFUSED[case]
    with pytest.raises(core.OrbifoldError) as caught:
        core.suggest_cones(*mesh, **settings)
    assert caught.value.status == status and words in str(caught.value)


@pytest.mark.parametrize("weight", [-1.0, np.nan])
def test_a_bad_weight_names_its_vertex(mesh, weight):
    keep_away = np.zeros(len(mesh[0]))
    keep_away[77] = weight
    with pytest.raises(core.OrbifoldError) as caught:
        core.suggest_cones(*mesh, "442", (), keep_away)
    assert (caught.value.status, caught.value.element, caught.value.elements) == ("ORB_BAD_WEIGHT", "vertex", [77])


def test_an_open_mesh_is_refused_for_a_closed_signature(mesh):
    vertices, triangles = mesh
    with pytest.raises(core.OrbifoldError) as caught:
        core.suggest_cones(vertices, triangles[1:], "442")
    assert caught.value.status == "ORB_BOUNDARY"


def test_what_a_prediction_refuses(mesh):
    for cones, orders, status in (([1, 2], None, "ORB_CONE_COUNT"), ([1, 2, 10**6], None, "ORB_BAD_CONE"),
                                  ([1, 2, 3], [4, 4], "ORB_BAD_ORDER")):
        with pytest.raises(core.OrbifoldError) as caught:
            core.predict(*mesh, "442", cones, orders)
        assert caught.value.status == status


# ------------------------------------------------------------------------------------------------------- jobs


@pytest.fixture(scope="module")
def large():
    return egg(7)


def test_job_gives_what_suggest_cones_gives(mesh):
    job = core.start_suggesting(*mesh, ["442", "2222"])
    while not job.poll()[2]:
        time.sleep(0.001)
    assert job.finish() == core.suggest_cones(*mesh, ["442", "2222"])


def test_arrays_may_change_after_the_start(mesh):
    vertices, triangles = mesh[0].copy(), mesh[1].copy()
    keep_away = np.zeros(len(vertices))
    job = core.start_suggesting(vertices, triangles, "442", (), keep_away)
    vertices[:], triangles[:], keep_away[:] = 0, 0, -1
    assert job.finish() == core.suggest_cones(*mesh, "442")


@pytest.mark.parametrize("after", [0.0, 0.1, 0.5])
def test_cancel_ends_the_job_and_its_thread(large, after):
    before = threads()
    job = core.start_suggesting(*large)
    time.sleep(after)
    assert not job.poll()[2]
    job.cancel()
    assert job.poll()[2]
    with pytest.raises(core.OrbifoldError) as caught:
        job.finish()
    assert caught.value.status == "ORB_CANCELLED"
    assert wait_for_threads(before) == before


def test_progress_cancels_by_returning_false_or_raising(large):
    before = threads()
    with pytest.raises(core.OrbifoldError) as caught:
        core.suggest_cones(*large, progress=lambda stage, fraction: False)
    assert caught.value.status == "ORB_CANCELLED"

    def progress(stage, fraction):
        raise ZeroDivisionError("from progress")

    with pytest.raises(ZeroDivisionError, match="from progress"):
        core.suggest_cones(*large, progress=progress)
    assert wait_for_threads(before) == before  # or the next test counts theirs


def test_job_that_is_dropped_is_cancelled(large):
    before = threads()
    job = core.start_suggesting(*large)
    del job
    gc.collect()
    assert wait_for_threads(before) == before


def test_finished_job_takes_no_more_calls(mesh):
    job = core.start_suggesting(*mesh, "442")
    job.finish()
    job.cancel()
    assert job.poll()[2]
    with pytest.raises(core.OrbifoldError) as caught:
        job.finish()
    assert caught.value.status == "ORB_BAD_ARGUMENT"


def test_embeddings_that_are_worth_another_try_are_statuses(mesh):
    names = {core.library().orb_status_name(number).decode() for number in range(40)}
    assert set(core.DEPENDS_ON_CONES) <= names
