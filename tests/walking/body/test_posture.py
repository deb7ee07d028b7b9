"""Joint angles from pelvis and feet."""

import numpy as np
import pytest

from walking.body.posture import pelvis_over, set_posture
from walking.body.tree import LEFT_LEG, RIGHT_LEG
from walking.constants import joint_records
from walking.parameters import WalkingParameters
from walking.plan.footsteps import Foothold
from walking.plan.gait import advance, phase_of, start

PARAMETERS = WalkingParameters()
NONE = (0.0, 0.0)


class Body:
    """Body over two feet that are not parallel."""

    def __init__(self, robot, model, make_walk):
        feet = (Foothold(True, 0.01, 0.045, 0.15), Foothold(False, -0.01, -0.04, -0.05))
        self.feet, self.robot, self.model = feet, robot, model
        self.walk = make_walk(feet)
        self.gait, self.limbs = self.walk.plan.gait, self.walk.limbs
        self.limbs.leg_angles = robot.ready[:12]
        self.joints = joint_records(robot, PARAMETERS)

    def posture(self, com=NONE, tilt=NONE, head=NONE):
        """Joint angles (n,) and pelvis x, y, heading."""
        q, walk, model = np.empty(self.robot.ready.size), self.walk, self.model
        walk.body.roll, walk.body.pitch = tilt
        set_posture(q, walk, com, head, self.joints, model.robot)
        return q, self.limbs.pelvis.item()


@pytest.fixture
def body(robot, model, make_walk):
    return Body(robot, model, make_walk)


def test_feet_are_at_their_planned_poses(robot, body):
    q, (px, py, yaw) = body.posture((0.005, 0.01), head=(0.3, -0.2))
    assert yaw == pytest.approx(0.05)
    c, s = np.cos(yaw), np.sin(yaw)
    for leg, part, foot in zip(robot.legs, (LEFT_LEG, RIGHT_LEG), body.feet, strict=True):
        pose = leg.pose(q[part])
        x, y = px + c * pose.x - s * pose.y, py + s * pose.x + c * pose.y
        assert (x, y, pose.yaw + yaw) == pytest.approx((foot.x, foot.y, foot.yaw))
        assert pose.z == pytest.approx(-PARAMETERS.pattern.pelvis_height)
        assert (pose.roll, pose.pitch) == pytest.approx((0.0, 0.0), abs=1e-9)
    assert q[list(robot.tree.head)].tolist() == [0.3, -0.2]
    assert body.limbs.leg_error < 1e-9


def test_the_pendulum_is_at_the_centre_of_mass_of_the_ready_posture(robot, model, body):
    com, (c, s) = robot.com(robot.ready), (np.cos(0.05), np.sin(0.05))
    place = (c * com[0] - s * com[1], s * com[0] + c * com[1])
    pelvis = pelvis_over(body.limbs.feet, place, float(model.robot.com_ahead))
    assert pelvis[:2] == pytest.approx((0.0, 0.0), abs=1e-9)
    assert body.posture(place)[1] == pelvis


def test_a_foot_on_the_floor_ignores_the_tilt(body):
    level = body.posture()[0]
    np.testing.assert_array_equal(body.posture(tilt=(0.2, 0.2))[0], level)


def test_a_foot_in_the_air_stays_level_under_a_tilted_trunk(robot, model, body):
    gait = body.gait
    start(gait, 0, False, model.robot)
    while phase_of(gait).swing < 0.5:
        advance(body.walk.plan, body.limbs.feet, model.robot)
    for _ in range(30):
        angles = body.posture(tilt=(0.0, 0.15))[0][RIGHT_LEG]
    stabilizer = PARAMETERS.stabilizer
    wanted = stabilizer.tilt_gain * (0.15 - stabilizer.tilt_dead_zone)
    assert robot.legs[1].pose(angles).pitch == pytest.approx(-wanted, abs=5e-3)


@pytest.mark.parametrize(("apart", "swing"), [(0.05, 0.1), (-0.05, -0.1), (0.5, 0.35)])
def test_the_arms_swing_against_the_feet_within_limits(robot, body, apart, swing):
    feet = body.limbs.feet
    feet["x"], feet["y"], feet["yaw"] = (0.5 * apart, -0.5 * apart), (0.04, -0.04), 0.0
    assert (body.posture()[0] - robot.ready)[list(robot.tree.shoulders)] == pytest.approx(
        [swing, -swing]
    )
