"""Recorded crowds: smooth curves through the samples of each track, with bounded speed.

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

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil, inf

import numpy as np
from numpy.typing import NDArray

from hsr8.scenario.path import Law, Path, Paths, hermite_pieces
from hsr8.scenario.schema import Scenario
from hsr8.scenario.section import Point
from hsr8.scenario.track_file import RecordedTrack, recorded_tracks
from hsr8.scenario.world import TrackMover

Array = NDArray[np.float64]

SUBDIVISIONS = 8  # of an interval between samples, for the bound of its speed
AWAY = 60.0  # distance of an absent mover from its first sample, in a world of scale 1 [m]
LINGER = 1.0  # at the first and last sample, in a world with the time scale 1 [s]
SPACING = 0.05  # of samples along a track, in a world of scale 1 [m]


@dataclass(frozen=True)
class Track(Law):
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
    def path(self) -> Path:
        """Path by the time of the recording."""
        times, points = np.array(self.times), np.array(self.points)
        pieces = hermite_pieces(times, points, rates_at_samples(times, points))
        linger = inf if self.stays else self.linger
        return Path(
            times,
            times[:-1],
            pieces,
            offset=self.begin,
            first=self.first,
            period=self.period,
            window=(self.times[0] - linger, self.times[-1] + linger),
            away=(self.points[0][0] + self.away, self.points[0][1]),
        )

    @cached_property
    def speed(self) -> float:
        """Upper bound of the speed [m/s]."""
        return float(speed_bounds(self.path).max())

    def present(self, time: float) -> bool:
        """Return whether the mover is in the world at `time` [s]."""
        return bool(self.state(time)[5])

    def recorded_time(self, time: float) -> float:
        """Return the time of the recording at `time` [s]."""
        return float(self.state(time)[4])

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
        lane = replace(self.path, offset=0.0, period=inf, window=(-inf, inf))
        return moments, Paths([lane]).positions(moments[:, None])[:, 0]


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


def speed_bounds(path: Path) -> Array:
    """Return upper bounds of the speed between the samples of a recording (n - 1,) [m/s].

    The velocity is a quadratic polynomial of time. In each of `SUBDIVISIONS` parts it is in the
    convex hull of its Bézier points.
    """
    fractions = np.linspace(0.0, 1.0, 2 * SUBDIVISIONS + 1)[:, None]
    u, c = (fractions * np.diff(path.knots))[..., None], path.cubics
    velocity = c[..., 2] + u * (2.0 * c[..., 1] + u * (3.0 * c[..., 0]))
    ends, middles = velocity[::2], velocity[1::2]
    controls = 2.0 * middles - 0.5 * (ends[:-1] + ends[1:])
    speeds = [np.hypot(v[..., 0], v[..., 1]) for v in (ends, controls)]
    bounds: Array = np.concatenate(speeds).max(axis=0)
    return bounds


class Recording:
    """Tracks of a mover section in the world.

    Args:
        scenario: world, robot and duration.
        mover: names and scales the recording.

    Attributes:
        time_scale: time in the world per time in the file [1].
        first: time of the first sample in the file [s].
        last: time of the last sample in the file [s].
        start: earliest time in the file at the start of the run [s].
        latest_start: latest time in the file at the start of the run [s].
        window: times of the recording, in units of the world, that a run may show [s].
    """

    def __init__(self, scenario: Scenario, mover: TrackMover) -> None:
        self._scenario, self._mover = scenario, mover
        self._recorded = recorded_tracks(mover.data)
        self._half = 0.5 * np.asarray(scenario.world.size) + mover.radius
        self._scale = 1.0 if mover.scale is None else mover.scale
        self.time_scale = 1.0 if mover.time_scale is None else mover.time_scale
        self.first = min(float(track.times[0]) for track in self._recorded)
        self.last = max(float(track.times[-1]) for track in self._recorded)
        self.start = self.first if mover.start is None else mover.start
        self.latest_start = self.start if mover.latest_start is None else mover.latest_start
        if mover.end == "repeat":
            self.window = -inf, inf
        else:
            end = self.time_scale * self.latest_start + scenario.duration
            self.window = self.time_scale * self.start, end

    def tracks(self, start: float | None = None) -> tuple[Track, ...]:
        """Return the tracks that enter the field in the window, in the order of the file.

        Args:
            start: time in the file at the start of the run; default: the earliest [s].
        """
        begin = self.time_scale * (self.start if start is None else start)
        tracks = (self._track(recorded, begin) for recorded in self._recorded)
        return tuple(t for t in tracks if self.inside(self.sampled(t)[1]).any())

    def sampled(self, track: Track) -> tuple[Array, Array]:
        """Return times (n,) [s] and positions (n, 2) [m] of a track that a run may show."""
        moments, points = track.sampled(*self.window, SPACING * self._scenario.world.scale)
        low, high = self.window
        if not track.stays:
            shown = (moments >= low) & (moments <= high)
            moments, points = moments[shown], points[shown]
        return moments, points

    def inside(self, points: Array) -> NDArray[np.bool_]:
        """Return whether the discs at `points` (..., 2) [m] reach into the field."""
        inside: NDArray[np.bool_] = np.all(np.abs(points) < self._half, axis=-1)
        return inside

    def extent(self) -> tuple[Array, Array]:
        """Return the minimum and maximum of all positions (2,) [m]."""
        points = np.concatenate([self._points(recorded) for recorded in self._recorded])
        return points.min(axis=0), points.max(axis=0)

    def _points(self, recorded: RecordedTrack) -> Array:
        points: Array = np.asarray(self._mover.offset) + self._scale * recorded.points
        return points

    def _track(self, recorded: RecordedTrack, begin: float) -> Track:
        linger = LINGER * self._scenario.time_scale
        first, period = 0.0, inf
        if self._mover.end == "repeat":
            first = self.time_scale * self.first - linger
            period = self.time_scale * (self.last - self.first) + 2.0 * linger
        return Track(
            id=recorded.id,
            times=tuple((self.time_scale * recorded.times).tolist()),
            points=tuple((x, y) for x, y in self._points(recorded).tolist()),
            begin=begin,
            stays=self._mover.end == "stay",
            linger=linger,
            away=AWAY * self._scenario.world.scale,
            first=first,
            period=period,
        )


def recordings(scenario: Scenario) -> Iterator[tuple[int, Recording]]:
    """Yield the recordings of a scenario with their indices in `world.mover`."""
    for i, mover in enumerate(scenario.world.mover):
        if isinstance(mover, TrackMover):
            yield i, Recording(scenario, mover)


def n_placed(scenario: Scenario) -> int:
    """Return the number of movers placed by hand and of recorded ones."""
    recorded = [recording.tracks() for _, recording in recordings(scenario)]
    return len(scenario.world.mover) - len(recorded) + sum(map(len, recorded))
