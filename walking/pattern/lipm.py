"""Linear inverted pendulum in closed form: x'' = ω² (x - p).

Kajita et al., IROS 2001; divergent component of motion ξ = x + x'/ω: Takenaka et al., IROS 2009.
"""

from dataclasses import dataclass
from math import cosh, exp, sinh, sqrt

from walking.arrays import Point
from walking.parameters import CONTROL_PERIOD, GRAVITY


@dataclass(frozen=True, slots=True)
class RampCoefficients:
    """ξ(h) = growth ξ(0) - first p(0) - last p(h) for a ZMP linear over a time h.

    Attributes:
        growth: e^{ωh} [1].
        first, last: weight of the ZMP at the start and at the end [1].
    """

    growth: float
    first: float
    last: float


class Lipm:
    """Pendulum of a given height, advanced one control tick at a time.

    Args:
        height: of the pendulum [m].

    Attributes:
        omega: ω = √(g / height) [1/s].
        tick: ω [1/s], cosh ωT and sinh ωT [1], control period T [s], for kernels.
    """

    def __init__(self, height: float) -> None:
        self.omega = sqrt(GRAVITY / height)
        wh = self.omega * CONTROL_PERIOD
        self._cosh, self._sinh = cosh(wh), sinh(wh)
        self.tick = (self.omega, self._cosh, self._sinh, CONTROL_PERIOD)
        self._ramps: dict[int, RampCoefficients] = {}

    def step(self, position: float, velocity: float, zmp: float) -> Point:
        """Return position [m] and velocity [m/s] one tick later under a constant ZMP."""
        d, w = position - zmp, self.omega
        return (
            zmp + d * self._cosh + velocity / w * self._sinh,
            d * w * self._sinh + velocity * self._cosh,
        )

    def hold(self, position: float, velocity: float, zmp: float, time: float) -> Point:
        """Return position [m] and velocity [m/s] a `time` [s] later under a constant ZMP."""
        w = self.omega
        c, s, d = cosh(w * time), sinh(w * time), position - zmp
        return zmp + d * c + velocity / w * s, d * w * s + velocity * c

    def ramp(self, ticks: int) -> RampCoefficients:
        """Return the coefficients of the DCM over `ticks` of a linearly moving ZMP."""
        if ticks not in self._ramps:
            wh = self.omega * CONTROL_PERIOD * ticks
            growth = exp(wh)
            last = (growth - 1.0) / wh - 1.0 if ticks else 0.0
            self._ramps[ticks] = RampCoefficients(growth, growth - 1.0 - last, last)
        return self._ramps[ticks]
