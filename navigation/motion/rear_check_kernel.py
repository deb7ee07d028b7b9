"""Compiled part of the looks over the shoulder: how overdue each sector of the ground is.

A fear is (feared speed of what was not seen [m/s], radius of the robot [m], least speed at which
it comes nearer [m/s], shortest time to contact counted [s], age from which nothing grows worse [s],
largest urgency of a point [1]). Sectors are (middle, half width) from the way (n, 2) [rad].
"""

from math import atan2, ceil, cos, hypot, pi, sin

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Fear = tuple[float, float, float, float, float, float]


@njit(cache=True)
def urgency(age: float, gap: float, bearing: float, speed: float, fear: Fear) -> float:
    """Age over the time in which what comes from somewhere is here, bounded.

    Args:
        age: since it was seen there [s].
        gap: between the robot and what comes [m].
        bearing: of it from the way [rad].
        speed: of the robot along the way [m/s].
        fear: of what was not seen.
    """
    approach = max(fear[2], fear[0] + speed * cos(bearing))
    contact = max(fear[3], gap / approach)
    return min(fear[5], min(fear[4], age) / contact)


@njit(cache=True)
def places(pose: Array, course: float, distance: Array, bearing: Array) -> Array:
    """Points in W (n m, 2) [m] at distances (m,) on each of some rays.

    Args:
        pose: of the robot (3,) [m, m, rad].
        course: direction of the way in W [rad].
        distance: of the points on every ray (m,) [m].
        bearing: of the rays from the way (n,) [rad].
    """
    m = len(distance)
    points = np.empty((len(bearing) * m, 2))
    for i in range(len(bearing)):
        c, s = cos(course + bearing[i]), sin(course + bearing[i])
        for j in range(m):
            points[i * m + j, 0] = pose[0] + distance[j] * c
            points[i * m + j, 1] = pose[1] + distance[j] * s
    return points


@njit(cache=True)
def of_ground(
    age: Array, distance: Array, bearing: Array, speed: float, fear: Fear, count: int
) -> Array:
    """Mean urgency of a look at the ground of each of `count` sectors (count,).

    Args:
        age: of the ground at `places` (n m,) [s].
        distance: of the points on every ray (m,) [m].
        bearing: of the rays from the way, one sector's after the other's (n,) [rad].
        speed: of the robot along the way [m/s].
        fear: of what was not seen.
        count: of the sectors.
    """
    m, rays = len(distance), len(bearing) // count
    mean = np.zeros(count)
    for i in range(len(bearing)):
        for j in range(m):
            gap = distance[j] - fear[1] - fear[1]
            mean[i // rays] += urgency(age[i * m + j], gap, bearing[i], speed, fear)
    return mean / (rays * m)


@njit(cache=True)
def of_cloud(
    positions: Array,
    weights: Array,
    body: tuple[float, float, float],
    pose: Array,
    course: float,
    sectors: Array,
    speed: float,
    fear: Fear,
) -> Array:
    """Urgency of a look at each sector for what may be in it (n,).

    Args:
        positions: where it may be in W (k, 2) [m].
        weights: of them, sum to one (k,).
        body: its age [s] and radius [m], and the distance from which it is not asked for [m].
        pose: of the robot (3,) [m, m, rad].
        course: direction of the way in W [rad].
        sectors: to look at (n, 2).
        speed: of the robot along the way [m/s].
        fear: of what was not seen.
    """
    age, radius, reach = body
    total = np.zeros(len(sectors))
    for k in range(len(weights)):
        x, y = positions[k, 0] - pose[0], positions[k, 1] - pose[1]
        distance = hypot(x, y)
        if distance > reach:
            continue
        bearing = atan2(y, x) - course
        share = weights[k] * urgency(age, distance - radius - fear[1], bearing, speed, fear)
        for i in range(len(sectors)):
            off = bearing - sectors[i, 0]
            off -= 2.0 * pi * ceil((off - pi) / (2.0 * pi))
            if abs(off) <= sectors[i, 1]:
                total[i] += share
    return total
