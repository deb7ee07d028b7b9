"""Where the body turns to while it walks."""

from math import hypot

import numpy as np
from numpy.typing import NDArray

from navigation.decision import Task
from navigation.value import value

Array = NDArray[np.float64]


@value
class Facing:
    """A heading, or the direction of motion.

    Attributes:
        heading: to turn to; None for the direction of motion [rad].
        aside: angle of the body to the direction of motion, if it turns to that [rad].
        look_request: direction in W of the ground it turns aside for; None for none [rad].
    """

    heading: float | None = None
    aside: float = 0.0
    look_request: float | None = None

    def on(self, course: float) -> float:
        """Heading to turn to while walking along `course` [rad]."""
        return course + self.aside if self.heading is None else self.heading


def arriving(position: Array, task: Task, distance: float) -> bool:
    """Whether the body turns to the heading of `task`: at the goal, and within `distance` [m]."""
    dx, dy = (task.target - position).tolist()
    return task.aligning or (task.is_goal and hypot(dx, dy) < distance)
