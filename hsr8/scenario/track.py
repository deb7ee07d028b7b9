"""Motion along a recorded track: a smooth curve through all samples, with bounded speed.

Between two samples the position is a cubic polynomial of time. The velocity at a sample is that of
the parabola through it and its neighbours, but never faster than the slower of the two mean
velocities around it, and zero where these are a right angle or more apart. Position and velocity
are therefore continuous, and the curve does not overshoot a turning point. The speed is at most
√2.5 times the mean speed between the two samples: with the mean velocity d, the velocities a and b
at both ends and the fraction s of the time, the velocity is

    6s(1-s) d + (1-s)(1-3s) a + s(3s-2) b.

Its maximum for |a|, |b| <= |d| and a·d, b·d >= 0 is at s = 1/2 with a = b perpendicular to d.
Linear interpolation would not exceed the mean speed, but its velocity jumps at every sample; a
spline without limits overshoots.
"""

from bisect import bisect_right
from dataclasses import dataclass
from math import ceil, inf, isfinite

import numpy as np
from numpy.polynomial.polynomial import polyval
from numpy.typing import NDArray

from hsr8.scenario.section import Point

Array = NDArray[np.float64]

SUBDIVISIONS = 8  # of an interval between samples, for the bound of its speed


@dataclass(frozen=True, slots=True)
class Track:
    """Recorded track; its times are those of the recording in units of the world.

    Attributes:
        id: in the recording.
        times: of the samples, increasing [s].
        points: positions at the samples in W [m].
        rates: velocities at the samples in W [m/s].
        speed: upper bound of the speed [m/s].
        begin: time of the recording at time zero of the run [s].
        stays: whether the mover waits at its first and stays at its last sample.
        linger: time for which a mover that leaves stands at its first and last sample [s].
        away: distance of an absent mover from its first sample [m].
        first: time of the recording at which a repeated recording begins [s].
        period: of a repeated recording [s].
    """

    id: str
    times: tuple[float, ...]
    points: tuple[Point, ...]
    rates: tuple[Point, ...]
    speed: float
    begin: float
    stays: bool
    linger: float
    away: float
    first: float = 0.0
    period: float = inf

    def present(self, time: float) -> bool:
        """Return whether the mover is in the world at `time` [s]."""
        moment = self.recorded_time(time)
        return self.stays or (self.times[0] - self.linger <= moment < self.times[-1] + self.linger)

    def recorded_time(self, time: float) -> float:
        """Return the time of the recording at `time` [s]."""
        moment = time + self.begin
        if isfinite(self.period):
            return self.first + (moment - self.first) % self.period
        return moment

    def position(self, time: float) -> Point:
        """Return the position at `time` [s]."""
        if not self.present(time):
            return self.points[0][0] + self.away, self.points[0][1]
        return self.at(self.recorded_time(time))

    def velocity(self, time: float) -> Point:
        """Return the velocity at `time` [m/s]; zero while the mover stands or is away."""
        moment = self.recorded_time(time)
        if not self.times[0] <= moment < self.times[-1]:
            return 0.0, 0.0
        since, x, y = self._polynomials(moment)
        return _slope(x, since), _slope(y, since)

    def at(self, moment: float) -> Point:
        """Return the position at a time of the recording [s], held before and after the track."""
        moment = min(max(moment, self.times[0]), self.times[-1])
        since, x, y = self._polynomials(moment)
        return _value(x, since), _value(y, since)

    def sampled(self, low: float, high: float, spacing: float) -> tuple[Array, Array]:
        """Return times (n,) [s] and positions (n, 2) [m] between two times of the recording.

        Times before or after the track are those of its ends.

        Args:
            low: [s].
            high: [s].
            spacing: maximum distance between two positions [m].
        """
        low, high = (min(max(moment, self.times[0]), self.times[-1]) for moment in (low, high))
        n = ceil((high - low) * self.speed / spacing) + 1
        moments = np.linspace(low, high, max(2, n))
        pieces = np.searchsorted(self.times[1:-1], moments, side="right")
        since = (moments - np.array(self.times)[pieces])[:, None]
        coefficients = np.moveaxis(self.polynomials()[pieces], -1, 0)
        return moments, polyval(since, coefficients, tensor=False)

    def polynomials(self) -> Array:
        """Return the coefficients between the samples, constant first (n - 1, 2, 4)."""
        pieces = [self._polynomials(moment) for moment in self.times[:-1]]
        return np.array([(x, y) for _, x, y in pieces])

    def _polynomials(self, moment: float) -> tuple[float, "Cubic", "Cubic"]:
        """Return the time since the last sample [s], and the polynomials of it for x and y."""
        k = min(bisect_right(self.times, moment), len(self.times) - 1) - 1
        duration = self.times[k + 1] - self.times[k]
        ends = zip(
            self.points[k], self.points[k + 1], self.rates[k], self.rates[k + 1], strict=True
        )
        x, y = (_cubic(duration, *end) for end in ends)
        return moment - self.times[k], x, y


Cubic = tuple[float, float, float, float]
"""Coefficients, constant first."""


def _cubic(duration: float, start: float, end: float, rate: float, end_rate: float) -> Cubic:
    mean = (end - start) / duration
    square = (3.0 * mean - 2.0 * rate - end_rate) / duration
    return start, rate, square, (rate + end_rate - 2.0 * mean) / duration**2


def _value(cubic: Cubic, since: float) -> float:
    return cubic[0] + since * (cubic[1] + since * (cubic[2] + since * cubic[3]))


def _slope(cubic: Cubic, since: float) -> float:
    return cubic[1] + since * (2.0 * cubic[2] + since * (3.0 * cubic[3]))


def rates_at_samples(times: Array, points: Array) -> Array:
    """Return the velocities at the samples (n, 2) [m/s].

    Args:
        times: increasing (n,) [s].
        points: (n, 2) [m].
    """
    durations = np.diff(times)[:, None]
    means = np.diff(points, axis=0) / durations
    before, after = means[:-1], means[1:]
    weighted = durations[1:] * before + durations[:-1] * after
    middle = weighted / (durations[1:] + durations[:-1])
    speeds = np.hypot(*means.T)
    limits = np.minimum(speeds[:-1], speeds[1:])
    limits[(before * after).sum(axis=1) <= 0.0] = 0.0
    size = np.hypot(*middle.T)
    ratio = np.divide(limits, size, out=np.zeros_like(size), where=size > 0.0)
    middle *= np.minimum(ratio, 1.0)[:, None]
    return np.concatenate([means[:1], middle, means[-1:]])


def speed_bounds(times: Array, points: Array, rates: Array) -> Array:
    """Return upper bounds of the speed between the samples (n - 1,) [m/s].

    The velocity is a quadratic polynomial of time. In each of `SUBDIVISIONS` parts it is in the
    convex hull of its Bézier points.
    """
    means = np.diff(points, axis=0) / np.diff(times)[:, None]
    s = np.linspace(0.0, 1.0, 2 * SUBDIVISIONS + 1)[:, None, None]
    velocity = (
        6.0 * s * (1.0 - s) * means
        + (1.0 - s) * (1.0 - 3.0 * s) * rates[:-1]
        + s * (3.0 * s - 2.0) * rates[1:]
    )
    ends, middles = velocity[::2], velocity[1::2]
    controls = 2.0 * middles - 0.5 * (ends[:-1] + ends[1:])
    bounds: Array = np.concatenate([np.hypot(v[..., 0], v[..., 1]) for v in (ends, controls)]).max(
        axis=0
    )
    return bounds
