"""Compiled part of the density of undetected obstacles."""

from math import sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled

Array = NDArray[np.float64]

NEVER = 1e9  # time of a collision that does not happen [s]
MIN_DENSITY = 1e-5  # density below which a cell counts as empty [1/m²]


@compiled
def time_to_collision(x: float, y: float, vx: float, vy: float, gap: float) -> float:
    """Return the time until a point comes within a distance of the origin [s].

    Args:
        x: of the point [m].
        y: of the point [m].
        vx: its velocity along x [m/s].
        vy: its velocity along y [m/s].
        gap: distance [m].
    """
    square = x * x + y * y
    if square <= gap * gap:
        return 0.0
    speed, closing = vx * vx + vy * vy, -(x * vx + y * vy)
    if closing <= 0.0 or speed < 1e-6:
        return NEVER
    root = closing * closing - speed * (square - gap * gap)
    if root <= 0.0:
        return NEVER
    return (closing - sqrt(root)) / speed


@compiled
def see(movers: Array, static: Array, in_view: NDArray[np.bool_], missed: float) -> None:
    """Reduce the densities in the cells that a frame shows, in place.

    Args:
        movers: density by heading (k, n, n) [1/m²].
        static: density (n, n) [1/m²].
        in_view: cells in the frame (n, n).
        missed: fraction that remains [1].
    """
    count = len(static)
    for row in range(count):
        for column in range(count):
            if in_view[row, column]:
                static[row, column] *= missed
                for k in range(len(movers)):
                    movers[k, row, column] *= missed


@compiled
def risks(
    movers: Array, static: Array, velocities: Array, corner: Array, robot: Array, limits: Array
) -> Array:
    """Return position in W [m] and risk of the cells with undetected obstacles (m, 3).

    Args:
        movers: density by heading (k, n, n) [1/m²].
        static: density (n, n) [1/m²].
        velocities: of the headings (k, 2) [m/s].
        corner: of the grid in W [m], and side of a cell [m] (3,).
        robot: position and velocity of the robot in W (4,) [m, m/s].
        limits: reach [m], gap [m], maximum and minimum time to collision, and time at which the
            urgency is one [s], its maximum and exponent, weight of a robot that walks on [1] (8,).
    """
    reach, gap, max_time, min_time, unit_time, max_urgency, exponent, walking = limits
    x, y, vx, vy = robot
    cell, count, size = corner[2], 0, len(static)
    cells = np.empty((size * size, 3))
    for row in range(size):
        dy = corner[1] + (row + 0.5) * cell - y
        if abs(dy) > reach:
            continue
        for column in range(size):
            dx = corner[0] + (column + 0.5) * cell - x
            if not gap * gap < dx * dx + dy * dy <= reach * reach:
                continue
            risk = 0.0
            for k in range(len(movers) + 1):
                still = k == len(movers)
                density = static[row, column] if still else movers[k, row, column]
                if density < MIN_DENSITY:
                    continue
                for walks in range(2):
                    weight = walking if walks else 1.0 - walking
                    if still:
                        if not walks:
                            continue
                        weight, ux, uy = 1.0, -vx, -vy
                    else:
                        ux = velocities[k, 0] - walks * vx
                        uy = velocities[k, 1] - walks * vy
                    time = time_to_collision(dx, dy, ux, uy, gap)
                    if time < max_time:
                        urgency = min(max_urgency, unit_time / max(time, min_time))
                        risk += weight * density * urgency**exponent
            if risk > 0.0:
                cells[count, 0], cells[count, 1] = dx + x, dy + y
                cells[count, 2] = risk * cell * cell
                count += 1
    return cells[:count]
