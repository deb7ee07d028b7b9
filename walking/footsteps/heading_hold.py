"""Keeping the heading that the commands add up to, though the feet slip."""

from walking.clamp import clamp
from walking.parameters import CONTROL_PERIOD, StabilizerParameters


class HeadingHold:
    """Turn rate that takes back what the body has turned against the plan.

    Of the two footsteps of a cycle one turns for both. The rate is decided on once a cycle, so
    that what it adds up to is what they turn.

    Args:
        parameters: gain and limit.
    """

    def __init__(self, parameters: StabilizerParameters) -> None:
        self._gain = parameters.heading_gain
        self._limit = parameters.max_heading_rate
        self._held = 0.0
        self._rate = 0.0

    def rest(self, ahead: float) -> None:
        """Take the plan's heading `ahead` of the body's as it is [rad]."""
        self._held = ahead

    def rate(self, ahead: float, *, renew: bool) -> float:
        """Turn rate of this tick.

        Args:
            ahead: of the body's heading, that of the plan [rad].
            renew: whether to decide anew: as a cycle of two footsteps begins, and at any time
                while balance has a say in the footsteps.

        Returns:
            the rate [rad/s].
        """
        if renew:
            self._rate = clamp(self._gain * (ahead - self._held), self._limit)
        self._held += self._rate * CONTROL_PERIOD
        return self._rate
