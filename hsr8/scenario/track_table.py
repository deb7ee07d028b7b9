"""Positions and velocities of many recorded tracks, evaluated together."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hsr8.scenario.track import Track

Array = NDArray[np.float64]


class TrackTable:
    """Recorded tracks as arrays, padded to the longest one.

    Args:
        tracks: at least one.
    """

    def __init__(self, tracks: Sequence[Track]) -> None:
        n, longest = len(tracks), max(len(track.times) for track in tracks)
        self._times = np.full((n, longest), np.inf)
        self._cubics = np.zeros((n, longest - 1, 2, 4))
        for row, track in enumerate(tracks):
            self._times[row, : len(track.times)] = track.times
            self._cubics[row, : len(track.times) - 1] = track.polynomials()
        self._rows = np.arange(n)
        self._last = np.array([len(track.times) - 2 for track in tracks])
        self._start = np.array([track.times[0] for track in tracks])
        self._end = np.array([track.times[-1] for track in tracks])
        linger = np.array([np.inf if track.stays else track.linger for track in tracks])
        self._appears, self._leaves = self._start - linger, self._end + linger
        self._begin = np.array([track.begin for track in tracks])
        self._first = np.array([track.first for track in tracks])
        self._period = np.array([track.period for track in tracks])
        self._repeats = np.isfinite(self._period)
        self._away = np.array([(t.points[0][0] + t.away, t.points[0][1]) for t in tracks])

    def positions(self, time: Array) -> Array:
        """Return the positions at `time` (...,) [s], in order (..., n, 2) [m]."""
        moment = self._recorded(time)
        cubics, since = self._pieces(np.clip(moment, self._start, self._end))
        u = since[..., None]
        at = cubics[..., 0] + u * (cubics[..., 1] + u * (cubics[..., 2] + u * cubics[..., 3]))
        present = (self._appears <= moment) & (moment < self._leaves)
        positions: Array = np.where(present[..., None], at, self._away)
        return positions

    def velocities(self, time: float) -> Array:
        """Return the velocities at `time` [s], in order (n, 2) [m/s]."""
        moment = self._recorded(np.asarray(time))
        cubics, since = self._pieces(np.clip(moment, self._start, self._end))
        u = since[..., None]
        slope = cubics[..., 1] + u * (2.0 * cubics[..., 2] + u * (3.0 * cubics[..., 3]))
        walks = (self._start <= moment) & (moment < self._end)
        velocities: Array = np.where(walks[..., None], slope, 0.0)
        return velocities

    def _recorded(self, time: Array) -> Array:
        """Return the times of the recording (..., n) [s]."""
        moment: Array = time[..., None] + self._begin
        if self._repeats.any():
            period = np.where(self._repeats, self._period, 1.0)
            again = self._first + np.mod(moment - self._first, period)
            moment = np.where(self._repeats, again, moment)
        return moment

    def _pieces(self, moment: Array) -> tuple[Array, Array]:
        """Return coefficients (..., n, 2, 4) and times since the last sample (..., n) [s]."""
        passed = (self._times <= moment[..., None]).sum(axis=-1)
        k = np.minimum(passed - 1, self._last)
        return self._cubics[self._rows, k], moment - self._times[self._rows, k]
