"""Keeping the heading that the commands add up to, though the feet slip."""

from walking.parameters import CONTROL_PERIOD, StabilizerParameters


class HeadingHold:
    """Turn rate that takes back what the body has turned against the plan.

    Args:
        parameters: gain and limit.
    """

    def __init__(self, parameters: StabilizerParameters) -> None:
        self._gain = parameters.heading_gain
        self._limit = parameters.heading_rate
        self._held = 0.0

    def rest(self, ahead: float) -> None:
        """Take the plan's heading `ahead` of the body's as it is [rad]."""
        self._held = ahead

    def rate(self, ahead: float) -> float:
        """Turn rate of this tick [rad/s], the plan's heading being `ahead` of the body's [rad]."""
        rate = min(self._limit, max(-self._limit, self._gain * (ahead - self._held)))
        self._held += rate * CONTROL_PERIOD
        return rate
