"""Direction field of a planner around the robot, sampled for displays."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from navigation.decision import DirectionField
from navigation.motion.univector import normalized

Array = NDArray[np.float64]

# Lengths are those in a world of scale 1.
SPACING, REACH = 0.25, 1.5  # of the points, and their maximum distance [m]
STEP, STEPS = 0.15, 8  # of the path that follows the field [m]


@dataclass(frozen=True, slots=True)
class SampledField:
    """Samples of a direction field.

    Attributes:
        points: sampled points in W (n, 2) [m].
        directions: unit vectors at the points, zero where the field is (n, 2).
        path: path along the field from the robot (m, 2) [m].
    """

    points: Array = field(default_factory=lambda: np.zeros((0, 2)))
    directions: Array = field(default_factory=lambda: np.zeros((0, 2)))
    path: Array = field(default_factory=lambda: np.zeros((0, 2)))


NO_FIELD = SampledField()


def sampled(
    directions: DirectionField, position: Array, target: Array, scale: float
) -> SampledField:
    """Sample a field.

    Args:
        directions: the field.
        position: position of the robot in W (2,) [m].
        target: destination in W (2,) [m].
        scale: scale of the world [1].
    """
    points = grid(position, scale)
    path = path_along(directions, position, target, scale)
    return SampledField(points, normalized(directions.at(points)), path)


def grid(position: Array, scale: float = 1.0) -> Array:
    """Return the points of a fixed grid around `position` (2,) (n, 2) [m]."""
    spacing, reach = SPACING * scale, REACH * scale
    centre = np.round(position / spacing) * spacing
    steps = np.arange(-reach, reach + 0.5 * spacing, spacing)
    x, y = np.meshgrid(centre[0] + steps, centre[1] + steps)
    points = np.column_stack([x.ravel(), y.ravel()])
    inside: Array = points[np.hypot(*(points - position).T) <= reach]
    return inside


def path_along(field: DirectionField, position: Array, target: Array, scale: float = 1.0) -> Array:
    """Return the path along a field from `position` (2,) up to `target` (2,) (n, 2) [m]."""
    path, step = [np.asarray(position, dtype=float)], STEP * scale
    for _ in range(STEPS):
        if float(np.hypot(*(target - path[-1]))) <= step:
            path.append(target)
            break
        path.append(path[-1] + step * normalized(field.at(path[-1])))
    return np.array(path)
