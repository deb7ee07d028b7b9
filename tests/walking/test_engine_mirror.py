"""Mirrored sensors and commands give mirrored joint targets."""

from dataclasses import replace

import numpy as np
import pytest

from walking.body.tree import LEFT_LEG, RIGHT_LEG
from walking.command import CommandState, HeadTarget, VelocityCommand
from walking.engine import WalkingEngine
from walking.parameters import WalkingParameters

GENERATORS = ["preview", "mwpg"]
HEAD, LEFT_ARM, RIGHT_ARM = slice(12, 14), slice(14, 20), slice(20, 26)  # of HSR-VIII
LEG, ARM = np.array([-1, -1, 1, 1, 1, -1]), np.array([1, -1, -1, 1, -1, -1])
ALONG = np.array([1.0, -1.0, 1.0])  # a vector mirrored at the sagittal plane
ABOUT = np.array([-1.0, 1.0, -1.0])  # an axial vector


def joints(values):
    other = values.copy()
    other[HEAD] = values[HEAD] * [-1, 1]  # pan, tilt
    for left, right, sign in ((LEFT_LEG, RIGHT_LEG, LEG), (LEFT_ARM, RIGHT_ARM, ARM)):
        other[right], other[left] = values[left] * sign, values[right] * sign
    return other


def sensors(frame):
    w, x, y, z = frame.orientation
    return replace(
        frame,
        joint_position=joints(frame.joint_position),
        joint_velocity=joints(frame.joint_velocity),
        gyro=frame.gyro * ABOUT,
        accelerometer=frame.accelerometer * ALONG,
        orientation=np.array([w, -x, y, -z]),
        # Front left, front right, back left, back right of either foot.
        foot_force=frame.foot_force[::-1][:, [1, 0, 3, 2]],
    )


def mirrored(command):
    if isinstance(command, VelocityCommand):
        return VelocityCommand(command.vx, -command.vy, -command.wz)
    return replace(command, direction=-command.direction)


def commands(rng, ticks):
    """Velocities, then command states, then a stop, new every few ticks."""
    for k in range(ticks):
        if k % 7 == 0:
            drawn = rng.uniform(-1.0, 1.0, 3).tolist()
        if k < ticks // 2:
            yield VelocityCommand(0.3 * drawn[0], 0.1 * drawn[1], 0.8 * drawn[2])
        elif k < 5 * ticks // 6:
            yield CommandState(0.27 + 0.05 * drawn[0], 0.07, 0.05 * drawn[1], 0.09, 0.2 * drawn[2])
        else:
            yield VelocityCommand()


def noisy(frame, rng):
    """A body that is pushed a little in every direction."""
    lean = (0.2 if rng.uniform() < 0.2 else 0.004) * rng.standard_normal(2)
    return replace(
        frame,
        gyro=frame.gyro + 0.03 * rng.standard_normal(3),
        orientation=frame.orientation + np.array([0.0, *lean, 0.0]),
    )


@pytest.mark.parametrize("generator", GENERATORS)
def test_the_mirrored_walk_is_the_walk_mirrored(robot, ideal_body, generator):
    pattern = replace(WalkingParameters().pattern, generator=generator)
    parameters = replace(WalkingParameters(), pattern=pattern)
    one, other = WalkingEngine(robot, parameters), WalkingEngine(robot, parameters)
    rng, apart, caught = np.random.default_rng(4), 0.0, 0.0
    for command in commands(np.random.default_rng(3), 600):
        frame = noisy(ideal_body.sense(), rng)
        a = one.step(frame, command, HeadTarget(0.5, -0.2))
        b = other.step(sensors(frame), mirrored(command), HeadTarget(-0.5, -0.2))
        ideal_body.apply(a)
        caught = max(caught, np.hypot(*one.state().balance.capture))
        apart = max(
            apart,
            np.abs(joints(a.position) - b.position).max(),
            np.abs(joints(a.setpoint) - b.setpoint).max(),
        )
    assert one.state().step_count > 5
    assert caught > 0.02
    # The odometry of both starts on the left foot, so the noise shifts the two bodies differently.
    assert apart < 1e-4
