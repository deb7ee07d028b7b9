"""Explicit footsteps in full physics, through the whole loop."""

import numpy as np
import pytest

from walking.command import CommandState

NAMES = ("single_support", "double_support", "forward", "side", "direction", "swing_height")
LOW, HIGH = (0.2, 0.04, -0.06, 0.075, -0.25, 0.015), (0.4, 0.12, 0.1, 0.12, 0.25, 0.035)
STAND, STRETCH, COUNT = 0.6, 0.3, 6  # first stand [s], length of a stretch [s], stretches


@pytest.mark.parametrize("generator", ["preview", "mwpg"])
def test_footsteps_that_change_in_mid_swing_are_walked_and_accounted_for(simulate, generator):
    rng = np.random.default_rng(5)
    states = [CommandState(*rng.uniform(LOW, HIGH).tolist()) for _ in range(COUNT)]
    steps = (", ".join(f"{name}={getattr(state, name)}" for name in NAMES) for state in states)
    stretches = ", ".join(f"{{duration={STRETCH}, footstep={{{step}}}}}" for step in steps)
    _, recorded, _ = simulate(
        "walk",
        f"command.stretch=[{{duration={STAND}}}, {stretches}]",
        f"walking.pattern.generator={generator}",
        "recorder.period_ms=5",
        body="full",
        duration=STAND + STRETCH * COUNT + 1.2,
    )
    walking = [record.walking for record in recorded.records]
    reports = [state.command_limits for state in walking]
    assert not any(state.fallen for state in walking)
    assert max(np.hypot(state.roll, state.pitch) for state in walking) < 0.15
    assert walking[-1].step_count > 4
    assert str(walking[-1].phase) == "standing"
    assert {r.commanded for r in reports if isinstance(r.commanded, CommandState)} == set(states)
    assert all(r.applied == r.commanded for r in reports if not r.limited)
    assert 0.1 < np.mean([r.limited for r in reports]) < 0.9
