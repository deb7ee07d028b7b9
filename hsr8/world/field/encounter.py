"""Encounters: movers on a collision course with a robot that walks straight at nominal speed."""

from collections.abc import Sequence
from itertools import pairwise
from math import cos, hypot, inf, sin, sqrt

import numpy as np

from hsr8.world.field.motion import Passage

Point = tuple[float, float]


class NominalWalk:
    """Straight lines from the start through all points at constant speed.

    Args:
        points: the start and the waypoints (n, 2), n >= 2 [m].
        speed: speed of the mover [m/s].
    """

    def __init__(self, points: Sequence[Point], speed: float) -> None:
        self._legs = list(pairwise(points))
        self._speed = speed
        self._ends = np.cumsum([_length(leg) for leg in self._legs]) / speed

    @property
    def duration(self) -> float:
        """Arrival time at the last point [s]."""
        return float(self._ends[-1])

    def at(self, time: float) -> tuple[Point, Point]:
        """Return position [m] and velocity [m/s] at `time` [s], up to the last point."""
        k = min(int(np.searchsorted(self._ends, time, side="right")), len(self._legs) - 1)
        leg = self._legs[k]
        length = _length(leg)
        rate = self._speed / length
        velocity = rate * (leg[1][0] - leg[0][0]), rate * (leg[1][1] - leg[0][1])
        back = time - float(self._ends[k])
        return (leg[1][0] + back * velocity[0], leg[1][1] + back * velocity[1]), velocity


def course_to(velocity: Point, speed: float, bearing: float) -> Point | None:
    """Return the velocity of a mover that approaches a walking robot at a constant bearing.

    Relative to the robot the mover closes in at a rate k: v_mover = v_robot - k u(bearing) with
    |v_mover| = speed.

    Args:
        velocity: velocity of the robot [m/s].
        speed: speed of the mover [m/s].
        bearing: bearing of the mover, from the direction of travel, counter-clockwise [rad].

    Returns:
        The velocity [m/s]; None if a mover of that speed cannot approach from there.
    """
    pace = hypot(*velocity)
    along = pace * cos(bearing)
    square = along * along + speed * speed - pace * pace
    if square <= 0.0:
        return None
    rate = along + sqrt(square)
    if rate <= 0.0:
        return None
    ahead_x, ahead_y = velocity[0] / pace, velocity[1] / pace
    sight_x = ahead_x * cos(bearing) - ahead_y * sin(bearing)
    sight_y = ahead_x * sin(bearing) + ahead_y * cos(bearing)
    return velocity[0] - rate * sight_x, velocity[1] - rate * sight_y


def passage_through(point: Point, velocity: Point, time: float, reach: Point) -> Passage | None:
    """Return a passage through `point` at `time` within a box around the origin.

    Args:
        point: position at `time` [m].
        velocity: velocity of the mover [m/s].
        time: time at `point` [s].
        reach: half sides of the box for its axis [m].

    Returns:
        The passage, from border to border or from its position at time zero; None if `point` is
        outside the box.
    """
    if abs(point[0]) >= reach[0] or abs(point[1]) >= reach[1]:
        return None
    before = min(time, _to_border(point, (-velocity[0], -velocity[1]), reach))
    after = _to_border(point, velocity, reach)
    return Passage(
        (point[0] - before * velocity[0], point[1] - before * velocity[1]),
        (point[0] + after * velocity[0], point[1] + after * velocity[1]),
        hypot(*velocity),
        depart=time - before,
    )


def _to_border(point: Point, velocity: Point, reach: Point) -> float:
    """Return the time until the border of the box [s]."""
    times = [
        ((r if v > 0.0 else -r) - p) / v if v else inf
        for p, v, r in zip(point, velocity, reach, strict=True)
    ]
    return min(times)


def _length(leg: tuple[Point, Point]) -> float:
    return hypot(leg[1][0] - leg[0][0], leg[1][1] - leg[0][1])


def starts_near(motion: Passage, walk: NominalWalk, room: float) -> bool:
    """Return whether a waiting mover departs nearer than `room` [m] to the nominal walk."""
    (x, y), _ = walk.at(motion.depart)
    return motion.depart > 0.0 and bool(hypot(motion.start[0] - x, motion.start[1] - y) < room)
