"""Timing of the gaze: a saccade, then a dwell."""

from navigation.parameters.gaze import GazeParameters


class GazeTiming:
    """Timing of decisions: the gaze arrives and dwells before the next one."""

    def __init__(self, parameters: GazeParameters) -> None:
        self._parameters = parameters
        self._target = (0.0, 0.0)
        self._decided: float | None = None
        self._arrived: float | None = None

    def ready(self, time: float, error: float) -> bool:
        """Whether to decide at `time` [s] with the camera `error` [rad] from its target."""
        if self._decided is None:
            return True
        p = self._parameters
        if self._arrived is None and error <= p.arrival_tolerance:
            self._arrived = time
        dwelled = self._arrived is not None and time - self._arrived >= p.dwell - 1e-9
        most = p.max_saccade_time if p.moved_by == "head" else p.max_turn_time
        return dwelled or time - self._decided >= most

    def decided(self, time: float, target: tuple[float, float]) -> None:
        """Record a decision at `time` [s] for a target."""
        if self._decided is None or target != self._target:
            self._arrived = None
        self._target = target
        self._decided = time
