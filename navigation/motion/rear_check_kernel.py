"""Compiled urgency of the rear check for each sector of the ground.

A threat is (assumed speed of an unseen mover [m/s], radius of the robot [m], and the bounds of the
urgency: minimum closing speed [m/s], minimum time to collision [s], maximum age [s], maximum
urgency [1]). Sectors are (middle, half width) from the course (n, 2) [rad].
"""

from math import atan2, ceil, cos, hypot, pi, sin

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Threat = tuple[float, float, float, float, float, float]


@njit(cache=True)
def urgency(age: float, gap: float, bearing: float, speed: float, threat: Threat) -> float:
    """Return age over time to collision, bounded.

    Args:
        age: since the latest look [s].
        gap: to an unseen mover [m].
        bearing: from the course [rad].
        speed: of the robot along the course [m/s].
        threat: unseen mover.
    """
    approach = max(threat[2], threat[0] + speed * cos(bearing))
    time = max(threat[3], gap / approach)
    return min(threat[5], min(threat[4], age) / time)


@njit(cache=True)
def ray_points(pose: Array, course: float, distance: Array, bearing: Array) -> Array:
    """Return points in W (n m, 2) [m] at every distance on every ray.

    Args:
        pose: of the robot (3,) [m, m, rad].
        course: direction of motion in W [rad].
        distance: of the points on a ray (m,) [m].
        bearing: of the rays from the course (n,) [rad].
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
def ground_urgency(
    age: Array, distance: Array, bearing: Array, speed: float, threat: Threat, count: int
) -> Array:
    """Return the mean urgency of the ground of each of `count` sectors (count,).

    Args:
        age: of the ground at `ray_points` (n m,) [s].
        distance: of the points on a ray (m,) [m].
        bearing: of the rays from the course, sector by sector (n,) [rad].
        speed: of the robot along the course [m/s].
        threat: unseen mover.
        count: number of sectors.
    """
    m, rays = len(distance), len(bearing) // count
    mean = np.zeros(count)
    for i in range(len(bearing)):
        for j in range(m):
            gap = distance[j] - threat[1] - threat[1]
            mean[i // rays] += urgency(age[i * m + j], gap, bearing[i], speed, threat)
    return mean / (rays * m)


@njit(cache=True)
def cloud_urgency(
    positions: Array,
    weights: Array,
    body: tuple[float, float, float],
    pose: Array,
    course: float,
    sectors: Array,
    speed: float,
    threat: Threat,
) -> Array:
    """Return the urgency of each sector for the particles of a lost mover (n,).

    Args:
        positions: of the particles in W (k, 2) [m].
        weights: of the particles, sum to one (k,).
        body: age [s] and radius [m] of the mover, and the maximum distance of a particle [m].
        pose: of the robot (3,) [m, m, rad].
        course: direction of motion in W [rad].
        sectors: n sectors (n, 2).
        speed: of the robot along the course [m/s].
        threat: unseen mover.
    """
    age, radius, reach = body
    total = np.zeros(len(sectors))
    for k in range(len(weights)):
        x, y = positions[k, 0] - pose[0], positions[k, 1] - pose[1]
        distance = hypot(x, y)
        if distance > reach:
            continue
        bearing = atan2(y, x) - course
        vote = weights[k] * urgency(age, distance - radius - threat[1], bearing, speed, threat)
        for i in range(len(sectors)):
            off = bearing - sectors[i, 0]
            off -= 2.0 * pi * ceil((off - pi) / (2.0 * pi))
            if abs(off) <= sectors[i, 1]:
                total[i] += vote
    return total
