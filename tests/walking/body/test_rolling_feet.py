"""Contact points of feet that roll."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from walking.observer import RollingFeet

angles = st.tuples(*[st.floats(-0.5, 0.5)] * 3)
FLAT = np.stack([np.eye(3)] * 2)
DOWN = np.array([[0.0, 0.1, -0.5], [0.0, -0.1, -0.5]])
HEEL = np.array([[-0.05, 0.01], [-0.05, -0.01]])
ON = [True, True]


def rolled_over(pressure, rotation):
    """Positions of feet (2, 3) that turn about their contact points from `DOWN`."""
    arms = np.column_stack([pressure, np.zeros(2)])
    return DOWN + arms - arms @ rotation.T


@given(angles, st.floats(-3.0, 3.0))
def test_the_contact_point_of_a_foot_that_rolls_does_not_move(turn, yaw):
    rotation = Rotation.from_rotvec(turn).as_matrix()
    feet = RollingFeet()
    feet.update(DOWN, FLAT, HEEL, yaw, ON)
    feet.update(rolled_over(HEEL, rotation), np.stack([rotation] * 2), HEEL, yaw, ON)
    assert feet.motion == pytest.approx(np.zeros((2, 3)), abs=1e-12)
    assert feet.contact == pytest.approx(DOWN + np.column_stack([HEEL, np.zeros(2)]))
    moved = rolled_over(HEEL, rotation) - DOWN
    assert feet.rolled == pytest.approx(-moved[:, :2], abs=1e-12)


@given(angles, st.floats(-3.0, 3.0))
def test_a_flat_foot_moves_against_the_body(motion, yaw):
    feet = RollingFeet()
    feet.update(DOWN, FLAT, HEEL, yaw, ON)
    feet.update(DOWN - motion, FLAT, HEEL, yaw, ON)
    expected = -Rotation.from_euler("z", yaw).apply(motion)
    assert feet.motion == pytest.approx(np.stack([expected] * 2))
    assert not feet.rolled.any()


def test_a_lifted_foot_forgets_how_it_rolled():
    tilted = np.stack([Rotation.from_euler("y", 0.3).as_matrix()] * 2)
    feet = RollingFeet()
    feet.update(DOWN, FLAT, HEEL, 0.0, ON)
    feet.update(DOWN, tilted, HEEL, 0.0, [True, False])
    assert feet.rolled[0].any()
    assert not feet.rolled[1].any()
