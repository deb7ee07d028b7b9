"""Rear check: the body turns until the gaze reaches the ground behind the robot.

The gaze does not reach all around. The planner therefore turns the body, a little while the robot
walks on, more if a look at the ground right behind is overdue, and sends the gaze a look request.
"""

from math import copysign, hypot

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap
from navigation.belief.belief import Belief, Motion
from navigation.motion import rear_check_kernel
from navigation.parameters.motion import RearCheckParameters
from navigation.value import value

Array = NDArray[np.float64]


@value
class Sector:
    """Ground out of reach of the gaze of a body that faces its course.

    Attributes:
        body_angle: minimum angle from the course to the heading at which the gaze reaches the
            whole sector, left positive [rad].
        bearing: of its rays from the course (n,) [rad].
        weight: of its urgency.
    """

    body_angle: float
    bearing: Array
    weight: float

    @property
    def middle(self) -> float:
        """Bearing of its middle from the course [rad]."""
        return 0.5 * float(self.bearing[0] + self.bearing[-1])

    @property
    def half_width(self) -> float:
        """Half its angular width [rad]."""
        return 0.5 * abs(float(self.bearing[-1] - self.bearing[0]))


class RearCheck:
    """State of the rear check: the sector that the body turns to, if any."""

    def __init__(
        self, parameters: RearCheckParameters, reach: float, s_robot: float, speed: float
    ) -> None:
        """Start without a sector.

        Args:
            parameters: angles and urgencies.
            reach: maximum bearing of the gaze to either side [rad].
            s_robot: radius of the robot [m].
            speed: maximum speed of the robot [m/s].
        """
        p = self._parameters = parameters
        self._s_robot = s_robot
        self._threat = (
            p.mover_speed * speed,
            s_robot,
            p.min_approach,
            p.min_time,
            p.max_age,
            p.max_urgency,
        )
        self._rings = np.array(p.rings)
        self._sectors = sectors(p, reach)
        self._weight = np.array([s.weight for s in self._sectors])
        self._bearing = np.concatenate([s.bearing for s in self._sectors])
        self._extent = np.array([(s.middle, s.half_width) for s in self._sectors])
        self._sector: int | None = None
        self._start = 0.0
        self._course = 0.0
        self._retry = 0.0

    def body_angle(self, belief: Belief, course: float, speed: float) -> float:
        """Return the angle from the course to the heading, left positive [rad].

        The sector is fixed in W, even if the course changes.

        Args:
            belief: of the robot.
            course: direction of motion in W [rad].
            speed: along the course [m/s].
        """
        p, now = self._parameters, belief.time
        if self._mover_near(belief):
            self._sector = None
            return 0.0
        if self._sector is not None:
            late = now - self._start > p.max_turn_time
            if late or self.urgency(belief, self._course, speed)[self._sector] < p.stop_urgency:
                self._sector = None
                self._retry = now + p.retry_delay if late else now
        if self._sector is None and now >= self._retry:
            weighted = self._weight * self.urgency(belief, course, speed)
            worst = int(np.argmax(weighted))
            if weighted[worst] > p.start_urgency:
                self._sector, self._start, self._course = worst, now, course
        if self._sector is None:
            return 0.0
        angle = self._sectors[self._sector].body_angle
        side = copysign(1.0, angle)
        return side * min(max(side * wrap(self._course + angle - course), 0.0), p.far_angle)

    def look_request(self) -> float | None:
        """Return the direction of the sector in W, None for none [rad]."""
        return None if self._sector is None else self._course + self._sectors[self._sector].middle

    def urgency(self, belief: Belief, course: float, speed: float) -> Array:
        """Return the urgency of a look at each sector (4,), for its ground or a lost mover.

        Args:
            belief: of the robot.
            course: direction of motion in W [rad].
            speed: along the course [m/s].
        """
        points = rear_check_kernel.ray_points(belief.pose, course, self._rings, self._bearing)
        urgency = rear_check_kernel.ground_urgency(
            belief.local_map.age_at(points),
            self._rings,
            self._bearing,
            speed,
            self._threat,
            len(self._sectors),
        )
        for track in belief.tracks:
            if track.particles is not None:
                lost = rear_check_kernel.cloud_urgency(
                    track.particles.positions,
                    track.particles.weights,
                    (track.age, track.radius, max(self._parameters.rings)),
                    belief.pose,
                    course,
                    self._extent,
                    speed,
                    self._threat,
                )
                urgency = np.maximum(urgency, lost)
        return urgency

    def _mover_near(self, belief: Belief) -> bool:
        """Whether a non-static track is too near for a rear check."""
        reach = self._parameters.clearance + self._s_robot
        x, y, _ = belief.pose.tolist()
        for track in belief.tracks:
            if track.motion is not Motion.STATIC:
                u, v = track.position.tolist()
                if hypot(u - x, v - y) < reach + track.radius:
                    return True
        return False


def sectors(parameters: RearCheckParameters, reach: float) -> tuple[Sector, ...]:
    """Return the sectors just beyond the gaze's `reach` [rad] and right behind, on both sides."""
    p = parameters
    return tuple(
        Sector(side * angle, side * np.linspace(reach + start, reach + angle, p.rays), weight)
        for side in (1.0, -1.0)
        for start, angle, weight in (
            (0.0, p.near_angle, 1.0),
            (p.near_angle, p.far_angle, p.far_weight),
        )
    )
