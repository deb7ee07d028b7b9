"""Heading control against yaw slip of the feet."""

from walking.clamp import clamp
from walking.parameters import CONTROL_PERIOD, StabilizerParameters


class HeadingHold:
    """Proportional feedback of the heading error, constant over a gait cycle.

    One footstep of a cycle makes the turn of both, so the rate changes only between cycles.

    Args:
        parameters: gain and limit.
    """

    def __init__(self, parameters: StabilizerParameters) -> None:
        self._gain = parameters.heading_gain
        self._limit = parameters.max_heading_rate
        self._held = 0.0
        self._rate = 0.0

    def reset(self, ahead: float) -> None:
        """Set the present offset of the planned heading, `ahead` [rad], as reference."""
        self._held = ahead

    def rate(self, ahead: float, *, renew: bool) -> float:
        """Return the yaw rate of this tick [rad/s].

        Args:
            ahead: planned minus measured heading [rad].
            renew: whether to update the rate: at the begin of a gait cycle, and in every tick while
                balance changes the footsteps.
        """
        if renew:
            self._rate = clamp(self._gain * (ahead - self._held), self._limit)
        self._held += self._rate * CONTROL_PERIOD
        return self._rate
