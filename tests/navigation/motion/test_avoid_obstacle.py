from math import pi

import numpy as np
import pytest

from navigation.angles import wrap_array
from navigation.motion.avoid_obstacle import spiral_turn, turning_sign

D_E, K_R = 0.2, 0.3


def test_outward_then_tangential_then_inward():
    assert spiral_turn(0.0, 0.3, D_E, K_R) == pytest.approx(0.0)
    assert spiral_turn(D_E, 0.3, D_E, K_R) == pytest.approx(pi / 2)
    assert spiral_turn(1e9, 0.3, D_E, K_R) == pytest.approx(pi, abs=1e-6)
    assert spiral_turn(0.05, 0.3, 0.2, 0.3) == pytest.approx(0.5 * pi * 0.5)
    assert spiral_turn(0.7, 0.3, 0.2, 0.3) == pytest.approx(0.5 * pi * (2.0 - 0.8 / 1.3))


def test_the_spiral_is_continuous_and_grows():
    gaps = np.linspace(0.0, 3.0, 30001)
    turn = spiral_turn(gaps, 0.3, D_E, K_R)
    assert np.all(np.diff(turn) > 0.0)
    assert np.abs(np.diff(turn[gaps > 0.01])).max() < 1e-2


def test_inside_the_circle_the_spiral_is_outward():
    assert not spiral_turn([-0.3, -0.1, 0.0], 0.3, D_E, K_R).any()


def test_the_turn_is_the_shorter_one_to_the_destination():
    p_od, p_or = np.random.default_rng(1).normal(size=(2, 500, 2))
    turn = wrap_array(np.arctan2(*p_od.T[::-1]) - np.arctan2(*p_or.T[::-1]))
    assert np.array_equal(turning_sign(p_od, p_or), np.sign(turn))


def test_on_the_line_the_sign_is_minus():
    """Repair: the paper leaves the sign open where the cross product is zero."""
    ahead = np.array([1.0, 0.0])
    assert turning_sign(ahead, -ahead) == -1.0
    assert turning_sign(ahead, 0.5 * ahead) == -1.0
