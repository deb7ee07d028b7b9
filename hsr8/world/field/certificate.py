"""Feasibility certificate: a collision-free path for a robot with full knowledge of the world.

All states that a disc can reach without contact are propagated through time at the speeds of the
real robot, on the lattice of `hsr8.world.field.lattice`. A path is a proof. Its absence proves
nothing, because the robot is not bound to a lattice. Acceleration is not modelled.
"""

from dataclasses import dataclass, field
from itertools import pairwise
from math import ceil, hypot, pi

import numpy as np
from numpy.typing import NDArray

from hsr8.scenario.robot import Robot
from hsr8.world.field.lattice import DIRECTIONS, HALF_MOVE, LAYERS_PER_CELL, Bits, Lattice
from hsr8.world.field.layout import Layout
from hsr8.world.field.reachable import EIGHTH, Reachable
from navigation.parameters.navigation import MissionParameters

Array = NDArray[np.float64]

# In a world of scale 1:
CELLS = (0.10, 0.05)  # cell sizes; the finer lattice is used if the coarser has no path [m]
VIA_REACHED = MissionParameters().r_via  # by default [m]
MAX_LENGTH = 80.0  # that the robot could walk during the search [m]
MAX_POINTS = 8  # checked of a long tour
MAX_WORK = 600_000_000  # cells in all layers of a search, some ten seconds
SAMPLE = 0.02  # interval of the clearance along a path [s]


@dataclass(frozen=True, slots=True, eq=False)
class Certificate:
    """Feasibility certificate of a world.

    Attributes:
        solvable: every point was reached.
        points_reached: number of points reached, in order.
        points: number of points.
        time: time of the arrival at the last point, or of the end of the search [s].
        path: time, x, y, heading (n, 4) [s, m, m, rad], linear in between; empty if unsolvable.
        work: cost of the search, as `MAX_WORK` limits it [cell].
    """

    solvable: bool
    points_reached: int
    points: int
    time: float
    path: Array = field(default_factory=lambda: np.zeros((0, 4)))
    work: int = 0

    @property
    def length(self) -> float:
        """Length of the path [m]."""
        return float(np.hypot(*np.diff(self.path[:, 1:3], axis=0).T).sum())


def certify(
    layout: Layout, robot: Robot, via_reached: float = VIA_REACHED, max_work: int = MAX_WORK
) -> Certificate:
    """Search a path through the first `MAX_POINTS` points of `layout` at most.

    Args:
        layout: the world.
        robot: radius and speed limits.
        via_reached: distance at which a via point counts as passed [m].
        max_work: limit of the search, in large fields [cell].
    """
    points = layout.waypoints[:MAX_POINTS].tolist()
    if not points:
        return Certificate(True, 0, 0, 0.0)
    work = 0
    for cell in CELLS:
        lattice = Lattice(layout, robot, cell * layout.scale)
        targets = _targets(layout, lattice, points, via_reached)
        # A point enclosed by static obstacles needs no search.
        connected = lattice.connected()
        inside = [bool((target & connected).any()) for target in targets]
        search = Reachable(lattice, targets[: (*inside, False).index(False)])
        off = abs(layout.start[2] - EIGHTH * round(layout.start[2] / EIGHTH))
        layers = ceil(LAYERS_PER_CELL * MAX_LENGTH / cell)
        layers = min(layers, (max_work - work) // (len(lattice.x) * len(lattice.y)))
        search.propagate(layout.start[2], off / robot.speed.wz, layers)
        work += search.work
        if search.passed == len(points):
            path = _from_start(layout, search.path())
            return Certificate(True, len(points), len(points), search.time, path, work)
    return Certificate(False, search.passed, len(points), search.time, work=work)


def _from_start(layout: Layout, path: Array) -> Array:
    """Prepend the turn from the true start heading to that of the lattice."""
    path[:, 3] += 2.0 * pi * round((layout.start[2] - path[0, 3]) / (2.0 * pi))
    start = np.array([[0.0, *layout.start]])
    return np.vstack([start, path if path[0, 0] > 0.0 else path[1:]])


def _targets(
    layout: Layout, lattice: Lattice, points: list[list[float]], via_reached: float
) -> list[Bits]:
    """Return the states that pass each point; the goal of a course requires its heading."""
    # Half the diagonal of a cell: the cells next to a point.
    nearest = HALF_MOVE * lattice.cell + 1e-9
    targets = [lattice.near(point, max(via_reached, nearest)) for point in points]
    if not layout.endless and len(points) == len(layout.waypoints):
        targets[-1] = lattice.near(points[-1], nearest)
        if layout.goal_heading is not None:
            targets[-1] &= np.uint8(1 << round(layout.goal_heading / EIGHTH) % len(DIRECTIONS))
    return targets


def min_clearance(layout: Layout, path: Array, radius: float) -> float:
    """Return the minimum distance of a robot on `path` (n, 4) to any obstacle [m].

    Args:
        layout: the world.
        path: path of a certificate.
        radius: radius of the robot [m].
    """
    times = np.arange(path[0, 0], path[-1, 0] + SAMPLE, SAMPLE)
    positions = np.stack([np.interp(times, path[:, 0], path[:, k]) for k in (1, 2)], axis=1)
    gaps = [np.hypot(*(positions - o.position).T).min() - o.radius - radius for o in layout.static]
    moving = np.moveaxis(layout.motion().positions(times), 1, 0)
    for mover, at in zip(layout.movers, moving, strict=True):
        gaps.append(np.hypot(*(positions - at).T).min() - mover.radius - radius)
    return float(min(gaps, default=np.inf))


def straight_length(layout: Layout, max_points: int | None = None) -> float:
    """Return the length of the straight lines from the start through the points [m]."""
    points = [layout.start[:2], *layout.waypoints[:max_points].tolist()]
    return sum(hypot(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(points))
