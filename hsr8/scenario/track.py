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

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import ceil, inf

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline

from hsr8.scenario.section import Point

Array = NDArray[np.float64]

SUBDIVISIONS = 8  # of an interval between samples, for the bound of its speed


@dataclass(frozen=True)
class Track:
    """Recorded track; its times are those of the recording in units of the world.

    Attributes:
        id: name in the recording.
        times: times of the samples, increasing [s].
        points: positions at the samples in W [m].
        begin: time of the recording at time zero of the run [s].
        stays: whether the mover waits at its first and stays at its last sample.
        linger: time for which a mover that leaves stands at its first and last sample [s].
        away: distance of an absent mover from its first sample [m].
        first: time of the recording at which a repeated recording begins [s].
        period: period of a repeated recording [s].
    """

    id: str
    times: tuple[float, ...]
    points: tuple[Point, ...]
    begin: float
    stays: bool
    linger: float
    away: float
    first: float = 0.0
    period: float = inf

    @cached_property
    def curve(self) -> CubicHermiteSpline:
        """Position by time of the recording."""
        rates = rates_at_samples(np.array(self.times), np.array(self.points))
        return CubicHermiteSpline(self.times, self.points, rates)

    @cached_property
    def speed(self) -> float:
        """Upper bound of the speed [m/s]."""
        return float(speed_bounds(self.curve).max())

    @cached_property
    def _alone(self) -> "TrackTable":
        return TrackTable([self])

    def present(self, time: float) -> bool:
        """Return whether the mover is in the world at `time` [s]."""
        return bool(self._alone.present(time)[0])

    def recorded_time(self, time: float) -> float:
        """Return the time of the recording at `time` [s]."""
        return float(self._alone.recorded(time)[0])

    def positions(self, times: Array | float) -> Array:
        """Return the positions at `times` (...) [s] (..., 2) [m]."""
        positions: Array = self._alone.positions(times)[..., 0, :]
        return positions

    def position(self, time: float) -> Point:
        """Return the position at `time` [s]."""
        x, y = self.positions(time).tolist()
        return x, y

    def velocity(self, time: float) -> Point:
        """Return the velocity at `time` [m/s]; zero while the mover stands or is away."""
        x, y = self._alone.velocities(time)[0].tolist()
        return x, y

    def sampled(self, low: float, high: float, spacing: float) -> tuple[Array, Array]:
        """Return times (n,) [s] and positions (n, 2) [m] between two times of the recording.

        Times before or after the track are those of its ends.

        Args:
            low: begin [s].
            high: end [s].
            spacing: maximum distance between two positions [m].
        """
        low, high = (min(max(moment, self.times[0]), self.times[-1]) for moment in (low, high))
        n = ceil((high - low) * self.speed / spacing) + 1
        moments = np.linspace(low, high, max(2, n))
        return moments, self.curve(moments)


class TrackTable:
    """Recorded tracks as arrays, padded to the longest one, evaluated together.

    Args:
        tracks: at least one.
    """

    def __init__(self, tracks: Sequence[Track]) -> None:
        n, longest = len(tracks), max(len(track.times) for track in tracks)
        self._times = np.full((n, longest), np.inf)
        self._cubics = np.zeros((n, longest - 1, 2, 4))  # highest power first
        for row, track in enumerate(tracks):
            self._times[row, : len(track.times)] = track.times
            self._cubics[row, : len(track.times) - 1] = np.moveaxis(track.curve.c, 0, -1)
        self._rows = np.arange(n)
        self._last = np.array([len(track.times) - 2 for track in tracks])
        self._start = np.array([track.times[0] for track in tracks])
        self._end = np.array([track.times[-1] for track in tracks])
        linger = np.array([np.inf if track.stays else track.linger for track in tracks])
        self._appears, self._leaves = self._start - linger, self._end + linger
        self._begin = np.array([track.begin for track in tracks])
        self._first = np.array([track.first for track in tracks])
        self._period = np.array([track.period for track in tracks])
        self._away = np.array([(t.points[0][0] + t.away, t.points[0][1]) for t in tracks])

    def present(self, times: Array | float) -> NDArray[np.bool_]:
        """Return whether the movers are in the world at `times` (...) [s], in order (..., n)."""
        moment = self.recorded(times)
        present: NDArray[np.bool_] = (self._appears <= moment) & (moment < self._leaves)
        return present

    def recorded(self, times: Array | float) -> Array:
        """Return the times of the recordings at `times` (...) [s], in order (..., n) [s]."""
        moment: Array = np.asarray(times)[..., None] + self._begin
        repeats = np.isfinite(self._period)
        if repeats.any():
            period = np.where(repeats, self._period, 1.0)
            again = self._first + np.mod(moment - self._first, period)
            moment = np.where(repeats, again, moment)
        return moment

    def positions(self, times: Array | float) -> Array:
        """Return the positions at `times` (...) [s], in order (..., n, 2) [m]."""
        moment = self.recorded(times)
        cubics, u = self._pieces(np.clip(moment, self._start, self._end))
        at = cubics[..., 3] + u * (cubics[..., 2] + u * (cubics[..., 1] + u * cubics[..., 0]))
        positions: Array = np.where(self.present(times)[..., None], at, self._away)
        return positions

    def velocities(self, times: Array | float) -> Array:
        """Return the velocities at `times` (...) [s], in order (..., n, 2) [m/s]."""
        moment = self.recorded(times)
        cubics, u = self._pieces(np.clip(moment, self._start, self._end))
        slope = cubics[..., 2] + u * (2.0 * cubics[..., 1] + u * (3.0 * cubics[..., 0]))
        walks = (self._start <= moment) & (moment < self._end)
        velocities: Array = np.where(walks[..., None], slope, 0.0)
        return velocities

    def _pieces(self, moment: Array) -> tuple[Array, Array]:
        """Return coefficients (..., n, 2, 4) and times since the last sample (..., n, 1) [s]."""
        passed = (self._times <= moment[..., None]).sum(axis=-1)
        k = np.minimum(passed - 1, self._last)
        return self._cubics[self._rows, k], (moment - self._times[self._rows, k])[..., None]


def rates_at_samples(times: Array, points: Array) -> Array:
    """Return the velocities at the samples (n, 2) [m/s].

    Args:
        times: increasing times (n,) [s].
        points: positions (n, 2) [m].
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


def speed_bounds(curve: CubicHermiteSpline) -> Array:
    """Return upper bounds of the speed between the samples of a curve (n - 1,) [m/s].

    The velocity is a quadratic polynomial of time. In each of `SUBDIVISIONS` parts it is in the
    convex hull of its Bézier points.
    """
    fractions = np.linspace(0.0, 1.0, 2 * SUBDIVISIONS + 1)[:, None]
    u = (fractions * np.diff(curve.x))[..., None]
    velocity = curve.c[2] + u * (2.0 * curve.c[1] + u * (3.0 * curve.c[0]))
    ends, middles = velocity[::2], velocity[1::2]
    controls = 2.0 * middles - 0.5 * (ends[:-1] + ends[1:])
    speeds = [np.hypot(v[..., 0], v[..., 1]) for v in (ends, controls)]
    bounds: Array = np.concatenate(speeds).max(axis=0)
    return bounds
