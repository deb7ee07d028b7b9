"""Published state: camera on a tilted body, and the plan in the odometry frame."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from walking.body.joints import HEAD
from walking.body.measurement import BodyMeasurement, FootMeasurement
from walking.body.odometry import Odometry
from walking.foothold import Foothold
from walking.footsteps.planner import FootstepPlanner
from walking.gait.gait import Gait
from walking.gait.swing_foot_kernel import HEIGHT
from walking.parameters import WalkingParameters
from walking.pattern.pendulum import PendulumState
from walking.pattern.support import SupportPolygon
from walking.published_state import camera_pose, published_plan

PARAMETERS = WalkingParameters()
LEFT = FootMeasurement(0.01, 0.042, -0.22, 0.1)
RIGHT = FootMeasurement(-0.01, -0.042, -0.21, -0.05)
BODY = BodyMeasurement(0.0, 0.0, (LEFT, RIGHT), (0.012, 0.003, 0.02), 0.0)
ORIGIN = Odometry(0.0, 0.0, 0.0, np.zeros((3, 3)))


@pytest.fixture
def looking(ideal_body):
    frame = ideal_body.sense()
    joints, rates = frame.joint_position.copy(), frame.joint_velocity.copy()
    joints[HEAD], rates[HEAD] = (0.4, -0.3), (1.0, -2.0)
    return replace(frame, joint_position=joints, joint_velocity=rates)


def test_the_camera_of_a_level_body_is_as_high_above_its_foot_as_the_leg_says(robot, looking):
    R_BC, p_BC = robot.neck.camera_pose(looking.joint_position)
    head = camera_pose(robot, looking, BODY)
    np.testing.assert_array_equal(head.rotation, R_BC)
    assert head.position == pytest.approx(p_BC - [0.0, 0.0, LEFT.z])
    assert (head.pan, head.tilt, head.pan_rate, head.tilt_rate) == (0.4, -0.3, 1.0, -2.0)


@pytest.mark.parametrize("load", [0.0, 0.3, 1.0])
def test_the_height_is_that_above_the_foot_that_carries(robot, looking, load):
    one = camera_pose(robot, looking, BODY).position
    other = camera_pose(robot, looking, replace(BODY, right_load=load)).position
    assert other - one == pytest.approx([0.0, 0.0, load * (LEFT.z - RIGHT.z)])


@pytest.mark.parametrize(("roll", "pitch"), [(0.2, 0.0), (0.0, -0.3), (0.1, 0.2)])
def test_a_tilted_trunk_takes_the_camera_along(robot, looking, roll, pitch):
    R_BC, p_BC = robot.neck.camera_pose(looking.joint_position)
    tilted = Rotation.from_euler("xy", (roll, pitch)).as_matrix()
    head = camera_pose(robot, looking, replace(BODY, roll=roll, pitch=pitch))
    assert head.rotation == pytest.approx(tilted @ R_BC)
    assert head.position == pytest.approx(tilted @ p_BC - [0.0, 0.0, LEFT.z])


@pytest.fixture
def gait(robot):
    planner = FootstepPlanner(PARAMETERS.gait, PARAMETERS.limits, robot.sole)
    gait = Gait(
        PARAMETERS,
        planner,
        (Foothold(True, 0, 0.042, 0), Foothold(False, 0, -0.042, 0)),
        robot.sole,
    )
    gait.start(0)
    gait.plan(gait.landing, planner.strides((0.2, 0.0, 0.3), 0.34), moving=True)
    return gait


def published(robot, gait, odometry):
    return published_plan(
        gait,
        PendulumState(0.01, 0.005, 0.1, -0.2, 0.02, 0.01),
        BODY,
        odometry,
        error=(0.001, -0.002, 0.01, 0.02),
        omega=7.2,
        polygon=SupportPolygon(robot.sole, gait.support_feet),
        capture=(0.03, -0.01),
    )


def test_the_support_foot_is_first_and_where_odometry_sees_it(robot, gait):
    plan = published(robot, gait, ORIGIN)
    first = plan.footsteps[0]
    assert (first.x, first.y, first.yaw) == pytest.approx((LEFT.x, LEFT.y, LEFT.yaw))
    assert [foot.left for foot in plan.footsteps[:4]] == [True, False, True, False]
    assert plan.balance.feet[0, [0, 1, 3]] == pytest.approx((LEFT.x, LEFT.y, LEFT.yaw))
    assert plan.balance.feet[:, 2].tolist() == gait.feet[:, HEIGHT].tolist()
    assert plan.com == pytest.approx(BODY.com[:2])


def test_all_of_it_moves_with_the_odometry_frame(robot, gait):
    one = published(robot, gait, ORIGIN)
    other = published(robot, gait, Odometry(0.7, -1.2, 0.9, np.zeros((3, 3))))
    c, s = np.cos(0.9), np.sin(0.9)
    R, p = np.array([[c, -s], [s, c]]), np.array([0.7, -1.2])
    for a, b in (
        (one.zmp, other.zmp),
        (one.dcm, other.dcm),
        (one.com, other.com),
        (one.balance.com, other.balance.com),
        (one.balance.dcm, other.balance.dcm),
        (one.balance.support, other.balance.support),
        (one.balance.feet[:, :2], other.balance.feet[:, :2]),
        *(((a.x, a.y), (b.x, b.y)) for a, b in zip(one.footsteps, other.footsteps, strict=True)),
    ):
        assert b == pytest.approx(np.asarray(a) @ R.T + p)
    assert other.balance.capture == pytest.approx(R @ one.balance.capture)
    assert other.balance.zmp_depth == one.balance.zmp_depth
    assert [b.yaw - a.yaw for a, b in zip(one.footsteps, other.footsteps, strict=True)] == (
        pytest.approx([0.9] * len(one.footsteps))
    )


def test_points_keep_their_places_about_the_pendulum(robot, gait):
    plan = published(robot, gait, ORIGIN)
    c, s = np.cos(LEFT.yaw), np.sin(LEFT.yaw)  # the planned support foot has no yaw
    R = np.array([[c, -s], [s, c]])
    assert plan.zmp - plan.balance.com == pytest.approx(R @ [0.01, 0.005])
    assert plan.dcm - plan.balance.com == pytest.approx(R @ [0.1 / 7.2, -0.2 / 7.2])
    assert plan.balance.capture == pytest.approx(R @ [0.03, -0.01])
    assert len(plan.balance.support) == len(SupportPolygon(robot.sole, gait.support_feet).edges())


def test_the_measured_dcm_is_the_planned_one_and_its_error(robot, gait):
    plan = published(robot, gait, ORIGIN)
    apart = np.array([0.001 + 0.01 / 7.2, -0.002 + 0.02 / 7.2])
    assert np.hypot(*(plan.balance.dcm - plan.dcm)) == pytest.approx(np.hypot(*apart))
