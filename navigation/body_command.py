"""From a direction and a speed in W to a velocity of the body in R."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from navigation.angles import wrap_array
from navigation.decision import SpeedLimits

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
    error = np.asarray(course) - np.asarray(heading)
    forward = np.asarray(speed) * np.cos(error)
    left = np.asarray(speed) * np.sin(error)
    reach = np.where(forward >= 0.0, limits.forward, limits.backward)
    excess = np.maximum(np.abs(forward) / reach, np.abs(left) / limits.lateral)
    scale = 1.0 / np.maximum(1.0, excess)
    turn = np.clip(
        turn_gain * wrap_array(np.asarray(facing) - np.asarray(heading)), -limits.turn, limits.turn
    )
    return np.stack(np.broadcast_arrays(scale * forward, scale * left, turn), axis=-1)


def idle_velocity(searching: bool, turn: float, limits: SpeedLimits) -> Array:
    """Velocity of the body that has nowhere to go (3,) [m/s, m/s, rad/s].

    Args:
        searching: lost, it turns on the spot, for the head does not reach all around and what
            it faces may show it no beacon; else it stands.
        turn: that turn rate [rad/s].
        limits: envelope.
    """
    return np.array([0.0, 0.0, min(turn, limits.turn) if searching else 0.0])
