"""Fall recovery with a trunk attitude set by the test."""

from math import cos, pi, sin

import numpy as np
import pytest

from walking.get_up import GetUp, Outcome
from walking.get_up_motions import MOTIONS, STRAIGHT
from walking.parameters import CONTROL_PERIOD, GetUpParameters
from walking.signals import BodySensors

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


def test_on_its_left_side_it_goes_on_where_the_roll_has_come_to(get_up):
    rows = follow(get_up, LEFT, 4.0)
    assert not reached(rows, MOTIONS.roll[0])
    assert all(reached(rows, posture) for posture in MOTIONS.roll[MOTIONS.from_side :])


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
