"""A push that no balance can hold, in full physics."""

import numpy as np

PUSH = "disturbance.push=[{time=1.0, impulse=4.0, direction_deg=0}]"


def run(simulate, *overrides):
    settings = ("command.vx=0.2", PUSH, *overrides)
    outcome, recorded, _ = simulate("walk", *settings, body="full", duration=11.0)
    return outcome, recorded, [kind for _, kind, _ in recorded.events if kind in ("push", "fall")]


def test_a_fall_ends_the_run_of_a_robot_that_does_not_get_up(simulate):
    outcome, _, events = run(simulate)
    assert outcome.exit_reason == "fall"
    assert outcome.time < 4.0
    assert events == ["push", "fall"]


def test_after_a_fall_it_gets_up_and_walks_on(simulate):
    outcome, recorded, events = run(simulate, "walking.get_up.enabled=true")
    assert outcome.exit_reason == "completed"
    assert events == ["push", "fall"]
    down = [r.time for r in recorded.records if r.walking.phase.down]
    after = [r for r in recorded.records if r.time > down[-1] + 1.0]
    assert not any(r.truth.fallen for r in after)
    moved = after[-1].truth.robot - after[0].truth.robot
    assert np.hypot(*moved[:2]) > 0.1 * (after[-1].time - after[0].time)
    # Off its feet it looks at nothing.
    assert not any(down[0] + 0.2 < frame.time < down[-1] for frame in recorded.frames)
