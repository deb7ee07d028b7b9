"""Looks over the shoulder: the body turns aside until the gaze has reached the ground behind.

The head does not reach all around, so whatever comes up from behind stays unseen however the
gaze is chosen. The planner therefore turns the body, a little while it walks on, more when the
ground right behind is due, and tells the gaze what it turned for.
"""

from math import copysign, hypot

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap
from navigation.belief.belief import Belief, Motion, Track
from navigation.motion import rear_check_kernel
from navigation.parameters.motion import RearCheckParameters
from navigation.value import value

Array = NDArray[np.float64]


@value
class Sector:
    """Ground that the gaze reaches only if the body turns aside.

    Attributes:
        aside: angle of the body to its way from which all of it is reached, left positive [rad].
        bearing: of its rays from the way (n,) [rad].
        weight: of its urgency.
    """

    aside: float
    bearing: Array
    weight: float

    @property
    def middle(self) -> float:
        """Bearing of its middle from the way [rad]."""
        return 0.5 * float(self.bearing[0] + self.bearing[-1])

    @property
    def half(self) -> float:
        """Half its width [rad]."""
        return 0.5 * abs(float(self.bearing[-1] - self.bearing[0]))


class RearCheck:
    """Chooses what to turn aside for, keeps to it until that was seen, and turns back."""

    def __init__(
        self, parameters: RearCheckParameters, reach: float, s_robot: float, speed: float
    ) -> None:
        """Start with nothing to look at.

        Args:
            parameters: angles and deadlines.
            reach: largest bearing that the gaze sees, to either side [rad].
            s_robot: radius of the robot [m].
            speed: the robot's largest [m/s].
        """
        self._parameters = parameters
        self._s_robot = s_robot
        p = parameters
        self._fear = (
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
        self._extent = np.array([(s.middle, s.half) for s in self._sectors])
        self._chosen: int | None = None
        self._since = 0.0
        self._course = 0.0
        self._rest_until = 0.0

    def aside(self, belief: Belief, course: float, speed: float) -> float:
        """Angle of the body to its way for the next footstep, left positive [rad].

        What the body turned aside for stays where it is in W, also when the way turns.

        Args:
            belief: what the robot believes.
            course: direction of the way in W [rad].
            speed: along it [m/s].
        """
        p, now = self._parameters, belief.time
        if self._must_leave(belief):
            self._chosen = None
            return 0.0
        if self._chosen is not None:
            late = now - self._since > p.max_turn_time
            if late or self.urgency(belief, self._course, speed)[self._chosen] < p.stop_urgency:
                self._chosen = None
                self._rest_until = now + p.retry_delay if late else now
        if self._chosen is None and now >= self._rest_until:
            weighted = self._weight * self.urgency(belief, course, speed)
            worst = int(np.argmax(weighted))
            if weighted[worst] > p.start_urgency:
                self._chosen, self._since, self._course = worst, now, course
        if self._chosen is None:
            return 0.0
        aside = self._sectors[self._chosen].aside
        side = copysign(1.0, aside)
        return side * min(max(side * wrap(self._course + aside - course), 0.0), p.far_angle)

    def look_request(self) -> float | None:
        """Direction in W of what the body turns aside for, None for nothing [rad]."""
        return None if self._chosen is None else self._course + self._sectors[self._chosen].middle

    def urgency(self, belief: Belief, course: float, speed: float) -> Array:
        """How overdue a look at each sector is (4,): at its ground, or for a lost mover.

        Args:
            belief: what the robot believes.
            course: direction of the way in W [rad].
            speed: along it [m/s].
        """
        points = rear_check_kernel.places(belief.pose, course, self._rings, self._bearing)
        age, count = belief.local_map.age_at(points), len(self._sectors)
        most = rear_check_kernel.of_ground(
            age, self._rings, self._bearing, speed, self._fear, count
        )
        for track in belief.tracks:
            if track.particles is not None:
                most = np.maximum(most, self._of_lost(track, belief.pose, course, speed))
        return most

    def _must_leave(self, belief: Belief) -> bool:
        """Whether something that may move is so near that there is no time to look round."""
        reach = self._parameters.clearance + self._s_robot
        x, y, _ = belief.pose.tolist()
        for track in belief.tracks:
            if track.motion is not Motion.STATIC:
                u, v = track.position.tolist()
                if hypot(u - x, v - y) < reach + track.radius:
                    return True
        return False

    def _of_lost(self, track: Track, pose: Array, course: float, speed: float) -> Array:
        """Urgency of a look at each sector for a lost track (4,)."""
        cloud = track.particles
        assert cloud is not None
        return rear_check_kernel.of_cloud(
            cloud.positions,
            cloud.weights,
            (track.age, track.radius, max(self._parameters.rings)),
            pose,
            course,
            self._extent,
            speed,
            self._fear,
        )


def sectors(parameters: RearCheckParameters, reach: float) -> tuple[Sector, ...]:
    """What is just out of the gaze's `reach` [rad] and what is right behind, on both sides."""
    p = parameters
    return tuple(
        Sector(side * aside, side * np.linspace(reach + start, reach + aside, p.rays), weight)
        for side in (1.0, -1.0)
        for start, aside, weight in (
            (0.0, p.near_angle, 1.0),
            (p.near_angle, p.far_angle, p.far_weight),
        )
    )
