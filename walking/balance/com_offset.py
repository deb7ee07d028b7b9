"""Putting the mass centre where the floor says that it is not."""

from walking.clamp import clamp
from walking.parameters import CONTROL_PERIOD, StabilizerParameters

Point = tuple[float, float]


class ComOffset:
    """Offset of the body that brings the centre of pressure, on the average, under the plan.

    Over a cycle of two footsteps the floor pushes under the mass centre, wherever the model has
    it. Within a cycle the ankles and the landing feet move the centre of pressure; that is not
    followed.

    Args:
        parameters: gain and limits.

    Attributes:
        offset: of the body, forward and left [m].
    """

    def __init__(self, parameters: StabilizerParameters) -> None:
        self._gain = parameters.com_offset_gain
        self._limit = parameters.max_com_offset
        self._step = parameters.max_com_offset_rate * CONTROL_PERIOD
        self._goal: Point = (0.0, 0.0)
        self._sum = [0.0, 0.0]
        self._ticks = 0
        self.offset: Point = (0.0, 0.0)

    def rest(self) -> None:
        """No cycle is under way; the offset stays."""
        self._ticks = -1

    def update(self, error: Point, *, begins: bool, disturbed: bool) -> None:
        """One tick.

        Args:
            error: of the centre of pressure against the planned ZMP, forward and left [m].
            begins: whether a cycle of two footsteps does.
            disturbed: whether balance has a say in the footsteps.
        """
        if begins:
            if self._ticks > 0:
                x, y = (
                    clamp(goal - self._gain * total / self._ticks, self._limit)
                    for goal, total in zip(self._goal, self._sum, strict=True)
                )
                self._goal = x, y
            self._sum, self._ticks = [0.0, 0.0], 0
        if disturbed:
            self.rest()
        elif self._ticks >= 0:
            self._sum[0] += error[0]
            self._sum[1] += error[1]
            self._ticks += 1
        if self.offset != self._goal:
            most, (x, y), (goal_x, goal_y) = self._step, self.offset, self._goal
            x += min(most, max(-most, goal_x - x))
            y += min(most, max(-most, goal_y - y))
            self.offset = x, y
