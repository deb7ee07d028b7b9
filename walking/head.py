"""The head follows its target as fast as its rate and acceleration limits allow."""

from math import sqrt

from walking.command import HeadTarget
from walking.parameters import CONTROL_PERIOD, HeadParameters


class _Axis:
    """One axis: fastest approach that can still stop at the target."""

    __slots__ = ("_acceleration", "_high", "_low", "_rate", "position", "velocity")

    def __init__(
        self, position: float, limits: tuple[float, float], parameters: HeadParameters
    ) -> None:
        self._low, self._high = limits
        self._rate = parameters.rate
        self._acceleration = parameters.acceleration
        self.position = position
        self.velocity = 0.0

    def advance(self, target: float) -> None:
        target = min(self._high, max(self._low, target))
        error = target - self.position
        a, dt = self._acceleration, CONTROL_PERIOD
        # Largest speed from which whole ticks of braking still end at the target.
        step = a * dt
        reach = step * (sqrt(0.25 + 2.0 * abs(error) / (step * dt)) - 0.5)
        wanted = min(self._rate, reach, abs(error) / dt)
        wanted = wanted if error >= 0.0 else -wanted
        self.velocity += min(step, max(-step, wanted - self.velocity))
        self.position += self.velocity * dt


class Head:
    """Pan and tilt.

    Args:
        pan, tilt: starting angles [rad].
        limits: lower and upper limit of pan and of tilt [rad].
        parameters: rate and acceleration limits.
    """

    def __init__(
        self,
        pan: float,
        tilt: float,
        limits: tuple[tuple[float, float], tuple[float, float]],
        parameters: HeadParameters,
    ) -> None:
        self._pan = _Axis(pan, limits[0], parameters)
        self._tilt = _Axis(tilt, limits[1], parameters)

    def advance(self, target: HeadTarget) -> tuple[float, float]:
        """Set-points of pan and tilt of this tick [rad]."""
        self._pan.advance(target.pan)
        self._tilt.advance(target.tilt)
        return self._pan.position, self._tilt.position
