"""Touchdown detection."""

from walking.parameters import EstimatorParameters


class TouchdownDetector:
    """Detects touchdown of the swing foot.

    Args:
        parameters: minimum phase, force and duration of contact.
    """

    def __init__(self, parameters: EstimatorParameters) -> None:
        self._force = parameters.contact_force
        self._ticks = parameters.contact_ticks
        self._phase = parameters.contact_phase
        self._count = 0

    def update(self, phase: float, force: float) -> bool:
        """Whether the foot is down, given the phase of its swing [1] and its load [N]."""
        self._count = self._count + 1 if phase >= self._phase and force > self._force else 0
        return self._count >= self._ticks
