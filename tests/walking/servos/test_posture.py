"""Joint angles from pelvis and feet."""

import numpy as np
import pytest

from walking.body.joints import HEAD, LEFT_ARM, LEFT_LEG, RIGHT_ARM, RIGHT_LEG
from walking.foothold import Foothold
from walking.footsteps.planner import FootstepPlanner
from walking.gait.gait import Gait
from walking.parameters import WalkingParameters
from walking.servos.posture import Posture

PARAMETERS = WalkingParameters()


@pytest.fixture
def gait(robot):
    planner = FootstepPlanner(PARAMETERS.gait, PARAMETERS.limits, robot.sole)
    stance = (Foothold(True, 0.01, 0.045, 0.15), Foothold(False, -0.01, -0.04, -0.05))
    return Gait(PARAMETERS, planner, stance, robot.sole)


def test_feet_are_where_the_plan_has_them(robot, gait):
    q, pelvis = Posture(robot, PARAMETERS).joints(gait, (0.005, 0.01), (0.0, 0.0), (0.3, -0.2))
    px, py, yaw = pelvis
    assert yaw == pytest.approx(0.05)
    c, s = np.cos(yaw), np.sin(yaw)
    for leg, part, foot in zip(robot.legs, (LEFT_LEG, RIGHT_LEG), gait.footholds, strict=True):
        pose = leg.pose(q[part])
        x = px + c * pose.x - s * pose.y
        y = py + s * pose.x + c * pose.y
        assert (x, y, pose.yaw + yaw) == pytest.approx((foot.x, foot.y, foot.yaw))
        assert pose.z == pytest.approx(-PARAMETERS.pattern.pelvis_height)
        assert (pose.roll, pose.pitch) == pytest.approx((0.0, 0.0), abs=1e-9)
    assert q[HEAD].tolist() == [0.3, -0.2]


def test_pendulum_stands_over_the_centre_of_mass_of_the_ready_posture(robot, gait):
    com = robot.com(robot.ready)
    posture, (c, s) = Posture(robot, PARAMETERS), (np.cos(0.05), np.sin(0.05))
    at = (c * com[0] - s * com[1], s * com[0] + c * com[1])
    pelvis = posture.pelvis(gait, at)
    assert pelvis[:2] == pytest.approx((0.0, 0.0), abs=1e-9)
    assert posture.joints(gait, at, (0.0, 0.0), (0.0, 0.0))[1] == pelvis


def test_a_foot_on_the_floor_ignores_the_tilt(robot, gait):
    posture, com = Posture(robot, PARAMETERS), (0.0, 0.0)
    level = posture.joints(gait, com, (0.0, 0.0), (0.0, 0.0))[0]
    tilted = posture.joints(gait, com, (0.2, 0.2), (0.0, 0.0))[0]
    np.testing.assert_array_equal(tilted, level)


def test_a_foot_in_the_air_stays_level_under_a_tilted_trunk(robot, gait):
    posture, com = Posture(robot, PARAMETERS), (0.0, 0.0)
    gait.start(0)
    while gait.swing_phase < 0.5:
        gait.advance(moving=True)
    for _ in range(30):
        angles = posture.joints(gait, com, (0.0, 0.15), (0.0, 0.0))[0][RIGHT_LEG]
    wanted = PARAMETERS.stabilizer.tilt_gain * (0.15 - PARAMETERS.stabilizer.tilt_dead_zone)
    assert robot.legs[1].pose(angles).pitch == pytest.approx(-wanted, abs=5e-3)


@pytest.mark.parametrize(("apart", "swing"), [(0.05, 0.1), (-0.05, -0.1), (0.5, 0.35)])
def test_the_arms_swing_against_the_feet_within_limits(robot, gait, apart, swing):
    gait.feet[0, :3], gait.feet[1, :3] = (0.5 * apart, 0.04, 0.0), (-0.5 * apart, -0.04, 0.0)
    q = Posture(robot, PARAMETERS).joints(gait, (0.0, 0.0), (0.0, 0.0), (0.0, 0.0))[0]
    shoulders = (
        q[[LEFT_ARM.start, RIGHT_ARM.start]] - robot.ready[[LEFT_ARM.start, RIGHT_ARM.start]]
    )
    assert shoulders == pytest.approx([swing, -swing])
