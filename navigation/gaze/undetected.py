"""Density of undetected obstacles on the ground around the robot.

Movers that were never detected drift through the ground that the robot does not see. Their
density by cell and direction of motion moves with them and falls where a frame shows the ground.
"""

from math import pi, sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from compilation.record import record
from navigation.belief.local_map import LocalMap, shifted
from navigation.motion.rollout import contact_time
from navigation.parameters.gaze import RiskParameters, UndetectedParameters

Array = NDArray[np.float64]
Rows = NDArray[np.record]

MIN_DENSITY = 1e-5  # density below which a cell counts as empty [1/m²]


class Undetected:
    """Densities on the cells of the local map.

    Args:
        parameters: densities, speed and headings.
        risk: maximum urgency.
        local_map: map whose cells the densities share.
        time: time of the start [s].
    """

    def __init__(
        self,
        parameters: UndetectedParameters,
        risk: RiskParameters,
        local_map: LocalMap,
        time: float,
    ) -> None:
        p = self._parameters = parameters
        self._limits = record(parameters, max_urgency=risk.max_urgency)
        angles = 2.0 * pi * np.arange(p.headings) / p.headings
        self._velocities = p.speed * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        self._cell = local_map.cell
        self._corner = _corner(local_map)
        shape = local_map.age.shape
        self._new = p.movers / p.headings
        self._movers = np.full((p.headings, *shape), self._new)
        self._static = np.full(shape, p.static)
        self._drift = np.zeros((p.headings, 2))  # not yet a whole cell [cells]
        self._time = time

    def update(self, local_map: LocalMap, time: float) -> None:
        """Move the densities to `time` [s] and reduce them in the cells of the latest frame."""
        corner = _corner(local_map)
        self._drift += self._velocities * ((time - self._time) / self._cell)
        whole = np.round(self._drift).astype(int)
        self._drift -= whole
        self._time = time
        scroll, self._corner = corner - self._corner, corner
        for k, (columns, rows) in enumerate((scroll - whole).tolist()):
            if columns or rows:
                self._movers[k] = shifted(self._movers[k], rows, columns, self._new)
        columns, rows = scroll.tolist()
        self._static = shifted(self._static, rows, columns, self._parameters.static)
        see(self._movers, self._static, local_map.age, self._parameters.missed)

    def risks(self, position: Array, velocity: Array) -> Array:
        """Return position in W [m] and risk of the cells around the robot (m, 3).

        Args:
            position: position of the robot in W (2,) [m].
            velocity: velocity of the robot in W (2,) [m/s].
        """
        return risks(
            self._movers,
            self._static,
            self._velocities,
            np.array([*(self._corner * self._cell), self._cell]),
            np.concatenate([position, velocity]),
            self._limits,
        )


@compiled
def see(movers: Array, static: Array, age: Array, missed: float) -> None:
    """Reduce the densities in the cells that a frame shows, in place.

    Args:
        movers: density by heading (k, n, n) [1/m²].
        static: density (n, n) [1/m²].
        age: time since each cell was seen (n, n) [s].
        missed: fraction that remains [1].
    """
    count = len(static)
    for row in range(count):
        for column in range(count):
            if age[row, column] <= 0.0:
                static[row, column] *= missed
                for k in range(len(movers)):
                    movers[k, row, column] *= missed


@compiled
def danger(x: float, y: float, vx: float, vy: float, p: np.record) -> float:
    """Return the urgency of a collision with an obstacle outside the gap, to the power of 1.5.

    Args:
        x: position of the obstacle from the robot [m].
        y: position of the obstacle from the robot [m].
        vx: relative velocity along x [m/s].
        vy: relative velocity along y [m/s].
        p: parameters.
    """
    rate = x * vx + y * vy
    if rate >= 0.0:
        return 0.0
    time = contact_time(rate, vx * vx + vy * vy, x * x + y * y - p.gap * p.gap)
    if time >= p.max_time:
        return 0.0
    urgency = min(p.max_urgency, p.time / max(time, p.min_time))
    return float(urgency * sqrt(urgency))


@compiled
def risks(
    movers: Array, static: Array, velocities: Array, corner: Array, robot: Array, parameters: Rows
) -> Array:
    """Return position in W [m] and risk of the cells with undetected obstacles (m, 3).

    Args:
        movers: density by heading (k, n, n) [1/m²].
        static: density (n, n) [1/m²].
        velocities: velocities of the headings (k, 2) [m/s].
        corner: corner of the grid in W [m], and side of a cell [m] (3,).
        robot: position and velocity of the robot in W (4,) [m, m/s].
        parameters: record of the parameters, and maximum urgency (1,).
    """
    p = parameters[0]
    x, y, vx, vy = robot
    cell, count, size = corner[2], 0, len(static)
    cells = np.empty((size * size, 3))
    for row in range(size):
        dy = corner[1] + (row + 0.5) * cell - y
        if abs(dy) > p.reach:
            continue
        for column in range(size):
            dx = corner[0] + (column + 0.5) * cell - x
            if not p.gap * p.gap < dx * dx + dy * dy <= p.reach * p.reach:
                continue
            risk = 0.0
            for k in range(len(movers)):
                density = movers[k, row, column]
                if density >= MIN_DENSITY:
                    u, w = velocities[k, 0], velocities[k, 1]
                    risk += (1.0 - p.walking_weight) * density * danger(dx, dy, u, w, p)
                    risk += p.walking_weight * density * danger(dx, dy, u - vx, w - vy, p)
            if static[row, column] >= MIN_DENSITY:
                risk += static[row, column] * danger(dx, dy, -vx, -vy, p)
            if risk > 0.0:
                cells[count, 0], cells[count, 1] = dx + x, dy + y
                cells[count, 2] = risk * cell * cell
                count += 1
    return cells[:count]


def _corner(local_map: LocalMap) -> NDArray[np.int64]:
    """Return the index of the first column and row, counted from the origin of W (2,)."""
    return np.round(np.array(local_map.origin) / local_map.cell).astype(np.int64)
