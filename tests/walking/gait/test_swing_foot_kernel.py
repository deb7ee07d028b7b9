"""Foot references: minimum-jerk swing to a landing that may move."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from walking.gait import swing_foot_kernel
from walking.gait.swing_foot_kernel import HEIGHT, WIDTH, lift_profile
from walking.parameters import CONTROL_PERIOD


def run(start, targets):
    """Position, velocity and acceleration of x of the right foot."""
    feet = np.zeros((2, WIDTH))
    feet[1, 0] = start
    rows = []
    for k, target in enumerate(targets):
        landing, left = (target, 0.0, 0.0), len(targets) - k
        swing_foot_kernel.advance(feet, 0.9, 1, landing, left, (0.02, 0.5), CONTROL_PERIOD)
        rows.append(feet[1, [0, 4, 7]])
    return np.array(rows)


def test_replanning_a_fixed_target_is_the_minimum_jerk_quintic():
    n = 40
    rows = run(0.1, [0.3] * n)
    s = np.arange(1, n + 1) / n
    np.testing.assert_allclose(
        rows[:, 0], 0.1 + 0.2 * (10 * s**3 - 15 * s**4 + 6 * s**5), atol=1e-12
    )


@given(st.lists(st.floats(-0.2, 0.2), min_size=30, max_size=60))
def test_any_landing_is_reached_at_rest(targets):
    rows = run(0.0, targets)
    assert rows[-1] == pytest.approx((targets[-1], 0.0, 0.0))


def test_position_velocity_and_acceleration_belong_together():
    rows = run(0.0, [0.1] * 20 + [0.15] * 30)
    np.testing.assert_allclose(
        np.diff(rows[:-1, 0]) / CONTROL_PERIOD, 0.5 * (rows[1:-1, 1] + rows[:-2, 1]), atol=2e-3
    )


def test_the_lift_starts_and_ends_at_rest_and_peaks_in_the_middle():
    phases = np.linspace(0.0, 1.0, 201)
    heights = np.array([lift_profile(p) for p in phases.tolist()])
    assert heights[0] == heights[-1] == 0.0
    assert heights.max() == heights[100] == 1.0
    assert abs(heights[1] / 0.005) < 0.01
    assert abs(heights[-2] / 0.005) < 0.01


def test_a_foot_on_the_floor_comes_down_to_it_and_stays():
    feet = np.zeros((2, WIDTH))
    feet[:] = 0.1
    before = feet.copy()
    swing_foot_kernel.advance(feet, 0.5, -1, (9.0, 9.0, 9.0), 4, (0.03, 0.5), CONTROL_PERIOD)
    assert feet[:, HEIGHT].tolist() == [0.05, 0.05]
    feet[:, HEIGHT] = before[:, HEIGHT]
    np.testing.assert_array_equal(feet, before)
