"""Heading of the body while it walks."""

from math import hypot

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap
from navigation.decision import Task
from navigation.value import value

Array = NDArray[np.float64]


@value
class Facing:
    """Target heading of the body.

    Attributes:
        heading: target in W; None for the course [rad].
    """

    heading: float | None = None

    def on(self, course: float) -> float:
        """Return the target heading while walking along `course` [rad]."""
        return course if self.heading is None else self.heading


def towards(direction: float, course: float, most: float) -> Facing:
    """Return the heading nearest to a direction in W, at most `most` from the course [rad]."""
    return Facing(course + min(max(wrap(direction - course), -most), most))


def arriving(position: Array, task: Task, distance: float) -> bool:
    """Whether the body turns to the heading of `task`: at the goal or within `distance` [m]."""
    dx, dy = (task.target - position).tolist()
    return task.aligning or (task.is_goal and hypot(dx, dy) < distance)
