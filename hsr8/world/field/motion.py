"""Motion laws: where a moving obstacle is at any time, exactly, with no integration."""

from dataclasses import dataclass
from math import cos, fmod, hypot, inf, sin

import numpy as np
from numpy.typing import NDArray

from hsr8.world.field import motion_kernel
from hsr8.world.field.passage import Passage
from hsr8.world.field.wander import Wander

Array = NDArray[np.float64]
Point = tuple[float, float]

AWAY = 60.0  # what is away is so far from its place: nothing sees it there [m]
INSTANT = 1e-6  # times nearer to one another are the same [s]


@dataclass(frozen=True, slots=True)
class Line:
    """Straight on at constant velocity.

    Attributes:
        start: position at time zero [m].
        rate: velocity [m/s].
    """

    start: Point
    rate: Point

    def position(self, time: float) -> Point:
        """Position at `time` [s]."""
        return self.start[0] + self.rate[0] * time, self.start[1] + self.rate[1] * time

    def velocity(self, time: float) -> Point:
        """Velocity at `time` [m/s]."""
        return self.rate


@dataclass(frozen=True, slots=True)
class Shuttle:
    """Back and forth between two points at constant speed, turning about at once.

    Attributes:
        start: one end [m].
        end: the other [m].
        speed: [m/s].
        offset: way it has gone at time zero, from `start` to `end` and back [m].
    """

    start: Point
    end: Point
    speed: float
    offset: float = 0.0

    @property
    def length(self) -> float:
        """Distance between the ends [m]."""
        return hypot(self.end[0] - self.start[0], self.end[1] - self.start[1])

    def position(self, time: float) -> Point:
        """Position at `time` [s]."""
        length = self.length
        gone = fmod(self.offset + self.speed * time, 2.0 * length)
        share = min(gone, 2.0 * length - gone) / length
        return (
            self.start[0] + share * (self.end[0] - self.start[0]),
            self.start[1] + share * (self.end[1] - self.start[1]),
        )

    def velocity(self, time: float) -> Point:
        """Velocity at `time` [m/s]; at an end, the one it leaves with."""
        length = self.length
        gone = fmod(self.offset + self.speed * time, 2.0 * length)
        rate = (self.speed if gone < length else -self.speed) / length
        return rate * (self.end[0] - self.start[0]), rate * (self.end[1] - self.start[1])


@dataclass(frozen=True, slots=True)
class Circle:
    """Round a circle at constant speed.

    Attributes:
        centre: [m].
        radius: of the path [m].
        speed: counter-clockwise positive [m/s].
        angle: where on the circle it is at time zero [rad].
    """

    centre: Point
    radius: float
    speed: float
    angle: float = 0.0

    def position(self, time: float) -> Point:
        """Position at `time` [s]."""
        angle = self.angle + self.speed / self.radius * time
        return (
            self.centre[0] + self.radius * cos(angle),
            self.centre[1] + self.radius * sin(angle),
        )

    def velocity(self, time: float) -> Point:
        """Velocity at `time` [m/s]."""
        angle = self.angle + self.speed / self.radius * time
        return -self.speed * sin(angle), self.speed * cos(angle)


@dataclass(frozen=True, slots=True)
class Appearing:
    """Another law for some time; before and after it the mover is far away.

    Attributes:
        law: what it does while it is there.
        start: when it appears [s].
        end: when it is gone again [s].
    """

    law: "MotionLaw"
    start: float
    end: float = inf

    def position(self, time: float) -> Point:
        """Position at `time` [s]."""
        x, y = self.law.position(time)
        return (x, y) if self._there(time) else (x + AWAY, y)

    def velocity(self, time: float) -> Point:
        """Velocity at `time` [m/s]; none while it is away."""
        return self.law.velocity(time) if self._there(time) else (0.0, 0.0)

    def _there(self, time: float) -> bool:
        return self.start <= time + INSTANT < self.end


MotionLaw = Line | Shuttle | Circle | Passage | Wander | Appearing


def pace(law: MotionLaw) -> float:
    """Speed of a mover when it moves [m/s]."""
    match law:
        case Appearing():
            return pace(law.law)
        case Line():
            return hypot(*law.rate)
    return abs(law.speed)


class Movers:
    """All moving obstacles of a layout, evaluated together.

    Straight laws are one formula: a point walks `rate` along a lane of some length, which
    is infinite when it never turns about. Circles are another; the rest is asked one by one.
    """

    def __init__(self, laws: tuple[MotionLaw, ...]) -> None:
        """Take the laws in layout order."""
        self.laws = laws
        straight = [k for k, law in enumerate(laws) if isinstance(law, Line | Shuttle)]
        round_ = [k for k, law in enumerate(laws) if isinstance(law, Circle)]
        self._others = [
            (k, w) for k, w in enumerate(laws) if isinstance(w, Passage | Wander | Appearing)
        ]
        self._all_straight = len(straight) == len(laws)
        self._straight = np.array(straight, dtype=np.intp)
        self._round = np.array(round_, dtype=np.intp)
        lanes = [_lane(laws[k]) for k in straight]
        self._lanes = (
            np.array([lane[0] for lane in lanes], dtype=float).reshape(-1, 2),
            np.array([lane[1] for lane in lanes], dtype=float).reshape(-1, 2),
            np.array([lane[2] for lane in lanes], dtype=float),
            np.array([lane[3] for lane in lanes], dtype=float),
            np.array([lane[4] for lane in lanes], dtype=float),
        )
        circles = [law for law in laws if isinstance(law, Circle)]
        self._centre = np.array([c.centre for c in circles], dtype=float).reshape(-1, 2)
        self._radius = np.array([c.radius for c in circles], dtype=float)
        self._rim_speed = np.array([c.speed for c in circles], dtype=float)
        self._angle = np.array([c.angle for c in circles], dtype=float)

    def __len__(self) -> int:
        return len(self.laws)

    def positions(self, time: float | Array) -> Array:
        """Positions at `time` [s], of any shape (...), in layout order (..., n, 2) [m]."""
        times = np.asarray(time, dtype=float)
        found = motion_kernel.positions(times.ravel(), self._lanes)
        straight: Array = found.reshape(*times.shape, -1, 2)
        if self._all_straight:
            return straight
        angle = self._angle + self._rim_speed / self._radius * times[..., None]
        rim = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
        both = self._ordered(straight, self._centre + self._radius[:, None] * rim)
        for k, law in self._others:
            places = [law.position(instant) for instant in times.ravel().tolist()]
            both[..., k, :] = np.reshape(places, both[..., k, :].shape)
        return both

    def velocities(self, time: float) -> Array:
        """Velocities at `time` [s], layout order (n, 2) [m/s]."""
        straight: Array = motion_kernel.velocities(time, self._lanes)
        if self._all_straight:
            return straight
        angle = self._angle + self._rim_speed / self._radius * time
        rim = np.stack([-np.sin(angle), np.cos(angle)], axis=1)
        both = self._ordered(straight, self._rim_speed[:, None] * rim)
        for k, law in self._others:
            both[k] = law.velocity(time)
        return both

    def top_speeds(self) -> Array:
        """Greatest speed that each ever has, layout order (n,) [m/s]."""
        return np.array([pace(law) for law in self.laws], dtype=float)

    def _ordered(self, straight: Array, rim: Array) -> Array:
        both = np.empty((*straight.shape[:-2], len(self.laws), 2))
        both[..., self._straight, :] = straight
        both[..., self._round, :] = rim
        return both


def _lane(law: MotionLaw) -> tuple[Point, Point, float, float, float]:
    """Origin, unit direction, speed, length and offset of a straight law."""
    if isinstance(law, Shuttle):
        way = (
            (law.end[0] - law.start[0]) / law.length,
            (law.end[1] - law.start[1]) / law.length,
        )
        return law.start, way, law.speed, law.length, law.offset
    if isinstance(law, Line):
        speed = hypot(*law.rate)
        way = (law.rate[0] / speed, law.rate[1] / speed) if speed > 0.0 else (0.0, 0.0)
        return law.start, way, speed, inf, 0.0
    raise TypeError(f"{type(law).__name__} is no straight law")
