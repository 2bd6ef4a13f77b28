# SPDX-License-Identifier: GPL-3.0-or-later
"""Embeddings as jobs: progress, cancelling at any size, and what is raised on the way."""

import gc
import os
import signal
import time

import numpy as np
import pytest
from meshes import far_apart, icosphere

import core


@pytest.fixture(scope="module")
def large():
    """163,842 vertices and ten cones on them."""
    vertices, triangles = icosphere(7)
    return vertices, triangles, far_apart(vertices, triangles, 10)


@pytest.fixture(scope="module")
def small():
    vertices, triangles = icosphere(4)
    return vertices, triangles, far_apart(vertices, triangles, 3)


def threads():
    return len(os.listdir("/proc/self/task"))


def wait_for_threads(wanted, seconds=120):
    """Cancelled jobs end by themselves; wait for the last one so that the next test has the machine."""
    until = time.monotonic() + seconds
    while threads() > wanted and time.monotonic() < until:
        time.sleep(0.02)
    return threads()


def poll_until(job, reached):
    """Until a fraction of the work is done; it must not be over by then."""
    fraction, over = 0.0, False
    while fraction < reached and not over:
        time.sleep(0.001)
        stage, fraction, over = job.poll()
        assert isinstance(stage, str) and 0 <= fraction <= 1
    assert not over


def cancel(job):
    """The job is over from then on, whatever its thread still does."""
    job.cancel()
    assert job.poll()[2]
    with pytest.raises(core.OrbifoldError) as caught:
        job.finish()
    assert caught.value.status == "ORB_CANCELLED"


class Asked:
    """Progress that answers `answer()` once a fraction is reached, and notes how often it was asked for it."""

    def __init__(self, reached, answer):
        self.reached, self.answer, self.times, self.fraction = reached, answer, 0, 0.0

    def __call__(self, stage, fraction):
        self.fraction = fraction
        if fraction < self.reached:
            return True
        self.times += 1
        return self.answer()


@pytest.mark.parametrize("reached", [0.0, 0.05, 0.1, 0.2, 0.3, 0.5, 0.9])
def test_a_cancelled_job_is_over_at_any_moment(large, reached):
    before = threads()
    vertices, triangles, cones = large
    job = core.start_embedding(vertices, triangles, "2" * 10, cones)
    poll_until(job, reached)
    cancel(job)
    assert wait_for_threads(before) == before


@pytest.mark.parametrize("reached", [0.0, 0.2])
def test_progress_that_returns_false_cancels(large, reached):
    before = threads()
    vertices, triangles, cones = large
    asked = Asked(reached, lambda: False)
    with pytest.raises(core.OrbifoldError) as caught:
        core.embed(vertices, triangles, "2" * 10, cones, progress=asked)
    assert asked.times == 1
    assert caught.value.status == "ORB_CANCELLED"
    assert wait_for_threads(before) == before


def test_exception_in_progress_propagates_and_cancels(large):
    before = threads()
    vertices, triangles, cones = large

    def fail():
        raise ZeroDivisionError("from progress")

    asked = Asked(0.0, fail)
    with pytest.raises(ZeroDivisionError, match="from progress"):
        core.embed(vertices, triangles, "2" * 10, cones, progress=asked)
    assert asked.times == 1
    assert wait_for_threads(before) == before


def test_interrupt_from_the_keyboard_takes_effect_before_the_end(large):
    before = threads()
    vertices, triangles, cones = large
    handler = signal.signal(signal.SIGALRM, signal.default_int_handler)

    def soon():
        signal.setitimer(signal.ITIMER_REAL, 0.005)
        asked.reached = 2.0

    asked = Asked(0.05, soon)
    try:
        with pytest.raises(KeyboardInterrupt):
            core.embed(vertices, triangles, "2" * 10, cones, progress=asked)
        assert asked.times == 1 and asked.fraction < 0.9
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, handler)
    assert wait_for_threads(before) == before


def test_job_that_is_dropped_is_cancelled(large):
    before = threads()
    vertices, triangles, cones = large
    job = core.start_embedding(vertices, triangles, "2" * 10, cones)
    del job
    gc.collect()
    assert wait_for_threads(before) == before


@pytest.mark.parametrize("signature", ["442", "432", "237"])
def test_progress_is_monotone_and_named(signature):
    vertices, triangles = icosphere(6)
    seen = []
    core.embed(
        vertices, triangles, signature, far_apart(vertices, triangles, 3), progress=lambda *now: seen.append(now)
    )
    fractions = [fraction for _, fraction in seen]
    assert len(seen) > 3 and all(a <= b for a, b in zip(fractions, fractions[1:]))
    assert 0 <= fractions[0] and 0.9 < fractions[-1] <= 1
    assert len({stage for stage, _ in seen if stage}) >= 2


def test_job_gives_what_embed_gives(small):
    vertices, triangles, cones = small
    job = core.start_embedding(vertices, triangles, "432", cones)
    while not job.poll()[2]:
        time.sleep(0.001)
    assert np.array_equal(job.finish().embedding, core.embed(vertices, triangles, "432", cones).embedding)


def test_finished_job_takes_no_more_calls(small):
    vertices, triangles, cones = small
    job = core.start_embedding(vertices, triangles, "442", cones)
    job.finish()
    job.cancel()
    assert job.poll()[2]
    with pytest.raises(core.OrbifoldError) as caught:
        job.finish()
    assert caught.value.status == "ORB_BAD_ARGUMENT"


def test_jobs_run_side_by_side(small):
    vertices, triangles, cones = small
    jobs = {s: core.start_embedding(vertices, triangles, s, cones) for s in ("442", "432", "237", "333")}
    for signature, job in jobs.items():
        alone = core.embed(vertices, triangles, signature, cones)
        assert np.array_equal(job.finish().embedding, alone.embedding)


def test_bad_mesh_fails_in_the_job():
    vertices, triangles = icosphere(1)
    job = core.start_embedding(vertices, triangles[1:], "442", [0, 1, 2])
    with pytest.raises(core.OrbifoldError) as caught:
        job.finish()
    assert caught.value.status == "ORB_BOUNDARY" and caught.value.element == "edge"
