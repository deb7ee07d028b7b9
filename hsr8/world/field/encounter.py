"""Collision courses: movers that would meet a robot walking straight on at a nominal pace."""

from collections.abc import Sequence
from itertools import pairwise
from math import cos, hypot, inf, sin, sqrt

import numpy as np

from hsr8.world.field.motion import Passage

Point = tuple[float, float]


class NominalWalk:
    """Straight lines from the start through all points at constant speed.

    Args:
        places: the start and the points (n, 2), n >= 2 [m].
        speed: [m/s].
    """

    def __init__(self, places: Sequence[Point], speed: float) -> None:
        self._legs = list(pairwise(places))
        self._speed = speed
        self._ends = np.cumsum([_length(leg) for leg in self._legs]) / speed

    @property
    def duration(self) -> float:
        """Time at which it arrives at the last point [s]."""
        return float(self._ends[-1])

    def at(self, time: float) -> tuple[Point, Point]:
        """Position [m] and velocity [m/s] at `time` [s], not after the last point."""
        k = min(int(np.searchsorted(self._ends, time, side="right")), len(self._legs) - 1)
        leg = self._legs[k]
        length = _length(leg)
        rate = self._speed / length
        velocity = rate * (leg[1][0] - leg[0][0]), rate * (leg[1][1] - leg[0][1])
        back = time - float(self._ends[k])
        return (leg[1][0] + back * velocity[0], leg[1][1] + back * velocity[1]), velocity


def course_to(velocity: Point, speed: float, bearing: float) -> Point | None:
    """Velocity of a mover that a walking robot sees come under a constant bearing.

    Bearing and velocities make a triangle: seen from the robot the mover comes straight
    towards it, at a rate k: v_mover = v_robot - k u(bearing), |v_mover| = speed.

    Args:
        velocity: of the robot [m/s].
        speed: of the mover [m/s].
        bearing: of the mover, from the robot's way, counter-clockwise [rad].

    Returns:
        The velocity [m/s]; None if a mover of that speed cannot come from there.
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
    see_x = ahead_x * cos(bearing) - ahead_y * sin(bearing)
    see_y = ahead_x * sin(bearing) + ahead_y * cos(bearing)
    return velocity[0] - rate * see_x, velocity[1] - rate * see_y


def passage_through(place: Point, velocity: Point, time: float, reach: Point) -> Passage | None:
    """Passage that is at `place` at `time` and stays in a box around the origin.

    Args:
        place: where it meets [m].
        velocity: with which it meets [m/s].
        time: when it meets [s].
        reach: half sides of the box for its axis [m].

    Returns:
        The law, from rim to rim or from where it must be at time zero; None if `place`
        is outside.
    """
    if abs(place[0]) >= reach[0] or abs(place[1]) >= reach[1]:
        return None
    before = min(time, _to_rim(place, (-velocity[0], -velocity[1]), reach))
    after = _to_rim(place, velocity, reach)
    return Passage(
        (place[0] - before * velocity[0], place[1] - before * velocity[1]),
        (place[0] + after * velocity[0], place[1] + after * velocity[1]),
        hypot(*velocity),
        depart=time - before,
    )


def _to_rim(place: Point, velocity: Point, reach: Point) -> float:
    """Time until the rim of the box [s]."""
    times = [
        ((r if v > 0.0 else -r) - p) / v if v else inf
        for p, v, r in zip(place, velocity, reach, strict=True)
    ]
    return min(times)


def _length(leg: tuple[Point, Point]) -> float:
    return hypot(leg[1][0] - leg[0][0], leg[1][1] - leg[0][1])
