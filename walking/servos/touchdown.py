"""Touchdown of a swinging foot."""

from walking.parameters import EstimatorParameters


class TouchdownDetector:
    """Decides that a swinging foot has met the floor.

    Args:
        parameters: phase, force and duration from which on it is sure.
    """

    def __init__(self, parameters: EstimatorParameters) -> None:
        self._force = parameters.contact_force
        self._ticks = parameters.contact_ticks
        self._phase = parameters.contact_phase
        self._count = 0

    def update(self, phase: float, force: float) -> bool:
        """Whether the foot is down at `phase` of its swing under `force` [N]."""
        self._count = self._count + 1 if phase >= self._phase and force > self._force else 0
        return self._count >= self._ticks
