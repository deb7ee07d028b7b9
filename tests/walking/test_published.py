"""Published state: camera on a tilted body, and the plan in the odometry frame."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from walking.body.tree import HEAD_JOINTS, JOINT_NAMES
from walking.command import VelocityCommand
from walking.data import Body, DeadReckoning
from walking.estimate.body import base_height
from walking.model import CAMERA
from walking.plan.footsteps import foothold
from walking.plan.gait import start
from walking.plan.reference import plan_walk
from walking.published import CameraRecord, Published, publish_camera, publish_plan, walking_state
from walking.state import Phase

HEAD = [JOINT_NAMES.index(name) for name in HEAD_JOINTS]
FEET = ((0.01, 0.042, -0.22, 0.1), (-0.01, -0.042, -0.21, -0.05))  # x, y, z, yaw


def set_body(sensing, *, roll=0.0, pitch=0.0, right_load=0.0):
    for foot, (x, y, z, yaw) in zip(sensing.feet, FEET, strict=True):
        foot.x, foot.y, foot.z, foot.yaw = x, y, z, yaw
    sensing.roll, sensing.pitch, sensing.right_load = roll, pitch, right_load
    sensing.com_x, sensing.com_y, sensing.com_z = 0.012, 0.003, 0.02


@pytest.fixture
def look(robot, model):
    """Camera of a body that looks aside, and its pose in the base frame."""

    def published(**body):
        sensing, camera = np.zeros(1, Body)[0], np.zeros(1, CameraRecord)[0]
        set_body(sensing, **body)
        joints, rates = robot.ready.copy(), np.zeros_like(robot.ready)
        joints[HEAD], rates[HEAD] = (0.4, -0.3), (1.0, -2.0)
        R_BC, p_BC = robot.frame_pose(robot.tree.camera, joints)
        sensing.frames[CAMERA] = [*R_BC.ravel(), *p_BC]
        height, gyro = base_height(sensing), np.array([0.1, 0.2, 0.3])
        publish_camera(camera, sensing, height, rates, gyro, model.robot)
        return camera, R_BC, p_BC

    return published


def test_the_camera_of_a_level_body_is_at_the_height_of_the_leg(look):
    camera, R_BC, p_BC = look()
    np.testing.assert_array_equal(camera.rotation, R_BC)
    assert camera.position == pytest.approx(p_BC - [0.0, 0.0, FEET[0][2]])
    rates = (camera.pan_rate, camera.tilt_rate, camera.yaw_rate)
    assert (camera.pan, camera.tilt, *rates) == pytest.approx((0.4, -0.3, 1.0, -2.0, 0.3))


@pytest.mark.parametrize(("roll", "pitch"), [(0.2, 0.0), (0.0, -0.3), (0.1, 0.2)])
def test_a_tilted_trunk_tilts_the_camera(look, roll, pitch):
    camera, R_BC, p_BC = look(roll=roll, pitch=pitch)
    tilted = Rotation.from_euler("xy", (roll, pitch)).as_matrix()
    assert camera.rotation == pytest.approx(tilted @ R_BC)
    assert camera.position == pytest.approx(tilted @ p_BC - [0.0, 0.0, FEET[0][2]])
    assert camera.yaw_rate == pytest.approx(float(tilted[2] @ [0.1, 0.2, 0.3]))


def test_a_fixed_camera_turns_with_the_trunk_only(robot, model):
    fixed, sensing, camera = model.robot.copy(), np.zeros(1, Body)[0], np.zeros(1, CameraRecord)[0]
    fixed.neck.movable = False
    rates, gyro = np.ones_like(robot.ready), np.array([0.1, 0.2, 0.3])
    publish_camera(camera, sensing, 0.2, rates, gyro, fixed)
    assert (camera.pan_rate, camera.tilt_rate, camera.yaw_rate) == (0.0, 0.0, 0.3)


@pytest.fixture
def published(model, strides_of, make_walk):
    """State of a walk in its first double support, odometry at a pose."""
    walk = make_walk()
    plan = walk.plan
    start(plan.gait, 0, False, model.robot)
    landing, strides = foothold(plan.gait.landing), strides_of((0.2, 0.0, 0.3))
    plan_walk(plan, landing, strides, True, model.robot)
    p, error, placing = walk.pendulum, walk.error, walk.placing
    p.x, p.y, p.vx, p.vy, p.zmp_x, p.zmp_y = 0.01, 0.005, 0.1, -0.2, 0.02, 0.01
    set_body(walk.body)
    error.x, error.y, error.vx, error.vy = 0.001, -0.002, 0.01, 0.02
    placing.moved_x, placing.moved_y = 0.03, -0.01
    walk.unloading, walk.loading = plan.gait.footholds[1], plan.gait.footholds[0]

    def state(x=0.0, y=0.0, yaw=0.0):
        odometry = np.zeros(1, DeadReckoning)[0]
        odometry.x, odometry.y, odometry.yaw = x, y, yaw
        published = np.zeros(1, Published)
        publish_plan(published[0], walk, odometry, model.robot)
        return walking_state(published, VelocityCommand(0.2))

    return state


def test_the_support_foot_is_first_and_at_its_measured_pose(published):
    state = published()
    x, y, _, yaw = FEET[0]
    first = state.footsteps[0]
    assert (first.x, first.y, first.yaw) == pytest.approx((x, y, yaw))
    assert [foot.left for foot in state.footsteps] == [True, False, True, False, True]
    assert state.balance.feet[0] == pytest.approx((x, y, 0.0, yaw))
    assert state.com == pytest.approx((0.012, 0.003))
    assert state.phase is Phase.DOUBLE_SUPPORT
    assert len(state.balance.support) == 4  # the feet are parallel


def test_all_of_it_moves_with_the_odometry_frame(published):
    one, other = published(), published(0.7, -1.2, 0.9)
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
        *((a[1:3], b[1:3]) for a, b in zip(one.footsteps, other.footsteps, strict=True)),
    ):
        assert b == pytest.approx(np.asarray(a) @ R.T + p)
    assert other.balance.capture == pytest.approx(R @ one.balance.capture)
    turned = [b.yaw - a.yaw for a, b in zip(one.footsteps, other.footsteps, strict=True)]
    assert turned == pytest.approx([0.9] * len(turned))


def test_points_keep_their_places_about_the_pendulum(model, published):
    state, omega = published(), float(model.robot.omega)
    c, s = np.cos(FEET[0][3]), np.sin(FEET[0][3])  # the planned support foot has no yaw
    R = np.array([[c, -s], [s, c]])
    com = state.balance.com
    assert state.zmp - com == pytest.approx(R @ [0.01, 0.005])
    assert state.dcm - com == pytest.approx(R @ [0.1 / omega, -0.2 / omega])
    assert state.balance.capture == pytest.approx(R @ [0.03, -0.01])
    error = [0.001 + 0.01 / omega, -0.002 + 0.02 / omega]
    assert state.balance.dcm - state.dcm == pytest.approx(R @ error)
