import numpy as np
import pytest

from navigation.belief.imm_kernel import arc
from navigation.motion.bend_kernel import mean_velocity

VELOCITY = np.array([[0.1, 0.0], [0.03, -0.04], [0.0, 0.0]])


def test_what_goes_straight_keeps_its_velocity():
    assert np.array_equal(mean_velocity(VELOCITY, np.zeros(3), 3.0), VELOCITY)


@pytest.mark.parametrize("turn", [-1.3, 1e-5, 0.4])
def test_it_is_the_mean_over_the_time(turn):
    """Against the midpoint rule."""
    time, n = 2.5, 2000
    angles = turn * time * (np.arange(n) + 0.5) / n
    c, s = np.cos(angles).mean(), np.sin(angles).mean()
    wanted = VELOCITY @ np.array([[c, s], [-s, c]])
    assert mean_velocity(VELOCITY, np.full(3, turn), time) == pytest.approx(wanted, abs=1e-7)


def test_a_full_turn_leads_nowhere():
    assert mean_velocity(VELOCITY, np.full(3, np.pi), 2.0) == pytest.approx(np.zeros((3, 2)))


@pytest.mark.parametrize("turn", [-1.3, 0.0, 1e-4, 0.4])
def test_the_filters_of_the_tracks_follow_the_same_arc(turn):
    along, across, *_ = arc(turn, 2.5)
    wanted = VELOCITY @ np.array([[along, across], [-across, along]])
    assert mean_velocity(VELOCITY, np.full(3, turn), 2.5) == pytest.approx(wanted, abs=1e-12)


def test_compiled_and_plain_agree():
    turns = np.array([-1.3, 0.0, 1e-9])
    compiled, plain = (f(VELOCITY, turns, 2.5) for f in (mean_velocity, mean_velocity.py_func))
    assert np.array_equal(compiled, plain)
