"""Timing of the gaze: a saccade, then a dwell."""

from navigation.observation import CameraView
from navigation.parameters.gaze import GazeParameters


class GazeTiming:
    """Timing of decisions: the head arrives and dwells before the next one."""

    def __init__(self, parameters: GazeParameters) -> None:
        self._parameters = parameters
        self._target = (0.0, 0.0)
        self._decided: float | None = None
        self._arrived: float | None = None

    def ready(self, time: float, view: CameraView) -> bool:
        """Whether to decide at `time` [s] with the camera at `view`."""
        if self._decided is None:
            return True
        pan, tilt = self._target
        error = max(abs(view.pan - pan), abs(view.tilt - tilt))
        p = self._parameters
        if self._arrived is None and error <= p.arrival_tolerance:
            self._arrived = time
        dwelled = self._arrived is not None and time - self._arrived >= p.dwell - 1e-9
        return dwelled or time - self._decided >= p.max_saccade_time

    def decided(self, time: float, pan: float, tilt: float) -> None:
        """Record a decision at `time` [s] for the gaze (pan, tilt) [rad]."""
        if self._decided is None or (pan, tilt) != self._target:
            self._arrived = None
        self._target = (pan, tilt)
        self._decided = time
