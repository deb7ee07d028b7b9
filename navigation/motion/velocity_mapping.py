"""From a direction and a speed in W to a velocity of the body in R."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from navigation.decision import SpeedLimits
from navigation.motion import rollout_kernel

Array = NDArray[np.float64]


def body_velocity(
    course: ArrayLike,
    speed: ArrayLike,
    heading: ArrayLike,
    facing: ArrayLike,
    *,
    limits: SpeedLimits,
    turn_gain: float,
) -> Array:
    """Velocity of the body that moves along `course` while it turns to `facing`.

    The velocity is scaled into the envelope of the walking layer, so that its direction
    is kept: sideways and backwards the robot is slower.

    Args:
        course: direction of motion in W (...) [rad].
        speed: along it (...) [m/s].
        heading: of the robot (...) [rad].
        facing: heading to turn to (...) [rad].
        limits: envelope.
        turn_gain: turn rate per heading error [1/s].

    Returns:
        forward, left, turn (..., 3) [m/s, m/s, rad/s].
    """
    shapes = np.shape(course), np.shape(speed), np.shape(heading), np.shape(facing)
    asked = np.empty((4, *np.broadcast_shapes(*shapes)))
    asked[0], asked[1], asked[2], asked[3] = course, speed, heading, facing
    velocities = rollout_kernel.body_velocities(asked.reshape(4, -1), envelope(limits, turn_gain))
    return velocities.reshape(*asked.shape[1:], 3)


def envelope(limits: SpeedLimits, turn_gain: float) -> rollout_kernel.Envelope:
    """Envelope as the roll-outs want it; `turn_gain` is the turn rate per heading error [1/s]."""
    return limits.vx, limits.vx_backward, limits.vy, limits.wz, turn_gain


def idle_velocity(searching: bool, turn: float, limits: SpeedLimits) -> Array:
    """Velocity of the body that has nowhere to go (3,) [m/s, m/s, rad/s].

    Args:
        searching: lost, it turns on the spot, for the head does not reach all around and what
            it faces may show it no beacon; else it stands.
        turn: that turn rate [rad/s].
        limits: envelope.
    """
    return np.array([0.0, 0.0, min(turn, limits.wz) if searching else 0.0])
