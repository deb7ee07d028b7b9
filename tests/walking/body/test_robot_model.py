"""Dynamics, ready posture and measures of a robot."""

import numpy as np
import pytest

from walking.body.tree import LEFT_LEG, RIGHT_LEG


@pytest.mark.parametrize("height", [0.19, 0.204, 0.22])
def test_the_feet_of_a_standing_robot_are_level_below_its_mass(robot, height):
    before = robot.ready.copy()
    assert robot.stand(height, 0.042) < 1e-9
    ahead = robot.com(robot.ready)[0] - robot.sole.centre
    for leg, part in zip(robot.legs, (LEFT_LEG, RIGHT_LEG), strict=True):
        foot = leg.pose(robot.ready[part])
        assert (foot.roll, foot.pitch, foot.yaw) == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)
        assert foot.z == pytest.approx(leg.hip[2] - height, abs=1e-9)
        assert foot.x == pytest.approx(ahead, abs=1e-5)
    robot.ready[:] = before


def test_torque_at_rest_is_the_gradient_of_the_potential_energy(robot):
    q, rest = robot.ready, np.zeros(len(robot.names))
    torque, wrench = robot.inverse_dynamics(q, rest, rest, (0.0, 0.0))
    assert wrench[2] == pytest.approx(robot.mass * 9.81)
    for joint in range(len(robot.names)):
        step = np.zeros_like(q)
        step[joint] = 1e-6
        rise = robot.com(q + step)[2] - robot.com(q - step)[2]
        assert torque[joint] == pytest.approx(robot.mass * 9.81 * rise / 2e-6, abs=1e-5)


def test_the_centre_of_mass_is_that_of_the_motion(robot):
    q = robot.ready + 0.1 * np.sin(np.arange(float(len(robot.names))))
    robot.inverse_dynamics(q, 0.5 * q, q, (0.3, 0.1))
    assert robot.dynamics.moved_com() == pytest.approx(robot.com(q), abs=1e-12)
