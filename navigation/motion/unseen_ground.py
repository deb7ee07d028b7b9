"""Unseen ground: the robot walks fast only towards ground that it saw recently."""

from functools import cache

import numpy as np
from numpy.typing import NDArray

from navigation.belief.belief import Belief
from navigation.parameters.motion import UnseenGroundParameters
from navigation.transform import SE2

Array = NDArray[np.float64]


def ground_points(pose: Array, direction: float, parameters: UnseenGroundParameters) -> Array:
    """Return the checked points in W, three columns ahead of the robot (3 rows, 2) [m].

    Args:
        pose: pose of the robot (3,) [m, m, rad].
        direction: direction of its motion in W [rad].
        parameters: extent of the ground.
    """
    p = parameters
    along, across = _ground(p.near, p.far, p.half_width, p.rows)
    x, y, _ = pose.tolist()
    return np.stack(SE2(x, y, direction) @ (along, across), axis=1)


def ground_seen(belief: Belief, direction: float, parameters: UnseenGroundParameters) -> bool:
    """Whether the ground in `direction` in W [rad] of the robot was seen recently."""
    points = ground_points(belief.pose, direction, parameters)
    return float(np.min(belief.local_map.confidence_at(points))) >= parameters.confidence


@cache
def _ground(near: float, far: float, half_width: float, rows: int) -> tuple[Array, Array]:
    """Return coordinates along and across the motion (3 rows,), (3 rows,) [m]."""
    along, across = np.meshgrid(np.linspace(near, far, rows), (-half_width, 0.0, half_width))
    return along.ravel(), across.ravel()
