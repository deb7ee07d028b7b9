"""Timing of capture steps."""

from math import exp

import numpy as np
import pytest

from walking.balance.step_timing import capture_time
from walking.parameters import CONTROL_PERIOD
from walking.pattern.lipm import Lipm

LIPM = Lipm(0.19)
OMEGA = LIPM.omega


def landing_error(time, planned, off, ahead):
    """How far the DCM is from where it was due, the pendulum stepped tick by tick."""
    x, v = 0.0, (ahead + off) * OMEGA
    for _ in range(round(time / CONTROL_PERIOD)):
        x, v = LIPM.step(x, v, 0.0)
    return x + v / OMEGA - ahead * exp(OMEGA * planned)


@pytest.mark.parametrize("ahead", [-0.02, 0.0, 0.015])
@pytest.mark.parametrize(("off", "reach"), [(0.06, 0.15), (-0.05, -0.12), (0.07, 0.05)])
def test_capture_time_is_the_latest_sufficient_tick(off, ahead, reach):
    planned = 0.34
    ticks = [
        k
        for k in range(round(planned / CONTROL_PERIOD) + 1)
        if np.sign(off) * landing_error(k * CONTROL_PERIOD, planned, off, ahead) <= abs(reach)
    ]
    time = capture_time(OMEGA, planned, off, ahead, reach)
    assert int(time / CONTROL_PERIOD + 1e-6) == max(ticks, default=0)


def test_a_landing_in_reach_keeps_its_time():
    assert capture_time(OMEGA, 0.3, 0.01, 0.005, 0.2) == 0.3
    assert capture_time(OMEGA, 0.3, 0.0, -0.02, 0.0) == 0.3


def test_no_time_is_short_enough_for_a_fall_over_the_edge_that_the_landing_cannot_follow():
    assert capture_time(OMEGA, 0.3, 0.05, -0.02, 0.01) == 0.0
    assert capture_time(OMEGA, 0.3, 0.05, 0.0, -0.01) == 0.0


def test_it_stays_the_same_instant_while_the_fall_goes_on():
    off, ahead, reach, planned = 0.06, 0.005, 0.12, 0.3
    time = capture_time(OMEGA, planned, off, ahead, reach)
    growth = exp(OMEGA * 0.05)
    later = capture_time(OMEGA, planned - 0.05, off * growth, ahead * growth, reach)
    assert later == pytest.approx(time - 0.05)
