"""Proof that a world can be crossed: a robot that knows everything reaches the end.

All places that a disc can have come to without a contact are followed through time, at
the speeds of the real robot, on the lattice of `hsr8.world.field.lattice`. What arrives is a
proof, with a path to look at; that nothing arrives is none, for the robot is not bound to
a lattice. Acceleration is left out.
"""

from dataclasses import dataclass, field
from itertools import pairwise
from math import ceil, hypot, pi

import numpy as np
from numpy.typing import NDArray

from hsr8.scenario.robot import SpeedEnvelope
from hsr8.scenario.world import ROBOT_RADIUS
from hsr8.world.field.lattice import HALF_MOVE, WAYS, Bits, Lattice
from hsr8.world.field.layout import Layout
from hsr8.world.field.reachable import EIGHTH, Reachable

Array = NDArray[np.float64]

CELLS = (0.10, 0.05)  # lattices, the finer one if the coarser finds no way [m]
VIA_REACHED = 0.15  # a via point is passed within this [m]
LONGEST = 400.0  # time after which the search gives up [s]
MOST_POINTS = 8  # of a long tour the first ones are enough
SAMPLE = 0.02  # between two looks at the clearance of a path [s]


@dataclass(frozen=True, slots=True, eq=False)
class Certificate:
    """What the search found.

    Attributes:
        solvable: every point was reached.
        points_reached: in order.
        points: how many there are.
        time: when the robot reached the last [s]; when it gave up otherwise.
        path: time, x, y, heading (n, 4), straight and steady in between
            [s, m, m, rad]; empty if there is none.
    """

    solvable: bool
    points_reached: int
    points: int
    time: float
    path: Array = field(default_factory=lambda: np.zeros((0, 4)))

    @property
    def length(self) -> float:
        """Length of the path [m]."""
        return float(np.hypot(*np.diff(self.path[:, 1:3], axis=0).T).sum())


def certify(layout: Layout, speed: SpeedEnvelope) -> Certificate:
    """Search a way through `layout`, for a long tour to the first `MOST_POINTS` points.

    Args:
        layout: the world.
        speed: what the robot can do.
    """
    points = layout.waypoints[:MOST_POINTS].tolist()
    if not points:
        return Certificate(True, 0, 0, 0.0)
    for cell in CELLS:
        lattice = Lattice(layout, speed, cell)
        targets = _targets(layout, lattice, points)
        # A point behind walls needs no search.
        connected = lattice.connected()
        inside = [bool((target & connected).any()) for target in targets]
        search = Reachable(lattice, targets[: (*inside, False).index(False)])
        off = abs(layout.start[2] - EIGHTH * round(layout.start[2] / EIGHTH))
        search.follow(layout.start[2], off / speed.wz, ceil(LONGEST / lattice.layer))
        if search.passed == len(points):
            path = _from_start(layout, search.path())
            return Certificate(True, len(points), len(points), search.time, path)
    return Certificate(False, search.passed, len(points), search.time)


def _from_start(layout: Layout, path: Array) -> Array:
    """The path with the turn from the true heading to that of the lattice before it."""
    path[:, 3] += 2.0 * pi * round((layout.start[2] - path[0, 3]) / (2.0 * pi))
    start = np.array([[0.0, *layout.start]])
    return np.vstack([start, path if path[0, 0] > 0.0 else path[1:]])


def _targets(layout: Layout, lattice: Lattice, points: list[list[float]]) -> list[Bits]:
    """States that pass each point; the goal of a course is reached with its heading."""
    targets = [lattice.near(point, VIA_REACHED) for point in points]
    if not layout.endless and len(points) == len(layout.waypoints):
        # Half a diagonal of a cell: the places next to the goal.
        targets[-1] = lattice.near(points[-1], HALF_MOVE * lattice.cell + 1e-9)
        if layout.goal_heading is not None:
            targets[-1] &= np.uint8(1 << round(layout.goal_heading / EIGHTH) % len(WAYS))
    return targets


def least_clearance(layout: Layout, path: Array) -> float:
    """Smallest distance between the robot's disc on `path` (n, 4) and any obstacle [m]."""
    times = np.arange(path[0, 0], path[-1, 0] + SAMPLE, SAMPLE)
    places = np.stack([np.interp(times, path[:, 0], path[:, k]) for k in (1, 2)], axis=1)
    gaps = [
        np.hypot(*(places - o.position).T).min() - o.radius - ROBOT_RADIUS for o in layout.static
    ]
    for mover in layout.movers:
        assert mover.motion is not None
        at = np.array([mover.motion.position(time) for time in times.tolist()])
        gaps.append(np.hypot(*(places - at).T).min() - mover.radius - ROBOT_RADIUS)
    return float(min(gaps, default=np.inf))


def straight_length(layout: Layout, most_points: int | None = None) -> float:
    """Length of the straight lines from the start through all, or the first, points [m]."""
    places = [layout.start[:2], *layout.waypoints[:most_points].tolist()]
    return sum(hypot(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(places))
