# SPDX-License-Identifier: GPL-3.0-or-later
"""Work in steps, with the interface of a job (addon/steps.py)."""

import pytest
from surfaces import bare

import core


def work(done, fails=False):
    for step in range(3):
        yield f"step {step}", step / 3
        done.append(step)
    if fails:
        raise ValueError("no")
    return "made"


def test_each_look_does_one_step():
    done = []
    steps = bare("steps").Steps(work(done))
    assert not done and steps.poll() == ("step 0", 0, False) and not done
    assert steps.poll() == ("step 1", 1 / 3, False) and done == [0]
    steps.poll()
    assert steps.poll()[2] and done == [0, 1, 2] and steps.finish() == "made"


def test_what_is_left_is_done_at_the_end_and_errors_come_then():
    done = []
    steps = bare("steps").Steps(work(done, fails=True))
    steps.poll()
    with pytest.raises(ValueError, match="no"):
        steps.finish()
    assert done == [0, 1, 2] and steps.poll()[2]


def test_a_cancelled_one_does_no_more():
    done = []
    steps = bare("steps").Steps(work(done))
    steps.poll(), steps.poll(), steps.cancel()
    assert done == [0] and steps.poll()[2]
    with pytest.raises(bare("core").OrbifoldError) as caught:
        steps.finish()
    assert caught.value.status == "ORB_CANCELLED" and done == [0]


def test_nobody_has_to_wait_for_it():
    done = []
    assert core.wait_for(bare("steps").Steps(work(done)), None) == "made" and done == [0, 1, 2]


def test_steps_of_steps():
    done, steps = [], bare("steps")
    whole = steps.Steps(steps.part_of(0.5, 1.0, work(done)))
    assert [whole.poll()[1] for _ in range(3)] == [0.5, 0.5 + 0.5 / 3, 0.5 + 1 / 3] and whole.finish() == "made"
