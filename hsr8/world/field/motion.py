"""Motion laws of moving obstacles: exact position and velocity at any time."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot, inf

import numpy as np
from numpy.typing import NDArray

from hsr8.scenario.path import Law, Path, Paths, straight_pieces
from hsr8.scenario.track import AWAY, Track

Array = NDArray[np.float64]
Point = tuple[float, float]
Interval = tuple[float, float]
ALWAYS: Interval = (-inf, inf)

SAME_TIME = 1e-6  # times closer than this are equal [s]


@dataclass(frozen=True, slots=True)
class Line(Law):
    """Straight line at constant velocity.

    Attributes:
        start: position at time zero [m].
        rate: velocity [m/s].
    """

    start: Point
    rate: Point

    @property
    def path(self) -> Path:
        """Path by the distance travelled."""
        speed = hypot(*self.rate)
        along = np.array([self.rate]) / (speed or 1.0)
        pieces = straight_pieces(np.array([self.start]), along)
        return Path(np.array([0.0, inf]), np.zeros(1), pieces, speed=speed)


@dataclass(frozen=True, slots=True)
class _Segment(Law):
    """Line between two points.

    Attributes:
        start: first end [m].
        end: second end [m].
        speed: speed along the line [m/s].
    """

    start: Point
    end: Point
    speed: float

    @property
    def length(self) -> float:
        """Distance between the points [m]."""
        return hypot(self.end[0] - self.start[0], self.end[1] - self.start[1])


@dataclass(frozen=True, slots=True)
class Shuttle(_Segment):
    """Back and forth between two points at constant speed, reversing at once.

    Attributes:
        offset: distance travelled before time zero, from `start` to `end` and back [m].
    """

    offset: float = 0.0

    @property
    def path(self) -> Path:
        """Path by the distance travelled there and back."""
        length = self.length
        along = (np.array(self.end) - self.start) / length
        pieces = straight_pieces(np.array([self.start, self.start]), np.array([along, -along]))
        knots = length * np.arange(3.0)
        return Path(knots, knots[[0, 2]], pieces, self.offset, self.speed, period=knots[2])


@dataclass(frozen=True, slots=True)
class Passage(_Segment):
    """One straight move at constant speed; the mover waits at `start` and stays at `end`.

    Attributes:
        depart: time of the departure [s].
    """

    depart: float = 0.0

    @property
    def path(self) -> Path:
        """Path by the travelled fraction."""
        start = np.array([self.start])
        pieces, unit = straight_pieces(start, np.array([self.end]) - start), self.length
        return Path(
            np.arange(2.0), np.zeros(1), pieces, speed=self.speed, depart=self.depart, unit=unit
        )


@dataclass(frozen=True, slots=True)
class Circle(Law):
    """Circle at constant speed.

    Attributes:
        centre: centre of the path [m].
        radius: radius of the path [m].
        speed: speed, counter-clockwise positive [m/s].
        angle: angle on the circle at time zero [rad].
    """

    centre: Point
    radius: float
    speed: float
    angle: float = 0.0

    def state(self, time: float) -> Array:
        """Return the state at `time` [s], see `Paths.states` (6,)."""
        alone, times = _Circles([self]), np.array([time])
        state: Array = np.hstack([alone.positions(times)[0], alone.velocities(times)[0], time, 1.0])
        return state


@dataclass(frozen=True, slots=True)
class Wander(Law):
    """Closed polygon with short sides of equal length, at constant speed.

    Attributes:
        track: corners of the polygon [m].
        side: length of every side [m].
        speed: speed along the polygon [m/s].
        offset: distance travelled before time zero, from the first corner [m].
    """

    track: tuple[Point, ...]
    side: float
    speed: float
    offset: float = 0.0

    @property
    def length(self) -> float:
        """Length of the track [m]."""
        return self.side * len(self.track)

    @property
    def path(self) -> Path:
        """Path by the number of sides travelled."""
        n, corners = len(self.track), np.array(self.track)
        pieces = straight_pieces(corners, np.roll(corners, -1, axis=0) - corners)
        knots = np.arange(n + 1.0)
        return Path(
            knots, knots[:-1], pieces, self.offset, self.speed, unit=self.side, period=float(n)
        )


MotionLaw = Line | Shuttle | Circle | Passage | Wander | Track


def pace(motion: MotionLaw) -> float:
    """Return the speed of a mover while it moves, of a recorded one the maximum [m/s]."""
    return hypot(*motion.rate) if isinstance(motion, Line) else abs(motion.speed)


class Movers:
    """All moving obstacles of a layout, evaluated together.

    Args:
        motions: motion laws in layout order.
        intervals: begin and end of the presence of each mover [s]; default: always present.
        away: distance of an absent mover from its lane [m].
    """

    def __init__(
        self,
        motions: Sequence[MotionLaw],
        intervals: Sequence[Interval] | None = None,
        away: float = AWAY,
    ) -> None:
        self.motions = motions
        circles = {k: m for k, m in enumerate(motions) if isinstance(m, Circle)}
        paths = {k: m.path for k, m in enumerate(motions) if not isinstance(m, Circle)}
        self._kinds: list[tuple[list[int], Paths | _Circles]] = []
        if circles:
            self._kinds.append((list(circles), _Circles(list(circles.values()))))
        if paths:
            self._kinds.append((list(paths), Paths(list(paths.values()))))
        windows = np.reshape(intervals or [ALWAYS] * len(motions), (-1, 2))
        self._appearing = np.flatnonzero((windows != ALWAYS).any(axis=1))
        self._begin, self._end = windows[self._appearing].T
        self._away = away

    def __len__(self) -> int:
        return len(self.motions)

    def positions(self, time: float | Array, clocks: Array | None = None) -> Array:
        """Return the positions at `time` [s] (...), in layout order (..., n, 2) [m].

        Args:
            time: world time, which decides whether appearing movers are present.
            clocks: time of each mover on its lane (..., n) [s]; `time` by default.
        """
        times = np.asarray(time, dtype=float)
        positions = np.empty((*times.shape, len(self.motions), 2))
        for chosen, kind in self._kinds:
            own = times[..., None] if clocks is None else clocks[..., chosen]
            positions[..., chosen, :] = kind.positions(own)
        if len(self._appearing):
            positions[..., self._appearing, 0] += np.where(self._present(times), 0.0, self._away)
        return positions

    def velocities(self, time: float | Array, clocks: Array | None = None) -> Array:
        """Return the velocities by their own times in layout order (..., n, 2) [m/s].

        Arguments as in `positions`.
        """
        times = np.asarray(time, dtype=float)
        velocities = np.empty((*times.shape, len(self.motions), 2))
        for chosen, kind in self._kinds:
            own = times[..., None] if clocks is None else clocks[..., chosen]
            velocities[..., chosen, :] = kind.velocities(own)
        if len(self._appearing):
            velocities[..., self._appearing, :] *= self._present(times)[..., None]
        return velocities

    def top_speeds(self) -> Array:
        """Return the maximum speed of each mover, in layout order (n,) [m/s]."""
        return np.array([pace(motion) for motion in self.motions], dtype=float)

    def _present(self, times: Array) -> NDArray[np.bool_]:
        """Return whether the appearing movers are in the world (..., m)."""
        soon = times[..., None] + SAME_TIME
        present: NDArray[np.bool_] = (self._begin <= soon) & (soon < self._end)
        return present


class _Circles:
    """Circles, evaluated as `Paths`."""

    def __init__(self, laws: list[Circle]) -> None:
        table = np.array([(*c.centre, c.radius, c.speed, c.angle) for c in laws], dtype=float)
        self._centre, self._radius, self._angle = table[:, :2], table[:, 2:3], table[:, 4]
        self._speed, self._rate = table[:, 3:4], table[:, 3] / table[:, 2]

    def positions(self, times: Array) -> Array:
        angle = self._angle + self._rate * times
        positions: Array = self._centre + self._radius * np.stack(
            [np.cos(angle), np.sin(angle)], axis=-1
        )
        return positions

    def velocities(self, times: Array) -> Array:
        angle = self._angle + self._rate * times
        velocities: Array = self._speed * np.stack([-np.sin(angle), np.cos(angle)], axis=-1)
        return velocities
