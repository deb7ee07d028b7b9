"""Density of undetected obstacles on the ground around the robot.

Movers that were never detected drift through the ground that the robot does not see. Their
density by cell and direction of motion moves with them and falls where a frame shows the ground.
"""

from dataclasses import replace
from math import pi, sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from compilation.record import record
from compilation.value import value
from navigation.belief.local_map import LocalMap
from navigation.motion.rollout import contact_time
from navigation.parameters.gaze import RiskParameters, UndetectedParameters

Array = NDArray[np.float64]
Cells = NDArray[np.int64]
Rows = NDArray[np.record]

MIN_DENSITY = 1e-5  # density below which a cell counts as empty [1/m²]


@value
class Undetected:
    """Densities on the cells of the local map.

    Attributes:
        parameters: densities, speed and headings.
        time: time of the densities [s].
        cell: side of a cell [m].
        corner: index of the first column and row, counted from the origin of W (2,).
        velocities: velocities of the headings (k, 2) [m/s].
        drift: motion by each heading that is not yet a whole cell (k, 2) [cells].
        movers: density by heading (k, n, n) [1/m²].
        static: density (n, n) [1/m²].
    """

    parameters: UndetectedParameters
    time: float
    cell: float
    corner: Cells
    velocities: Array
    drift: Array
    movers: Array
    static: Array

    @classmethod
    def unseen(
        cls, parameters: UndetectedParameters, local_map: LocalMap, time: float
    ) -> "Undetected":
        """Return the densities of ground that was never seen.

        Args:
            parameters: densities, speed and headings.
            local_map: map whose cells the densities share.
            time: time of the start [s].
        """
        p, shape = parameters, local_map.age.shape
        angles = 2.0 * pi * np.arange(p.headings) / p.headings
        velocities = p.speed * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        return cls(
            parameters,
            time,
            local_map.cell,
            corner_of(local_map),
            velocities,
            drift=np.zeros((p.headings, 2)),
            movers=np.full((p.headings, *shape), p.movers / p.headings),
            static=np.full(shape, p.static),
        )

    def updated(self, local_map: LocalMap, time: float) -> "Undetected":
        """Return the densities at `time` [s], reduced in the cells of the latest frame."""
        p, corner = self.parameters, corner_of(local_map)
        drift = self.drift + self.velocities * ((time - self.time) / self.cell)
        whole = np.round(drift).astype(np.int64)
        scroll = corner - self.corner
        left = np.where(local_map.age <= 0.0, p.missed, 1.0)
        static = shifted_and_seen(self.static[None], scroll[None], p.static, left)[0]
        movers = shifted_and_seen(self.movers, scroll - whole, p.movers / p.headings, left)
        return replace(
            self, time=time, corner=corner, drift=drift - whole, movers=movers, static=static
        )

    def risks(self, position: Array, velocity: Array, limits: Rows) -> Array:
        """Return position in W [m] and risk of the cells around the robot (m, 3).

        Args:
            position: position of the robot in W (2,) [m].
            velocity: velocity of the robot in W (2,) [m/s].
            limits: record of `risk_limits`.
        """
        return risks(
            self.movers,
            self.static,
            self.velocities,
            np.array([*(self.corner * self.cell), self.cell]),
            np.concatenate([position, velocity]),
            limits,
        )


def risk_limits(parameters: UndetectedParameters, risk: RiskParameters) -> Rows:
    """Return the parameters of the risk of a cell, and the maximum urgency (1,)."""
    return record(parameters, max_urgency=risk.max_urgency)


def corner_of(local_map: LocalMap) -> Cells:
    """Return the index of the first column and row, counted from the origin of W (2,)."""
    return np.round(np.array(local_map.origin) / local_map.cell).astype(np.int64)


@compiled
def shifted_and_seen(density: Array, shift: Cells, new: float, left: Array) -> Array:
    """Return densities (k, n, n) in a window that moved, reduced by a frame.

    Args:
        density: densities before (k, n, n) [1/m²].
        shift: motion of the window over each, columns and rows (k, 2).
        new: density of new cells [1/m²].
        left: fraction that the frame leaves in each cell (n, n) [1].
    """
    layers, size = len(density), len(left)
    result = np.empty_like(density)
    for k in range(layers):
        columns, rows = shift[k, 0], shift[k, 1]
        for row in range(size):
            for column in range(size):
                i, j = row + rows, column + columns
                before = density[k, i, j] if 0 <= i < size and 0 <= j < size else new
                result[k, row, column] = before * left[row, column]
    return result


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
