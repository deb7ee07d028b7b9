"""A mover and all the places it passes."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, pi, radians, sin

import numpy as np
from numpy.typing import NDArray

from hsr8.scenario.world import LineMover, Mover, ShuttleMover
from hsr8.world.field.layout import OBSTACLE_HEIGHT, Obstacle
from hsr8.world.field.motion import Circle, Line, MotionLaw, Passage, Point, Shuttle
from hsr8.world.field.wander import Wander

Array = NDArray[np.float64]

SAMPLES = 61  # points that stand for a lane
GLANCE = 0.5  # crossing movers are looked at this often [s]
FORESIGHT = 300.0  # for so long, whatever the duration of the run [s]
OPEN_TIME = 60.0  # a lane without an end is followed for so long [s]


@dataclass(frozen=True, slots=True, eq=False)
class Lane:
    """A mover with its lane.

    Attributes:
        obstacle: the mover.
        path: points along its lane (n, 2) [m].
        ends: points where it may stay for a while or turn about (k, 2) [m].
        crosses: it takes so much room that lanes may cross, if never at the same time.
    """

    obstacle: Obstacle
    path: Array
    ends: Array
    crosses: bool = False

    @classmethod
    def of(cls, law: MotionLaw, radius: float, color: str) -> "Lane":
        """Lane of a mover of some `radius` [m] that follows `law`."""
        obstacle = Obstacle(law.position(0.0), radius, OBSTACLE_HEIGHT, color, law)
        if isinstance(law, Shuttle):
            path = np.linspace(law.start, law.end, SAMPLES)
            return cls(obstacle, path, path[[0, -1]])
        if isinstance(law, Circle):
            angle = np.linspace(0.0, 2.0 * pi, 2 * SAMPLES, endpoint=False)
            rim = np.stack([np.cos(angle), np.sin(angle)], axis=1)
            path = np.asarray(law.centre) + law.radius * rim
            return cls(obstacle, path, path)
        if isinstance(law, Passage):
            path = np.linspace(law.start, law.end, SAMPLES)
            return cls(obstacle, path, path[[0, -1]], crosses=True)
        if isinstance(law, Wander):
            path = np.array(law.track)
            return cls(obstacle, path, path, crosses=True)
        times = np.linspace(0.0, OPEN_TIME, SAMPLES).tolist()
        path = np.array([law.position(time) for time in times])
        return cls(obstacle, path, path[:1])


def motion_law(mover: Mover) -> MotionLaw:
    """Motion of a mover placed by hand."""
    if isinstance(mover, ShuttleMover):
        return Shuttle(mover.start, mover.end, mover.speed)
    if isinstance(mover, LineMover):
        angle = radians(mover.heading_deg)
        # Headings are given in degrees: a right angle shall be one.
        way = np.round([cos(angle), sin(angle)], 12).tolist()
        return Line(mover.start, (mover.speed * way[0], mover.speed * way[1]))
    speed = -mover.speed if mover.clockwise else mover.speed
    return Circle(mover.centre, mover.path_radius, speed, radians(mover.angle_deg))


def apart_at_all_times(lane: Lane, other: Lane, room: float) -> bool:
    """Whether the axes of two movers keep `room` [m] from each other, for `FORESIGHT`."""
    laws = lane.obstacle.motion, other.obstacle.motion
    assert laws[0] is not None
    assert laws[1] is not None
    times = np.arange(0.0, FORESIGHT, GLANCE).tolist()
    first, second = (np.array([law.position(time) for time in times]) for law in laws if law)
    gaps = np.hypot(*(first - second).T)
    # Between two glances each comes nearer by half the way it goes, at most.
    speeds = sum(float(np.hypot(*np.diff(p, axis=0).T).max()) for p in (first, second))
    return bool((gaps >= room + 0.5 * speeds).all())


def distance(points: Array, others: Sequence[Point] | Array) -> Array:
    """Distance of each of `points` (n, 2) to the nearest of `others` (m, 2): (n,) [m]."""
    offsets = points[:, None] - np.asarray(others, dtype=float)[None]
    nearest: Array = np.hypot(offsets[..., 0], offsets[..., 1]).min(axis=1)
    return nearest
