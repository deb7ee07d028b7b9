"""Ground ahead that must have been seen before the robot walks there fast."""

from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from navigation.decision_parameters import GateParameters

Array = NDArray[np.float64]

_ROWS = 4


def gate_points(pose: Array, direction: float, parameters: GateParameters) -> Array:
    """Points asked for, three columns before a robot that moves in `direction` (12, 2) [m].

    Args:
        pose: of the robot (3,) [m, m, rad].
        direction: of its motion in W [rad].
        parameters: extent of the ground.
    """
    p = parameters
    along, across = np.meshgrid(
        np.linspace(p.near, p.far, _ROWS), np.array([-p.half_width, 0.0, p.half_width])
    )
    c, s = cos(direction), sin(direction)
    points: Array = pose[:2] + np.stack(
        [(c * along - s * across).ravel(), (s * along + c * across).ravel()], axis=1
    )
    return points
