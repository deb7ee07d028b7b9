"""Slowdown of the walk under large DCM errors."""

from math import exp

from walking.parameters import CONTROL_PERIOD, StabilizerParameters


class Slowdown:
    """Reduces the commanded velocity by the decaying maximum of the DCM error.

    Args:
        parameters: range of errors and time constant.
    """

    def __init__(self, parameters: StabilizerParameters) -> None:
        self._start = parameters.slowdown_start_error
        self._range = parameters.slowdown_full_error - parameters.slowdown_start_error
        self._min_ratio = parameters.min_speed_ratio
        self._decay = exp(-CONTROL_PERIOD / parameters.slowdown_time)
        self._error = 0.0

    def update(self, error: float) -> float:
        """Return the speed ratio [1] after this tick's DCM error [m]."""
        self._error = max(error, self._decay * self._error)
        if self._error <= self._start:
            return 1.0
        excess = (self._error - self._start) / self._range
        return 1.0 - (1.0 - self._min_ratio) * min(1.0, max(0.0, excess))
