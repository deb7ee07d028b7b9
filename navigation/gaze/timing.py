"""When the gaze is decided again: after arrival and a dwell."""

from navigation.observation import CameraView


class GazeTiming:
    """Lets the head arrive and rest before the next decision."""

    def __init__(self, dwell: float, tolerance: float, limit: float) -> None:
        """Start ready to decide.

        Args:
            dwell: rest after arrival [s].
            tolerance: distance at which the head has arrived [rad].
            limit: time after which to decide even without arrival [s].
        """
        self._dwell = dwell
        self._tolerance = tolerance
        self._limit = limit
        self._target = (0.0, 0.0)
        self._decided: float | None = None
        self._arrived: float | None = None

    def due(self, time: float, view: CameraView) -> bool:
        """Whether to decide at `time` [s], the camera being where `view` says."""
        if self._decided is None:
            return True
        pan, tilt = self._target
        off = max(abs(view.pan - pan), abs(view.tilt - tilt))
        if self._arrived is None and off <= self._tolerance:
            self._arrived = time
        rested = self._arrived is not None and time - self._arrived >= self._dwell - 1e-9
        return rested or time - self._decided >= self._limit

    def decided(self, time: float, pan: float, tilt: float) -> None:
        """Note a decision made at `time` [s] for the gaze (pan, tilt) [rad]."""
        if self._decided is None or (pan, tilt) != self._target:
            self._arrived = None
        self._target = (pan, tilt)
        self._decided = time
