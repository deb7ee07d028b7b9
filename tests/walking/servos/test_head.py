"""Rate and acceleration of the head."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from walking.command import HeadTarget
from walking.parameters import CONTROL_PERIOD, HeadParameters
from walking.servos.head import Head

LIMITS = ((-1.57, 1.57), (-1.05, 0.35))
PARAMETERS = HeadParameters(max_rate=6.0, max_acceleration=60.0)


def follow(targets):
    head = Head(np.zeros(2), np.array(LIMITS), PARAMETERS)
    return np.array([(0.0, 0.0), *(head.advance(target) for target in targets)])


@given(
    st.lists(
        st.tuples(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0), st.integers(1, 60)),
        min_size=1,
        max_size=8,
    )
)
def test_limits_hold_for_any_targets(moves):
    path = follow([HeadTarget(pan, tilt) for pan, tilt, n in moves for _ in range(n)])
    rates = np.diff(path, axis=0) / CONTROL_PERIOD
    changes = np.diff(np.vstack([np.zeros(2), rates]), axis=0) / CONTROL_PERIOD
    assert np.abs(rates).max() <= PARAMETERS.max_rate + 1e-9
    assert np.abs(changes).max() <= PARAMETERS.max_acceleration + 1e-6
    assert np.abs(path[:, 0]).max() <= 1.58
    assert path[:, 1].max() <= 0.36


def test_a_saccade_arrives_without_overshoot_in_minimum_time():
    path = follow([HeadTarget(1.2, -0.4)] * 80)
    assert path[-1] == pytest.approx((1.2, -0.4), abs=1e-9)
    assert path[:, 0].max() <= 1.2 + 1e-9
    # Trapezoid: distance / rate + rate / acceleration.
    arrival = np.argmax(path[:, 0] > 1.2 - 1e-3) * CONTROL_PERIOD
    assert arrival == pytest.approx(1.2 / 6.0 + 6.0 / 60.0, abs=0.02)


def test_left_and_right_mirror():
    left = follow([HeadTarget(0.7, 0.1)] * 30)
    right = follow([HeadTarget(-0.7, 0.1)] * 30)
    np.testing.assert_allclose(left[:, 0], -right[:, 0])
