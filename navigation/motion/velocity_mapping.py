"""Velocity mapping from direction and speed in W to a body velocity in R, and its heading."""

from math import hypot

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap
from navigation.decision import SpeedLimits, Task
from navigation.motion import rollout
from navigation.parameters.navigation import NavigationParameters

Array = NDArray[np.float64]


def body_velocity(
    course: float,
    speed: float,
    heading: float,
    facing: float,
    *,
    limits: SpeedLimits,
    turn_gain: float,
) -> Array:
    """Return the velocity of a body that moves along `course` while it turns to `facing`.

    The velocity is scaled into the speed limits of the walking layer without changing its
    direction: the robot is slower sideways and backwards.

    Args:
        course: direction of motion in W [rad].
        speed: speed along the course [m/s].
        heading: heading of the robot [rad].
        facing: target heading [rad].
        limits: speed limits of the walking layer.
        turn_gain: turn rate per heading error [1/s].

    Returns:
        vx, vy, wz (3,) [m/s, m/s, rad/s].
    """
    bounds = envelope(limits, turn_gain)
    return np.array(rollout.body_velocity(course - heading, speed, facing - heading, bounds))


def envelope(limits: SpeedLimits, turn_gain: float) -> rollout.Envelope:
    """Return the envelope of the kernels; `turn_gain` is the turn rate per heading error [1/s]."""
    return limits.vx, limits.vx_backward, limits.vy, limits.wz, turn_gain


def idle_velocity(searching: bool, turn_rate: float, limits: SpeedLimits) -> Array:
    """Return the velocity of a body without a destination, vx, vy, wz (3,) [m/s, m/s, rad/s].

    Args:
        searching: whether it turns on the spot to search for beacons, which the head alone may
            not reach.
        turn_rate: turn rate of the search [rad/s].
        limits: speed limits of the walking layer.
    """
    return np.array([0.0, 0.0, min(turn_rate, limits.wz) if searching else 0.0])


def target_heading(
    position: Array,
    task: Task,
    look: float | None,
    course: float,
    parameters: NavigationParameters,
) -> float | None:
    """Return the target heading of the body in W, None for the direction of motion [rad].

    Args:
        position: position of the robot in W (2,) [m].
        task: task of the mission.
        look: direction in W that the body turns to for a fixed camera, if any [rad].
        course: direction of motion in W [rad].
        parameters: profile.
    """
    if arriving(position, task, parameters.univector.holonomic_distance):
        return task.heading
    return None if look is None else towards(look, course, parameters.gaze.max_pan)


def towards(direction: float, course: float, most: float) -> float:
    """Return the heading nearest to a direction in W, at most `most` from the course [rad]."""
    return course + min(max(wrap(direction - course), -most), most)


def arriving(position: Array, task: Task, distance: float) -> bool:
    """Whether the body turns to the heading of `task`: at the goal or within `distance` [m]."""
    dx, dy = (task.target - position).tolist()
    return task.aligning or (task.is_goal and hypot(dx, dy) < distance)
