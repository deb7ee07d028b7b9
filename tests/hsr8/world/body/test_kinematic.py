import mujoco
import numpy as np
import pytest

from hsr8.robots.loaded import load_robot
from hsr8.world.body.kinematic import KinematicBody, base_pose, imu_motion
from hsr8.world.field.layout import Obstacle
from hsr8.world.field.motion import Line
from hsr8.world.model.index import ModelIndex
from walking.command import HeadTarget, VelocityCommand
from walking.engine import WalkingEngine
from walking.parameters import WalkingParameters
from walking.state import JointTargets


@pytest.fixture(scope="module")
def robot_model():
    return load_robot("hsr8").model


def body_in(world, noise, *obstacles, seed=0, **details):
    layout, model = world(*obstacles, **details)
    return KinematicBody(model, load_robot("hsr8"), layout, noise, np.random.default_rng(seed))


def test_joints_follow_their_targets_and_the_stance_foot_stays(world, silent):
    body = body_in(world, silent)
    position = body.sense().joint_position.copy()
    foot = body.data.site("hsr8/l_foot").xpos.copy()
    for k in range(20):
        position[2] -= 0.001  # both hips bend: the trunk moves, the planted foot does not
        position[8] -= 0.001
        body.apply(JointTargets(position=position.copy(), setpoint=position + 0.3))
        assert np.allclose(body.sense().joint_position, position)
        body.update_kinematics()
        assert np.allclose(body.data.site("hsr8/l_foot").xpos[:2], foot[:2], atol=1e-9), k
        assert abs(body.data.site("hsr8/l_foot").xpos[2]) < 1e-9


def test_the_trunk_stays_upright_over_the_foot_in_contact_that_lies_flat(world, silent):
    """The foot that lifts next cannot keep its sole on the floor: its ankle is at a joint limit."""
    body = body_in(world, silent)
    position = body.sense().joint_position.copy()
    for ankle in (5, 11, 5):
        for change in (*(20 * [0.002]), *(20 * [-0.002])):
            position[ankle] += change
            body.apply(JointTargets(position.copy(), position.copy()))
            _, x, y, _ = body.truth().qpos[3:7]
            assert 2.0 * np.hypot(x, y) < 0.003


def test_a_robot_falls_when_its_joints_tip_it_over(world, silent):
    body = body_in(world, silent)
    position = body.sense().joint_position.copy()
    assert not body.truth().fallen
    for _ in range(200):
        position[[2, 8]] -= 0.01  # the hips bend forward over planted feet
        body.apply(JointTargets(position.copy(), position.copy()))
        _, x, y, _ = body.truth().qpos[3:7]
        tilt = np.degrees(np.arccos(1.0 - 2.0 * (x * x + y * y)))
        assert body.truth().fallen == (tilt > 60.0)
    assert body.truth().fallen


@pytest.mark.parametrize(
    ("command", "expected"),
    [
        (VelocityCommand(0.15, 0.0, 0.0), (0.15, 0.0, 0.0)),
        (VelocityCommand(0.0, 0.06, 0.0), (0.0, 0.06, 0.0)),
        (VelocityCommand(0.0, 0.0, 0.5), (0.0, 0.0, 0.5)),
    ],
)
def test_it_walks_at_the_commanded_velocity(world, silent, robot_model, command, expected):
    body = body_in(world, silent)
    walked = 3.4  # ten footsteps
    running = WalkingEngine(robot_model, WalkingParameters())
    poses = []
    for k in range(round((2.04 + walked) / 0.005)):
        body.apply(running.step(body.sense(), command, HeadTarget()))
        if k + 1 in (round(2.04 / 0.005), round((2.04 + walked) / 0.005)):
            poses.append(body.truth().robot)
    rate = (poses[1] - poses[0]) / walked
    assert np.allclose(rate, expected, atol=0.02)


def test_touching_an_obstacle_is_noticed_though_nothing_stops_it(world, silent, robot_model):
    body = body_in(world, silent, Obstacle((0.30, 0.0), 0.10, 0.3, "blue"))
    contacts = []
    engine = WalkingEngine(robot_model, WalkingParameters())
    for _ in range(500):
        body.apply(engine.step(body.sense(), VelocityCommand(0.15, 0.0, 0.0), HeadTarget()))
        contacts += body.truth().contacts
    assert {c.obstacle for c in contacts} == {0}
    assert not any(c.moving for c in contacts)
    assert any(c.closing for c in contacts)  # it walked into it
    assert body.truth().robot[0] > 0.2


def test_between_two_looks_for_contacts_movers_are_where_they_belong(world, silent):
    motion = Line((1.0, 0.0), (-0.5, 0.0))
    body = body_in(world, silent, Obstacle((1.0, 0.0), 0.10, 0.40, "blue", motion))
    position, gaps = body.sense().joint_position, []
    stands = JointTargets(position, position)
    for _ in range(8):
        body.apply(stands)
        gaps.append(body.truth().clearance)
        body.update_kinematics()
        assert body.data.mocap_pos[:, 0].min() == pytest.approx(motion.position(body.time)[0])
    assert np.allclose(np.diff(gaps), -0.5 * 0.005, atol=1e-5)


def _rotated(rng, size):
    """A unit quaternion, turned by up to `size` [rad]."""
    axis = rng.standard_normal(3)
    angle = rng.uniform(-size, size)
    return np.array([np.cos(angle / 2), *np.sin(angle / 2) * axis / np.linalg.norm(axis)])


@pytest.mark.parametrize("stance", [0, 1])
def test_the_sole_lies_flat_where_it_is_planted(world, stance):
    _, model = world()
    data, index = mujoco.MjData(model), ModelIndex.of(model, load_robot("hsr8"), 0, 0)
    rng, root = np.random.default_rng(stance), index.root_qpos
    sites = list(index.foot_sites)
    feet = model.site_bodyid[sites].astype(np.intp)
    soles = np.hstack([model.site_pos[sites], model.site_quat[sites]])
    for _ in range(20):
        data.qpos[:] = rng.uniform(-0.5, 0.5, model.nq)
        data.qpos[root : root + 7] = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
        mujoco.mj_kinematics(model, data)
        anchor, pose, other = rng.uniform(-2.0, 2.0, 3), np.empty(7), np.empty(4)
        base_pose(data.xpos, data.xquat, feet, soles, stance, anchor, pose, other)
        data.qpos[root : root + 7] = pose
        mujoco.mj_kinematics(model, data)
        positions, axes = data.site_xpos[sites], data.site_xmat[sites].reshape(2, 3, 3)
        c, s = np.cos(anchor[2]), np.sin(anchor[2])
        assert np.allclose(positions[stance], [*anchor[:2], 0.0], atol=1e-9)
        assert np.allclose(axes[stance], [[c, -s, 0], [s, c, 0], [0, 0, 1]], atol=1e-9)
        x_axis = axes[1 - stance][:, 0]
        expected = [
            *positions[1 - stance][:2],
            np.arctan2(x_axis[1], x_axis[0]),
            positions[1 - stance][2],
        ]
        assert np.allclose(other, expected, atol=1e-9)


def test_imu_motion_is_that_of_mujoco():
    rng = np.random.default_rng(0)
    for turn in (0.0, 1e-9, 0.01, 1.0, 3.0):
        step = _rotated(rng, turn)
        before = np.array([*rng.standard_normal(3), *_rotated(rng, 3.0)])
        after = before + 0.01
        mujoco.mju_mulQuat(after[3:], before[3:], step)
        expected, motion = np.empty(3), (np.empty(3), np.empty(3), np.empty(3))
        mujoco.mju_subQuat(expected, after[3:], before[3:])
        imu_motion(before, after, 0.005, *motion)
        assert np.allclose(motion[0], 0.01 / 0.005)
        assert np.allclose(motion[1], expected / 0.005, rtol=1e-6, atol=1e-8)
        rotation = np.empty(9)
        mujoco.mju_quat2Mat(rotation, after[3:])
        assert np.allclose(motion[2], rotation.reshape(3, 3).T @ (0.0, 0.0, 9.81))


def test_the_shorter_rotation_is_used():
    before, after = np.array([0.0, 0, 0, 1, 0, 0, 0]), np.array([0.0, 0, 0, -1, 0, 0, -1e-6])
    motion = np.empty(3), np.empty(3), np.empty(3)
    imu_motion(before, after, 1.0, *motion)
    assert motion[1] == pytest.approx((0.0, 0.0, 2e-6), rel=1e-6)
