"""Looks over the shoulder: the body turns aside until the gaze has reached the ground behind.

The head does not reach all around, so whatever comes up from behind stays unseen however the
gaze is chosen. The planner therefore turns the body, a little while it walks on, more when the
ground right behind is due, and tells the gaze what it turned for.
"""

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap_array
from navigation.belief import Belief, Track
from navigation.decision_parameters import ShoulderParameters
from navigation.value import value

Array = NDArray[np.float64]

_RINGS = np.array([0.40, 0.65, 0.90, 1.20])
"""Distances of the ground asked for [m]."""
_RAYS = 4
"""Directions asked for in a sector."""
_AGE_LIMIT = 8.0
"""Age of ground from which nothing grows worse [s]."""
_URGENCY_LIMIT = 2.0
"""Largest urgency of a point."""
_LEAST_TIME = 0.4
"""Shortest time to contact counted [s]."""
_LEAST_APPROACH = 0.02
"""Least speed at which something unseen is taken to come nearer [m/s]."""


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

    def contains(self, bearing: Array) -> NDArray[np.bool_]:
        """Whether bearings from the way (n,) [rad] are in it (n,)."""
        half = 0.5 * abs(float(self.bearing[-1] - self.bearing[0]))
        within: NDArray[np.bool_] = np.abs(wrap_array(bearing - self.middle)) <= half
        return within


class ShoulderCheck:
    """Chooses what to turn aside for, keeps to it until that was seen, and turns back."""

    def __init__(
        self, parameters: ShoulderParameters, reach: float, s_robot: float, speed: float
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
        self._feared = parameters.mover_speed * speed
        self._sectors = sectors(parameters, reach)
        self._weight = np.array([s.weight for s in self._sectors])
        rays = np.stack([s.bearing for s in self._sectors])
        self._distance = np.tile(np.repeat(_RINGS, _RAYS), (len(rays), 1))
        self._bearing = np.tile(rays, (1, len(_RINGS)))
        self._chosen: int | None = None
        self._since = 0.0
        self._rest_until = 0.0

    def aside(self, belief: Belief, course: float, speed: float) -> float:
        """Angle of the body to its way for the next footstep, left positive [rad].

        Args:
            belief: what the robot believes.
            course: direction of the way in W [rad].
            speed: along it [m/s].
        """
        p, now = self._parameters, belief.time
        urgency = self.urgency(belief, course, speed)
        if self._chosen is not None:
            late = now - self._since > p.hold
            if late or urgency[self._chosen] < p.seen:
                self._chosen = None
                self._rest_until = now + p.rest if late else now
        if self._chosen is None and now >= self._rest_until:
            weighted = self._weight * urgency
            worst = int(np.argmax(weighted))
            if weighted[worst] > p.due:
                self._chosen, self._since = worst, now
        return 0.0 if self._chosen is None else self._sectors[self._chosen].aside

    def glance(self, course: float) -> float | None:
        """Direction in W of what the body turns aside for, None for nothing [rad]."""
        return None if self._chosen is None else course + self._sectors[self._chosen].middle

    def urgency(self, belief: Belief, course: float, speed: float) -> Array:
        """How overdue a look at each sector is (4,): at its ground, or for a lost mover.

        Args:
            belief: what the robot believes.
            course: direction of the way in W [rad].
            speed: along it [m/s].
        """
        way = course + self._bearing
        points = np.stack([self._distance * np.cos(way), self._distance * np.sin(way)], axis=-1)
        age = belief.local_map.age_at(belief.pose[:2] + points.reshape(-1, 2))
        room = self._distance - self._s_robot
        overdue = self._overdue(age.reshape(way.shape), room, self._bearing, speed)
        most: Array = overdue.mean(axis=1)
        for track in belief.tracks:
            if track.particles is not None:
                most = np.maximum(most, self._of_lost(track, belief.pose, course, speed))
        return most

    def _of_lost(self, track: Track, pose: Array, course: float, speed: float) -> Array:
        """Urgency of a look at each sector for a lost track (4,)."""
        cloud = track.particles
        assert cloud is not None
        offset = cloud.positions - pose[:2]
        distance = np.hypot(offset[:, 0], offset[:, 1])
        near = distance <= _RINGS[-1]
        if not near.any():
            return np.zeros(len(self._sectors))
        bearing = np.arctan2(offset[:, 1], offset[:, 0]) - course
        overdue = self._overdue(track.age, distance - track.radius, bearing, speed)
        inside = np.array([s.contains(bearing) for s in self._sectors])
        urgency: Array = (inside * near) @ (cloud.weights * overdue)
        return urgency

    def _overdue(self, age: Array | float, room: Array, bearing: Array, speed: float) -> Array:
        """Age [s] over the time in which what comes from `bearing` [rad] is here, bounded."""
        approach = np.maximum(_LEAST_APPROACH, self._feared + speed * np.cos(bearing))
        contact = np.maximum(_LEAST_TIME, (room - self._s_robot) / approach)
        urgency: Array = np.minimum(_URGENCY_LIMIT, np.minimum(_AGE_LIMIT, age) / contact)
        return urgency


def sectors(parameters: ShoulderParameters, reach: float) -> tuple[Sector, ...]:
    """What is just out of the gaze's `reach` [rad] and what is right behind, on both sides."""
    p = parameters
    return tuple(
        Sector(side * aside, side * np.linspace(reach + start, reach + aside, _RAYS), weight)
        for side in (1.0, -1.0)
        for start, aside, weight in (
            (0.0, p.near_angle, 1.0),
            (p.near_angle, p.far_angle, p.far_weight),
        )
    )
