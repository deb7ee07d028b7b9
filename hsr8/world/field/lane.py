"""Lanes of movers, and their distances."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, inf, pi, radians, sin

import numpy as np
from numpy.typing import NDArray

from hsr8.scenario.track import SPACING, Track
from hsr8.scenario.world import CircleMover, LineMover, ShuttleMover
from hsr8.world.field.layout import Obstacle
from hsr8.world.field.motion import (
    Circle,
    Line,
    MotionLaw,
    Movers,
    Passage,
    Point,
    Shuttle,
    Wander,
)

Array = NDArray[np.float64]

SAMPLES = 61  # points along a lane
# For worlds in which the robot is as fast as HSR-VIII in a world of scale 1:
INTERVAL = 0.5  # between checks of crossing movers [s]
HORIZON = 300.0  # of these checks, whatever the duration of the run [s]
OPEN_TIME = 60.0  # sampled time of a lane without an end [s]


@dataclass(frozen=True, slots=True, eq=False)
class Lane:
    """Mover with its lane.

    Attributes:
        obstacle: the mover.
        path: points along the lane (n, 2) [m].
        ends: points where the mover may wait or reverse (k, 2) [m].
        crosses: the lane may cross others, as long as the movers never meet.
    """

    obstacle: Obstacle
    path: Array
    ends: Array
    crosses: bool = False

    @classmethod
    def of(
        cls,
        obstacle: Obstacle,
        scale: float = 1.0,
        time_scale: float = 1.0,
    ) -> "Lane":
        """Return the lane of a mover.

        Args:
            obstacle: the mover.
            scale: scale of the world [1].
            time_scale: time scale of the world [1].
        """
        motion = obstacle.motion
        assert motion is not None
        if isinstance(motion, Shuttle):
            path = np.linspace(motion.start, motion.end, SAMPLES)
            return cls(obstacle, path, path[[0, -1]])
        if isinstance(motion, Circle):
            angle = np.linspace(0.0, 2.0 * pi, 2 * SAMPLES, endpoint=False)
            unit = np.stack([np.cos(angle), np.sin(angle)], axis=1)
            path = np.asarray(motion.centre) + motion.radius * unit
            return cls(obstacle, path, path)
        if isinstance(motion, Passage):
            path = np.linspace(motion.start, motion.end, SAMPLES)
            return cls(obstacle, path, path[[0, -1]], crosses=True)
        if isinstance(motion, Wander):
            path = np.array(motion.track)
            return cls(obstacle, path, path, crosses=True)
        if isinstance(motion, Track):
            _, path = motion.sampled(-inf, inf, SPACING * scale)
            return cls(obstacle, path, path[[0, -1]], crosses=True)
        times = np.linspace(0.0, OPEN_TIME * time_scale, SAMPLES)
        path = Movers([motion]).positions(times)[:, 0]
        return cls(obstacle, path, path[:1])


def motion_law(mover: ShuttleMover | LineMover | CircleMover) -> MotionLaw:
    """Return the motion law of a mover placed by hand."""
    if isinstance(mover, ShuttleMover):
        return Shuttle(mover.start, mover.end, mover.speed)
    if isinstance(mover, LineMover):
        angle = radians(mover.heading_deg)
        # Rounded, so that a right angle in degrees is exact.
        x, y = np.round([cos(angle), sin(angle)], 12).tolist()
        return Line(mover.start, (mover.speed * x, mover.speed * y))
    speed = -mover.speed if mover.clockwise else mover.speed
    return Circle(mover.centre, mover.path_radius, speed, radians(mover.angle_deg))


def apart_at_all_times(lane: Lane, other: Lane, room: float, time_scale: float = 1.0) -> bool:
    """Return whether the axes of two movers keep a distance of `room` [m] for `HORIZON`."""
    motions = tuple(m for m in (lane.obstacle.motion, other.obstacle.motion) if m is not None)
    both = Movers(motions).positions(time_scale * np.arange(0.0, HORIZON, INTERVAL))
    gaps = np.hypot(*(both[:, 0] - both[:, 1]).T)
    # Between two checks each approaches by at most half of its motion. A recorded mover stands for
    # longer than that where it appears and leaves.
    speeds = 0.0
    for motion, steps in zip(motions, np.moveaxis(np.diff(both, axis=0), 1, 0), strict=True):
        moved = float(np.hypot(*steps.T).max())
        if isinstance(motion, Track):
            moved = min(moved, motion.speed * INTERVAL * time_scale)
        speeds += moved
    return bool((gaps >= room + 0.5 * speeds).all())


def distance(points: Array, others: Sequence[Point] | Array) -> Array:
    """Return the distance of each of `points` (n, 2) to the nearest of `others` (m, 2) (n,) [m]."""
    offsets = points[:, None] - np.asarray(others, dtype=float)[None]
    nearest: Array = np.hypot(offsets[..., 0], offsets[..., 1]).min(axis=1)
    return nearest
