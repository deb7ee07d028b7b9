"""Proof that a world can be crossed: a slow robot that knows everything reaches the end.

A disc of the robot's radius moves on a grid, one cell or none per layer of time, at less
than the robot's slowest speed, so turning does not matter. A cell may be entered or kept
only if it is free during the whole layer: movers are looked at so often that they cannot
slip through in between, and what they do in between is added to their radius.
"""

from dataclasses import dataclass
from itertools import pairwise
from math import hypot

import numpy as np
from numpy.typing import NDArray

from hsr8.scenario.world import ROBOT_RADIUS
from hsr8.world.layout import Layout

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

CELL = 0.06  # [m]
LAYER = 1.2  # time for one cell: 0.05 m/s, less than the robot walks sideways [s]
GLANCE = 0.2  # movers are looked at this often [s]
REACHED = 0.15  # a via point is reached within this [m]
LONGEST = 3600.0  # time after which the search gives up [s]


@dataclass(frozen=True, slots=True)
class Certificate:
    """What the search found.

    Attributes:
        solvable: every point was reached.
        points_reached: in order.
        points: how many there are.
        time: when the slow robot reached the last [s]; when it gave up otherwise.
    """

    solvable: bool
    points_reached: int
    points: int
    time: float


def certify(layout: Layout, most_points: int = 12) -> Certificate:
    """Search a way through `layout`, for a long tour to the first `most_points` points.

    The answer "solvable" is a proof for a disc with perfect knowledge; the other answer
    is none, for the real robot is faster.
    """
    points = layout.waypoints[:most_points].tolist()
    grid = _Grid(layout)
    targets = [grid.near(point, REACHED) for point in points]
    # One sheet of cells for each number of points reached; all are searched together, for
    # the first to arrive may be the one that a mover traps.
    begin = grid.near(layout.start[:2], CELL)
    sheets = np.zeros((len(points) + 1, *begin.shape), dtype=bool)
    sheets[0] = begin
    layer, best = 0, 0
    while not sheets[-1].any() and sheets.any() and layer * LAYER < LONGEST:
        free = grid.free(layer * LAYER)
        # The cell that is left must be free as well while the robot leaves it.
        sheets = _grown(sheets & free) & free
        for k, target in enumerate(targets):
            sheets[k + 1] |= sheets[k] & target
        layer += 1
        best = max(best, int(np.flatnonzero(sheets.any(axis=(1, 2))).max(initial=0)))
    return Certificate(bool(sheets[-1].any()), best, len(points), layer * LAYER)


class _Grid:
    """Which cells are free when."""

    def __init__(self, layout: Layout) -> None:
        half = 0.5 * np.asarray(layout.field_size)
        self._x = np.arange(-half[0] + 0.5 * CELL, half[0], CELL)
        self._y = np.arange(-half[1] + 0.5 * CELL, half[1], CELL)
        self._movers = layout.motion()
        self._mover_reach = np.array([self._reach(o.radius) for o in layout.movers])
        speeds = np.hypot(*self._movers.velocities(0.0).T)
        self._mover_reach += 0.5 * GLANCE * speeds
        self._static = np.ones((len(self._x), len(self._y)), dtype=bool)
        for obstacle in layout.static:
            self._block(self._static, obstacle.position, self._reach(obstacle.radius))

    @staticmethod
    def _reach(radius: float) -> float:
        """Distance a cell's centre keeps, so that the way to a neighbour's is free as well."""
        return radius + ROBOT_RADIUS + 0.5 * CELL

    def near(self, point: tuple[float, float] | list[float], distance: float) -> Mask:
        """Cells whose centre is within `distance` [m] of `point`."""
        mask: Mask = np.hypot((self._x - point[0])[:, None], (self._y - point[1])[None]) <= distance
        return mask

    def free(self, time: float) -> Mask:
        """Cells free from `time` to one layer later."""
        free = self._static.copy()
        for instant in np.arange(time, time + LAYER + 1e-9, GLANCE).tolist():
            for place, reach in zip(
                self._movers.positions(instant).tolist(), self._mover_reach.tolist(), strict=True
            ):
                self._block(free, place, reach)
        return free

    def _block(self, free: Mask, place: tuple[float, float] | list[float], reach: float) -> None:
        """Block the cells within `reach` [m] of `place`."""
        i = np.searchsorted(self._x, (place[0] - reach, place[0] + reach))
        j = np.searchsorted(self._y, (place[1] - reach, place[1] + reach))
        x, y = self._x[i[0] : i[1]] - place[0], self._y[j[0] : j[1]] - place[1]
        free[i[0] : i[1], j[0] : j[1]] &= x[:, None] ** 2 + y[None] ** 2 > reach**2


def _grown(cells: Mask) -> Mask:
    """Cells (..., n, m) and their four neighbours."""
    grown = cells.copy()
    grown[..., 1:, :] |= cells[..., :-1, :]
    grown[..., :-1, :] |= cells[..., 1:, :]
    grown[..., 1:] |= cells[..., :-1]
    grown[..., :-1] |= cells[..., 1:]
    return grown


def straight_length(layout: Layout) -> float:
    """Length of the straight lines from the start through all points [m]."""
    places = [layout.start[:2], *layout.waypoints.tolist()]
    return sum(hypot(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(places))
