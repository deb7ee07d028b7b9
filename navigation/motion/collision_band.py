"""Collision band of a mover and the collision cases of Yoo & Kim, Fig. 4."""

from enum import StrEnum
from itertools import pairwise
from math import hypot, inf, isfinite, sqrt

import numpy as np
from numpy.typing import NDArray

from compilation.value import value
from navigation.motion.rollout import contact_time
from navigation.transform import rotate

Array = NDArray[np.float64]


class CollisionCase(StrEnum):
    """Collision case of a robot on a straight line (letters of Fig. 4).

    CROSSING: (a) outside the band, the line crosses it.
    ESCAPE: (b) inside the band; a fast enough robot leaves it, perhaps faster than v_max.
    DEFINITE: (c) inside the band and no speed up to v_max is free.
    RECEDING: (d) outside the band, walking towards the mover; standing is safe.
    """

    CROSSING = "a"
    ESCAPE = "b"
    DEFINITE = "c"
    RECEDING = "d"


@value
class Encounter:
    """One mover in axes of the line of motion of the robot, x along the motion.

    Attributes:
        along, across: p_ro, from the robot to the mover [m].
        forward, left: velocity v_o of the mover over ground [m/s].
        radius: distance S below which the two collide [m].
    """

    along: float
    across: float
    forward: float
    left: float
    radius: float

    @classmethod
    def on_line(
        cls, direction: float, offset: Array, velocity: Array, radius: float
    ) -> "Encounter":
        """Transform p_ro (2,) [m] and v_o (2,) [m/s] from W to a line in `direction` [rad]."""
        x, y = offset.tolist()
        vx, vy = velocity.tolist()
        return cls(*rotate(-direction, (x, y)), *rotate(-direction, (vx, vy)), radius)

    def contact_time(self, speed: float) -> float:
        """Return the time to collision at constant `speed` [m/s]: inf for none, 0 inside [s]."""
        u, w = self.forward - speed, self.left
        outside = self.along**2 + self.across**2 - self.radius**2
        rate = self.along * u + self.across * w
        return inf if rate >= 0.0 else contact_time(rate, u * u + w * w, outside)

    def collides(self, speed: float, horizon: float) -> bool:
        """Whether constant `speed` [m/s] leads to a collision within `horizon` [s]."""
        time = self.contact_time(speed)
        return isfinite(time) and time <= horizon

    def band(self) -> tuple[float, float]:
        """Return (al, lat), the robot's position along and left of the mover's path [m]."""
        speed = hypot(self.forward, self.left)
        if speed == 0.0:
            return 0.0, inf
        x, y = self.forward / speed, self.left / speed
        return -(self.along * x + self.across * y), -(x * self.across - y * self.along)

    def in_band(self) -> bool:
        """Whether the mover collides with a standing robot: R_coll of Fig. 4."""
        al, lat = self.band()
        return abs(lat) < self.radius and al > 0.0

    def crossing_speeds(self) -> tuple[float, ...]:
        """Return v_c of Fig. 4, roots of A v² + B v + C: the robot just touches the mover.

        A = b² - S², B = 2 (S² v_o.e - a b), C = a² - S² |v_o|², with a = cross(p_ro, v_o)
        and b = cross(p_ro, e).
        """
        s2 = self.radius**2
        a = self.along * self.left - self.across * self.forward
        b = -self.across
        qa = b * b - s2
        qb = 2.0 * (s2 * self.forward - a * b)
        qc = a * a - s2 * (self.forward**2 + self.left**2)
        if abs(qa) < 1e-12:
            return (-qc / qb,) if abs(qb) > 1e-12 else ()
        discriminant = qb * qb - 4.0 * qa * qc
        if discriminant < 0.0:
            return ()
        root = sqrt(discriminant)
        low, high = sorted(((-qb - root) / (2.0 * qa), (-qb + root) / (2.0 * qa)))
        return low, high

    def touch_time(self, speed: float) -> float:
        """Return t_c = -p_ro.w/|w|², w = v_o - v e, for a `speed` [m/s] that just touches [s].

        The point of contact of Fig. 4 is p_oc = v t_c on the line of motion. Inf if `speed`
        passes at a distance or cuts through.
        """
        u, w = self.forward - speed, self.left
        square = u * u + w * w
        if square == 0.0:
            return inf
        time = -(self.along * u + self.across * w) / square
        gap = (self.along + u * time) ** 2 + (self.across + w * time) ** 2
        touches = abs(gap - self.radius**2) < 1e-6
        return time if touches and time > 0.0 else inf

    def breakpoints(self, horizon: float) -> tuple[float, ...]:
        """Return all speeds at which `collides` within `horizon` [s] can change [m/s]."""
        points = list(self.crossing_speeds())
        if self.along != 0.0:
            points.append(self.forward + self.across * self.left / self.along)
        if isfinite(horizon):
            across = self.across + self.left * horizon
            reach = self.radius**2 - across**2
            if reach > 0.0:
                along = self.along + self.forward * horizon
                points += [(along - sqrt(reach)) / horizon, (along + sqrt(reach)) / horizon]
        return tuple(points)

    def case(self, v_max: float, horizon: float) -> CollisionCase | None:
        """Return the letter of Fig. 4; None if no speed collides.

        Args:
            v_max: maximum speed of the robot [m/s].
            horizon: maximum time to collision [s].

        Case (c) of the paper contains slower movers from behind, for which some speeds are
        free; they are case (b) here.
        """
        meets_line = abs(self.across) < self.radius
        free = free_intervals((self,), v_max, horizon)
        if self.in_band():
            return CollisionCase.ESCAPE if free or not meets_line else CollisionCase.DEFINITE
        if free == [(0.0, v_max)]:
            return None
        return CollisionCase.RECEDING if meets_line else CollisionCase.CROSSING


def free_intervals(
    encounters: tuple[Encounter, ...], v_max: float, horizon: float
) -> list[tuple[float, float]]:
    """Return the closed intervals of speeds in [0, v_max] without collision before `horizon` [s].

    One test between two successive breakpoints decides the interval. Several movers give the
    union of their colliding intervals.
    """
    inner = {v for e in encounters for v in e.breakpoints(horizon) if 0.0 < v < v_max}
    cuts = sorted({0.0, v_max, *inner})
    intervals: list[tuple[float, float]] = []
    for low, high in pairwise(cuts):
        middle = 0.5 * (low + high)
        if not any(e.collides(middle, horizon) for e in encounters):
            joins = bool(intervals) and intervals[-1][1] == low
            start = intervals.pop()[0] if joins else low
            intervals.append((start, high))
    return intervals
