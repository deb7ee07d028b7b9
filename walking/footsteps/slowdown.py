"""How much of a commanded velocity is dared on ground that shakes the robot."""

from math import exp

from walking.parameters import CONTROL_PERIOD, StabilizerParameters


class Slowdown:
    """Slows the walk while DCM errors beyond those of an even floor keep coming.

    Args:
        parameters: errors and time constant.
    """

    def __init__(self, parameters: StabilizerParameters) -> None:
        self._calm = parameters.slowdown_start_error
        self._range = parameters.slowdown_full_error - parameters.slowdown_start_error
        self._least = parameters.min_speed_ratio
        self._decay = exp(-CONTROL_PERIOD / parameters.slowdown_time)
        self._error = 0.0

    def update(self, error: float) -> float:
        """Share of the commanded velocity to walk at, given this tick's DCM error [m]."""
        self._error = max(error, self._decay * self._error)
        if self._error <= self._calm:
            return 1.0
        excess = (self._error - self._calm) / self._range
        return 1.0 - (1.0 - self._least) * min(1.0, max(0.0, excess))
