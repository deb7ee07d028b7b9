"""Motion laws of moving obstacles: exact position and velocity at any time."""

from dataclasses import dataclass
from math import cos, fmod, hypot, inf, sin

import numpy as np
from numpy.typing import NDArray

from hsr8.scenario.crowd import AWAY
from hsr8.scenario.track import Track
from hsr8.scenario.track_table import TrackTable
from hsr8.world.field.wander import Wander

Array = NDArray[np.float64]
Point = tuple[float, float]

SAME_TIME = 1e-6  # times closer than this are equal [s]


@dataclass(frozen=True, slots=True)
class Line:
    """Straight line at constant velocity.

    Attributes:
        start: position at time zero [m].
        rate: velocity [m/s].
    """

    start: Point
    rate: Point

    def position(self, time: float) -> Point:
        """Return the position at `time` [s]."""
        return self.start[0] + self.rate[0] * time, self.start[1] + self.rate[1] * time

    def velocity(self, time: float) -> Point:
        """Return the velocity at `time` [m/s]."""
        return self.rate


@dataclass(frozen=True, slots=True)
class _Segment:
    """Line between two points.

    Attributes:
        start: [m].
        end: [m].
        speed: along the line [m/s].
    """

    start: Point
    end: Point
    speed: float

    @property
    def length(self) -> float:
        """Distance between the points [m]."""
        return hypot(self.end[0] - self.start[0], self.end[1] - self.start[1])

    def _at(self, fraction: float) -> Point:
        (x, y), (end_x, end_y) = self.start, self.end
        return x + fraction * (end_x - x), y + fraction * (end_y - y)

    def _along(self, rate: float) -> Point:
        return rate * (self.end[0] - self.start[0]), rate * (self.end[1] - self.start[1])


@dataclass(frozen=True, slots=True)
class Shuttle(_Segment):
    """Back and forth between two points at constant speed, reversing at once.

    Attributes:
        offset: distance travelled before time zero, from `start` to `end` and back [m].
    """

    offset: float = 0.0

    def position(self, time: float) -> Point:
        """Return the position at `time` [s]."""
        length = self.length
        travelled = fmod(self.offset + self.speed * time, 2.0 * length)
        return self._at(min(travelled, 2.0 * length - travelled) / length)

    def velocity(self, time: float) -> Point:
        """Return the velocity at `time` [m/s]; at an end, the velocity after it."""
        length = self.length
        travelled = fmod(self.offset + self.speed * time, 2.0 * length)
        return self._along((self.speed if travelled < length else -self.speed) / length)


@dataclass(frozen=True, slots=True)
class Passage(_Segment):
    """One straight move at constant speed; the mover waits at `start` and stays at `end`.

    Attributes:
        depart: time of the departure [s].
    """

    depart: float = 0.0

    def position(self, time: float) -> Point:
        """Return the position at `time` [s]."""
        travelled = self.speed * (time - self.depart)
        return self._at(min(max(travelled / self.length, 0.0), 1.0))

    def velocity(self, time: float) -> Point:
        """Return the velocity at `time` [m/s]; at an end, the velocity after it."""
        travelled, length = self.speed * (time - self.depart), self.length
        return self._along(self.speed / length) if 0.0 <= travelled < length else (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Circle:
    """Circle at constant speed.

    Attributes:
        centre: [m].
        radius: of the path [m].
        speed: counter-clockwise positive [m/s].
        angle: on the circle at time zero [rad].
    """

    centre: Point
    radius: float
    speed: float
    angle: float = 0.0

    def position(self, time: float) -> Point:
        """Return the position at `time` [s]."""
        angle = self.angle + self.speed / self.radius * time
        return (
            self.centre[0] + self.radius * cos(angle),
            self.centre[1] + self.radius * sin(angle),
        )

    def velocity(self, time: float) -> Point:
        """Return the velocity at `time` [m/s]."""
        angle = self.angle + self.speed / self.radius * time
        return -self.speed * sin(angle), self.speed * cos(angle)


@dataclass(frozen=True, slots=True)
class Appearing:
    """Another motion during an interval; outside it the mover is far away.

    Attributes:
        motion: while the mover is present.
        start: of the interval [s].
        end: of the interval [s].
        away: distance from the lane outside the interval [m].
    """

    motion: "MotionLaw"
    start: float
    end: float = inf
    away: float = AWAY

    def position(self, time: float) -> Point:
        """Return the position at `time` [s]."""
        x, y = self.motion.position(time)
        return (x, y) if self._present(time) else (x + self.away, y)

    def velocity(self, time: float) -> Point:
        """Return the velocity at `time` [m/s]; zero while the mover is away."""
        return self.motion.velocity(time) if self._present(time) else (0.0, 0.0)

    def _present(self, time: float) -> bool:
        return self.start <= time + SAME_TIME < self.end


MotionLaw = Line | Shuttle | Circle | Passage | Wander | Appearing | Track


def pace(motion: MotionLaw) -> float:
    """Return the speed of a mover while it moves, of a recorded one the maximum [m/s]."""
    match motion:
        case Appearing():
            return pace(motion.motion)
        case Line():
            return hypot(*motion.rate)
    return abs(motion.speed)


class Movers:
    """All moving obstacles of a layout, evaluated together.

    Lines, shuttles, circles and tracks are evaluated as arrays, other motions one by one.

    Args:
        motions: in layout order.
    """

    def __init__(self, motions: tuple[MotionLaw, ...]) -> None:
        self.motions = motions
        straight = {k: _lane(w) for k, w in enumerate(motions) if isinstance(w, Line | Shuttle)}
        circles = {k: c for k, c in enumerate(motions) if isinstance(c, Circle)}
        tracks = {k: track for k, track in enumerate(motions) if isinstance(track, Track)}
        self._tracks = list(tracks)
        self._table = TrackTable(list(tracks.values())) if tracks else None
        other = Passage | Wander | Appearing
        self._others = [
            (k, motion) for k, motion in enumerate(motions) if isinstance(motion, other)
        ]
        self._straight = np.array(list(straight), dtype=np.intp)
        lanes = np.array(list(straight.values()), dtype=float).reshape(-1, 7)
        self._origin, self._direction = lanes[:, :2], lanes[:, 2:4]
        self._speed, self._period, self._offset = lanes[:, 4], 2.0 * lanes[:, 5], lanes[:, 6]
        self._circles = np.array(list(circles), dtype=np.intp)
        rows = [(*c.centre, c.radius, c.speed, c.angle) for c in circles.values()]
        table = np.array(rows, dtype=float).reshape(-1, 5)
        self._centre, self._radius, self._angle = table[:, :2], table[:, 2:3], table[:, 4]
        self._circle_speed, self._rate = table[:, 3:4], table[:, 3] / table[:, 2]

    def __len__(self) -> int:
        return len(self.motions)

    def positions(self, time: float | Array) -> Array:
        """Return the positions at `time` [s] (...), in layout order (..., n, 2) [m]."""
        times = np.asarray(time, dtype=float)
        positions = np.empty((*times.shape, len(self.motions), 2))
        if len(self._straight):
            travelled = np.mod(self._offset + self._speed * times[..., None], self._period)
            along = np.minimum(travelled, self._period - travelled)[..., None]
            positions[..., self._straight, :] = self._origin + along * self._direction
        if len(self._circles):
            angle = self._angle + self._rate * times[..., None]
            unit = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
            positions[..., self._circles, :] = self._centre + self._radius * unit
        if self._table is not None:
            positions[..., self._tracks, :] = self._table.positions(times)
        for k, motion in self._others:
            points = [motion.position(instant) for instant in times.ravel().tolist()]
            positions[..., k, :] = np.reshape(points, (*times.shape, 2))
        return positions

    def velocities(self, time: float) -> Array:
        """Return the velocities at `time` [s], in layout order (n, 2) [m/s]."""
        velocities = np.empty((len(self.motions), 2))
        if len(self._straight):
            travelled = np.mod(self._offset + self._speed * time, self._period)
            rate = np.where(travelled < 0.5 * self._period, self._speed, -self._speed)
            velocities[self._straight] = rate[:, None] * self._direction
        if len(self._circles):
            angle = self._angle + self._rate * time
            unit = np.stack([-np.sin(angle), np.cos(angle)], axis=1)
            velocities[self._circles] = self._circle_speed * unit
        if self._table is not None:
            velocities[self._tracks] = self._table.velocities(time)
        for k, motion in self._others:
            velocities[k] = motion.velocity(time)
        return velocities

    def top_speeds(self) -> Array:
        """Return the maximum speed of each mover, in layout order (n,) [m/s]."""
        return np.array([pace(motion) for motion in self.motions], dtype=float)


def _lane(motion: Line | Shuttle) -> tuple[float, ...]:
    """Return origin, unit direction, speed, length and offset of a straight motion."""
    if isinstance(motion, Shuttle):
        length, start, end = motion.length, motion.start, motion.end
        x, y = (end[0] - start[0]) / length, (end[1] - start[1]) / length
        return *motion.start, x, y, motion.speed, length, motion.offset
    speed = hypot(*motion.rate)
    x, y = (motion.rate[0] / speed, motion.rate[1] / speed) if speed > 0.0 else (0.0, 0.0)
    return *motion.start, x, y, speed, inf, 0.0
