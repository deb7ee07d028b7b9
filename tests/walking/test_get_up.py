"""Getting up: lying side, key postures and the way between them, attempts."""

from math import cos, pi, sin

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from walking.get_up import GetUp, Lying, Outcome, PostureTrack, RestDetector, lying_on, up_in_trunk
from walking.get_up_motions import MOTIONS, STRAIGHT
from walking.parameters import CONTROL_PERIOD, GetUpParameters
from walking.state import BodySensors

PARAMETERS = GetUpParameters(enabled=True)


def felt(pitch=0.0, roll=0.0, gyro=(0.0, 0.0, 0.0)):
    quaternion = np.array([cos(0.5 * pitch), 0.0, sin(0.5 * pitch), 0.0])
    if roll:
        quaternion = np.array([cos(0.5 * roll), sin(0.5 * roll), 0.0, 0.0])
    return BodySensors(
        joint_position=np.zeros(26),
        joint_velocity=np.zeros(26),
        gyro=np.array(gyro),
        accelerometer=np.array([0.0, 0.0, 9.81]),
        orientation=quaternion,
        foot_force=np.zeros((2, 4)),
    )


FRONT, BACK, UPRIGHT = felt(0.5 * pi), felt(-0.5 * pi), felt()
LEFT, RIGHT = felt(roll=-0.5 * pi), felt(roll=0.5 * pi)


def follow(get_up, sensors, seconds=60.0):
    rows = []
    for _ in range(round(seconds / CONTROL_PERIOD)):
        rows.append(get_up.step(sensors).position)
        if get_up.outcome is not Outcome.UNDER_WAY:
            break
    return np.array(rows)


@pytest.fixture
def get_up(robot):
    return GetUp(robot, PARAMETERS, robot.ready)


def reached(rows, posture):
    return np.abs(rows - np.array(posture.angles())).max(axis=1).min() < 1e-9


def test_on_its_front_it_pushes_itself_up(get_up):
    rows = follow(get_up, FRONT, 4.0)
    assert all(reached(rows, posture) for posture in MOTIONS.rise[:3])
    assert not reached(rows, MOTIONS.roll[0])


def test_on_its_back_it_turns_over(get_up):
    rows = follow(get_up, BACK, 5.0)
    assert all(reached(rows, posture.mirrored()) for posture in MOTIONS.roll)


def test_the_other_side_is_the_mirror_image(robot, mirrored_joints):
    left, right = (
        follow(GetUp(robot, PARAMETERS, robot.ready), side, 4.0) for side in (LEFT, RIGHT)
    )
    assert right == pytest.approx(mirrored_joints(left))


def test_it_waits_until_it_lies_still(get_up):
    rows = follow(get_up, felt(0.5 * pi, gyro=(0.0, 2.0, 0.0)), 2.0)
    assert get_up.attempts == 0
    assert rows[-1] == pytest.approx(STRAIGHT.angles())


def test_what_does_not_raise_the_trunk_is_tried_again_and_then_given_up(get_up):
    follow(get_up, FRONT)
    assert get_up.outcome is Outcome.GAVE_UP
    assert get_up.attempts == PARAMETERS.max_attempts


def test_it_stands_in_the_ready_posture_once_all_has_gone_well(robot, get_up):
    wanted = {p.name: 0.5 * sum(p.pitch) for p in MOTIONS.rise if p.pitch is not None}
    rows = []
    while get_up.outcome is Outcome.UNDER_WAY and len(rows) < 4000:
        pitch = 0.5 * pi if get_up.attempts == 0 else wanted.get(get_up.doing, 1.3)
        rows.append(get_up.step(UPRIGHT if get_up.doing == "stand" else felt(pitch)).position)
    assert get_up.outcome is Outcome.UP
    assert get_up.attempts == 1
    assert rows[-1] == pytest.approx(robot.ready)


POSTURES = (*MOTIONS.rise, *MOTIONS.roll, STRAIGHT)


@pytest.mark.parametrize("posture", POSTURES, ids=lambda p: p.name)
def test_every_posture_is_within_the_joints_limits(robot, posture):
    angles = np.array(posture.angles())
    assert (angles >= robot.lower).all()
    assert (angles <= robot.upper).all()


SPEED = 8.0


@settings(max_examples=20)
@given(st.integers(0, 2**32 - 1), st.floats(0.0, 2.0))
def test_set_points_keep_the_limits_of_angle_and_speed(robot, seed, time):
    rng = np.random.default_rng(seed)
    track = PostureTrack(robot, SPEED, robot.ready)
    before = track.angles
    for _ in range(3):
        track.aim(rng.uniform(-4.0, 4.0, 26), time)
        for _ in range(rng.integers(1, 200)):
            angles = track.advance()
            assert (angles > robot.lower - 1e-12).all()
            assert (angles < robot.upper + 1e-12).all()
            assert np.abs(angles - before).max() <= SPEED * CONTROL_PERIOD * (1.0 + 1e-9)
            before = angles


def test_it_arrives_in_time_and_holds(robot):
    goal = 0.5 * (robot.ready + np.clip(np.zeros(26), robot.lower, robot.upper))
    track = PostureTrack(robot, SPEED, robot.ready)
    track.aim(goal, 0.5, 0.1)
    path = []
    while not track.done:
        path.append(track.advance())
    assert len(path) == 120
    assert path[99] == pytest.approx(goal)
    assert path[-1] == pytest.approx(goal)


ANGLE = st.floats(-pi, pi)


def quaternion(yaw, pitch, roll):
    x, y, z, w = Rotation.from_euler("ZYX", [yaw, pitch, roll]).as_quat().tolist()
    return w, x, y, z


@given(ANGLE, st.floats(-1.5, 1.5), ANGLE)
def test_the_vertical_is_the_one_that_the_rotation_gives(yaw, pitch, roll):
    expected = Rotation.from_euler("ZYX", [yaw, pitch, roll]).inv().apply([0.0, 0.0, 1.0])
    assert up_in_trunk(quaternion(yaw, pitch, roll)) == pytest.approx(expected, abs=1e-12)


@given(ANGLE, st.floats(-0.6, 0.6))
def test_the_lying_side_is_independent_of_the_heading(yaw, tilt):
    right = 0.5 * pi
    for side, pitch, roll in (
        (Lying.FRONT, right + tilt, 0.0),
        (Lying.BACK, tilt - right, 0.0),
        (Lying.LEFT, tilt, -right),
        (Lying.RIGHT, tilt, right),
    ):
        assert lying_on(up_in_trunk(quaternion(yaw, pitch, roll))) is side


def test_rest_needs_its_duration_and_restarts_after_a_jolt():
    parameters = GetUpParameters(rest_rate=0.3, rest_time=0.05)
    rest = RestDetector(parameters)
    slow, fast = (0.2, -0.2, 0.1), (0.0, 0.0, -0.4)
    assert [rest.update(slow) for _ in range(11)] == [False] * 9 + [True] * 2
    assert not rest.update(fast)
    assert [rest.update(slow) for _ in range(10)] == [False] * 9 + [True]
