"""Slow correction of the CoM offset from the measured centre of pressure."""

from walking.arrays import Point
from walking.clamp import clamp
from walking.parameters import CONTROL_PERIOD, StabilizerParameters


class ComOffset:
    """Integral correction of the CoM: moves the body until the mean CoP is on the planned ZMP.

    Averaged over a gait cycle, the centre of pressure is below the true centre of mass. Within
    a cycle the ankles and the landing feet move it, hence one update per cycle.

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

    def reset(self) -> None:
        """Discard the present cycle; keep the offset."""
        self._ticks = -1

    def update(self, error: Point, *, begins: bool, disturbed: bool) -> None:
        """Update the offset in a control tick.

        Args:
            error: centre of pressure minus planned ZMP, forward and left [m].
            begins: whether a gait cycle begins.
            disturbed: whether balance changes the footsteps.
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
            self.reset()
        elif self._ticks >= 0:
            self._sum[0] += error[0]
            self._sum[1] += error[1]
            self._ticks += 1
        if self.offset != self._goal:
            step, (x, y), (goal_x, goal_y) = self._step, self.offset, self._goal
            x += min(step, max(-step, goal_x - x))
            y += min(step, max(-step, goal_y - y))
            self.offset = x, y
