"""Movers of a recorded crowd: the tracks that enter the field during a run."""

from collections.abc import Iterator
from math import inf

import numpy as np
from numpy.typing import NDArray

from hsr8.scenario.schema import Scenario
from hsr8.scenario.track import Track
from hsr8.scenario.track_file import RecordedTrack, recorded_tracks
from hsr8.scenario.world import TrackMover

Array = NDArray[np.float64]

AWAY = 60.0  # distance of an absent mover from its first sample, in a world of scale 1 [m]
LINGER = 1.0  # at the first and last sample, in a world with the time scale 1 [s]
SPACING = 0.05  # of samples along a track, in a world of scale 1 [m]


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
