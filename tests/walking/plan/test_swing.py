"""References of the feet: minimum-jerk swing to a landing that may move."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from walking.data import FootReference
from walking.parameters import CONTROL_PERIOD
from walking.plan.footsteps import Foothold
from walking.plan.swing import (
    PEAK,
    lift_foot,
    lift_profile,
    min_swing_ticks,
    minimum_jerk,
    move_foot,
    moved,
)


def test_minimum_jerk_starts_and_ends_at_rest_and_peaks_in_the_middle():
    fractions = np.linspace(0.0, 1.0, 2001)
    position = np.array([minimum_jerk(s) for s in fractions.tolist()])
    speed = np.gradient(position, fractions)
    assert (position[0], position[-1]) == (0.0, 1.0)
    assert speed.max() == pytest.approx(PEAK, rel=1e-4)
    assert abs(speed[[0, -1]]).max() < 1e-4


def run(start, targets):
    """Position, velocity and acceleration of x of the right foot."""
    feet = np.zeros(2, FootReference)
    feet[1].x = start
    rows = []
    for k, target in enumerate(targets):
        move_foot(feet[1], Foothold(False, target, 0.0, 0.0), len(targets) - k)
        rows.append((feet[1].x, feet[1].rate.x, feet[1].acceleration.x))
    return np.array(rows)


def test_replanning_a_fixed_target_is_the_minimum_jerk_quintic():
    rows = run(0.1, [0.3] * 40)
    expected = [0.1 + 0.2 * minimum_jerk(k / 40) for k in range(1, 41)]
    np.testing.assert_allclose(rows[:, 0], expected, atol=1e-12)


@given(st.lists(st.floats(-0.2, 0.2), min_size=30, max_size=60))
def test_any_landing_is_reached_at_rest(targets):
    assert run(0.0, targets)[-1] == pytest.approx((targets[-1], 0.0, 0.0))


def test_position_velocity_and_acceleration_belong_together():
    rows = run(0.0, [0.1] * 20 + [0.15] * 30)
    np.testing.assert_allclose(
        np.diff(rows[:-1, 0]) / CONTROL_PERIOD, 0.5 * (rows[1:-1, 1] + rows[:-2, 1]), atol=2e-3
    )


@given(st.floats(0.01, 0.99))
def test_rate_and_acceleration_of_the_lift_are_its_derivatives(phase):
    step = 1e-4
    below, here, above = (lift_profile(phase + k * step) for k in (-1.0, 0.0, 1.0))
    rate = (above.height - below.height) / (2.0 * step)
    acceleration = (above.rate - below.rate) / (2.0 * step)
    assert (here.rate, here.acceleration) == pytest.approx((rate, acceleration), abs=1e-4)


def lifted(ticks):
    """Height, rate and acceleration of a swing that takes as many ticks from each tick on."""
    foot, phase, rows = np.zeros(1, FootReference)[0], 0.0, []
    for left in ticks:
        change = (1.0 - phase) / left
        phase += change
        lift_foot(foot, 0.025, phase, change, left)
        rows.append((foot.height, foot.climb, foot.bend))
    return np.array(rows)


def test_a_swing_in_time_follows_the_profile():
    rows = lifted(range(50, 0, -1))
    expected = [0.025 * lift_profile(k / 50).height for k in range(1, 51)]
    np.testing.assert_allclose(rows[:, 0], expected, atol=1e-12)


@pytest.mark.parametrize("change", [-8, 25])
def test_the_height_of_a_retimed_swing_is_smooth_and_ends_at_rest(change):
    rows = lifted([*range(50, 30, -1), *range(30 + change, 0, -1)])
    heights = np.array([0.0, *rows[:, 0]])
    speeds = np.diff(heights) / CONTROL_PERIOD
    usual = np.diff(lifted(range(50, 0, -1))[:, 1])
    assert np.abs(np.diff(rows[:, 1])).max() < 3.0 * np.abs(usual).max()
    np.testing.assert_allclose(speeds[1:], 0.5 * (rows[1:, 1] + rows[:-1, 1]), atol=0.01)
    assert rows[-1] == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)


def test_the_swing_time_respects_the_peak_speed():
    foot = np.zeros(1, FootReference)[0]
    ticks = min_swing_ticks(foot, Foothold(True, 0.03, 0.04, 0.0), 0.5)
    assert (ticks - 1) * CONTROL_PERIOD < PEAK * 0.05 / 0.5 <= ticks * CONTROL_PERIOD


def test_a_landing_moves_and_turns_together_and_no_faster_than_allowed():
    a, b = Foothold(True, 0.0, 0.0, 0.0), Foothold(True, 0.03, -0.01, 0.6)
    assert moved(a, b, 0.02, 0.1)[1:] == pytest.approx((0.005, -0.01 / 6.0, 0.1))
    assert moved(a, b, 0.01, 10.0).x == pytest.approx(0.01)
    assert moved(a, b, 0.03, 0.6) == b
