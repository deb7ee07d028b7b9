"""Motion laws of moving obstacles: exact position and velocity at any time."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import hypot, inf
from typing import Any, Protocol, cast

import numpy as np
from numpy.typing import NDArray

from hsr8.scenario.track import AWAY, Track, TrackTable

Array = NDArray[np.float64]
Point = tuple[float, float]

SAME_TIME = 1e-6  # times closer than this are equal [s]


class _Law:
    """Motion law, evaluated as the only one of `Movers`."""

    __slots__ = ()

    def positions(self, times: Array) -> Array:
        """Return the positions at `times` (...) [s] (..., 2) [m]."""
        positions: Array = self._alone().positions(times)[..., 0, :]
        return positions

    def position(self, time: float) -> Point:
        """Return the position at `time` [s]."""
        x, y = self.positions(np.asarray(time)).tolist()
        return x, y

    def velocity(self, time: float) -> Point:
        """Return the velocity at `time` [m/s]; where it jumps, the velocity after it."""
        x, y = self._alone().velocities(time)[0].tolist()
        return x, y

    def _alone(self) -> "Movers":
        return Movers((cast("MotionLaw", self),))  # every subclass is one


@dataclass(frozen=True, slots=True)
class Line(_Law):
    """Straight line at constant velocity.

    Attributes:
        start: position at time zero [m].
        rate: velocity [m/s].
    """

    start: Point
    rate: Point


@dataclass(frozen=True, slots=True)
class _Segment(_Law):
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


@dataclass(frozen=True, slots=True)
class Passage(_Segment):
    """One straight move at constant speed; the mover waits at `start` and stays at `end`.

    Attributes:
        depart: time of the departure [s].
    """

    depart: float = 0.0


@dataclass(frozen=True, slots=True)
class Circle(_Law):
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


@dataclass(frozen=True, slots=True)
class Wander(_Law):
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


@dataclass(frozen=True, slots=True)
class Appearing(_Law):
    """Another motion during an interval; outside it the mover is far away.

    Attributes:
        motion: motion while the mover is present.
        start: begin of the interval [s].
        end: end of the interval [s].
        away: distance from the lane outside the interval [m].
    """

    motion: "MotionLaw"
    start: float
    end: float = inf
    away: float = AWAY


MotionLaw = Line | Shuttle | Circle | Passage | Wander | Track | Appearing


def pace(motion: MotionLaw) -> float:
    """Return the speed of a mover while it moves, of a recorded one the maximum [m/s]."""
    match motion:
        case Appearing():
            return pace(motion.motion)
        case Line():
            return hypot(*motion.rate)
    return abs(motion.speed)


class _Kind(Protocol):
    """Movers of one kind, evaluated together, each at its own time or all at one time."""

    def positions(self, times: Array) -> Array:
        """Return the positions at `times` (..., n or 1) [s] (..., n, 2) [m]."""

    def velocities(self, times: Array) -> Array:
        """Return the velocities at `times` (..., n or 1) [s] (..., n, 2) [m/s]."""


class Movers:
    """All moving obstacles of a layout, those of each kind evaluated together.

    Args:
        motions: motion laws in layout order.
    """

    def __init__(self, motions: tuple[MotionLaw, ...]) -> None:
        self.motions = motions
        laws = [motion.motion if isinstance(motion, Appearing) else motion for motion in motions]
        self._kinds: list[tuple[NDArray[np.intp], _Kind]] = []
        for classes, kind in _KINDS:
            chosen = [k for k, motion in enumerate(laws) if isinstance(motion, classes)]
            if chosen:
                self._kinds.append((np.array(chosen), kind([laws[k] for k in chosen])))
        appearing = [(k, m) for k, m in enumerate(motions) if isinstance(m, Appearing)]
        self._appearing = np.array([k for k, _ in appearing], dtype=np.intp)
        rows = [(motion.start, motion.end, motion.away) for _, motion in appearing]
        self._start, self._end, self._away = np.reshape(rows, (-1, 3)).T

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
        present: NDArray[np.bool_] = (self._start <= soon) & (soon < self._end)
        return present


class _Lanes:
    """Lines and shuttles."""

    def __init__(self, laws: Sequence[Line | Shuttle]) -> None:
        lanes = np.array([_lane(motion) for motion in laws], dtype=float)
        self._origin, self._direction = lanes[:, :2], lanes[:, 2:4]
        self._speed, self._period, self._offset = lanes[:, 4], 2.0 * lanes[:, 5], lanes[:, 6]

    def positions(self, times: Array) -> Array:
        travelled = self._travelled(times)
        along = np.minimum(travelled, self._period - travelled)[..., None]
        positions: Array = self._origin + along * self._direction
        return positions

    def velocities(self, times: Array) -> Array:
        there = self._travelled(times) < 0.5 * self._period
        rates: Array = np.where(there, self._speed, -self._speed)[..., None] * self._direction
        return rates

    def _travelled(self, times: Array) -> Array:
        travelled: Array = np.mod(self._offset + self._speed * times, self._period)
        return travelled


class _Circles:
    """Circles."""

    def __init__(self, laws: Sequence[Circle]) -> None:
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


class _Passages:
    """Passages."""

    def __init__(self, laws: Sequence[Passage]) -> None:
        self._start = np.array([motion.start for motion in laws])
        self._along = np.array([motion.end for motion in laws]) - self._start
        table = np.array([(motion.speed, motion.depart, motion.length) for motion in laws])
        self._speed, self._depart, self._length = table.T

    def positions(self, times: Array) -> Array:
        fraction = np.clip(self._travelled(times) / self._length, 0.0, 1.0)
        positions: Array = self._start + fraction[..., None] * self._along
        return positions

    def velocities(self, times: Array) -> Array:
        travelled = self._travelled(times)
        moves = (travelled >= 0.0) & (travelled < self._length)
        rate = np.where(moves, self._speed / self._length, 0.0)
        velocities: Array = rate[..., None] * self._along
        return velocities

    def _travelled(self, times: Array) -> Array:
        travelled: Array = self._speed * (times - self._depart)
        return travelled


class _Wanders:
    """Closed polygons, which have equally many corners."""

    def __init__(self, laws: Sequence[Wander]) -> None:
        self._corners = np.array([motion.track for motion in laws])
        self._rows = np.arange(len(laws))
        table = np.array([(motion.side, motion.speed, motion.offset) for motion in laws])
        self._side, self._speed, self._offset = table.T

    def positions(self, times: Array) -> Array:
        corner, along, fraction = self._sides(times)
        positions: Array = corner + fraction[..., None] * along
        return positions

    def velocities(self, times: Array) -> Array:
        _, along, _ = self._sides(times)
        velocities: Array = (self._speed / self._side)[:, None] * along
        return velocities

    def _sides(self, times: Array) -> tuple[Array, Array, Array]:
        """Return the last corner, the vector to the next one, and the travelled fraction."""
        sides = (self._offset + self._speed * times) / self._side
        whole = np.floor(sides)
        n = self._corners.shape[1]
        last = whole.astype(np.intp) % n
        corner = self._corners[self._rows, last]
        return corner, self._corners[self._rows, (last + 1) % n] - corner, sides - whole


_KINDS: tuple[tuple[Any, Callable[[Sequence[Any]], _Kind]], ...] = (
    ((Line, Shuttle), _Lanes),
    (Circle, _Circles),
    (Passage, _Passages),
    (Wander, _Wanders),
    (Track, TrackTable),
)


def _lane(motion: Line | Shuttle) -> tuple[float, ...]:
    """Return origin, unit direction, speed, length and offset of a straight motion."""
    if isinstance(motion, Shuttle):
        length, start, end = motion.length, motion.start, motion.end
        x, y = (end[0] - start[0]) / length, (end[1] - start[1]) / length
        return *motion.start, x, y, motion.speed, length, motion.offset
    speed = hypot(*motion.rate)
    x, y = (motion.rate[0] / speed, motion.rate[1] / speed) if speed > 0.0 else (0.0, 0.0)
    return *motion.start, x, y, speed, inf, 0.0
