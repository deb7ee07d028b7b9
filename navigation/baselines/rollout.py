"""Rollout of sequences of footsteps for the sampling baselines."""

import numpy as np
from numpy.typing import NDArray

from navigation.baselines.planning_scene import PlanningScene

Array = NDArray[np.float64]


def rollout(pose: Array, body: Array, footstep: float) -> tuple[Array, Array]:
    """Integrate body velocities, each over one footstep.

    Args:
        pose: start (3,) [m, m, rad].
        body: vx, vy, wz of k sequences of t footsteps (k, t, 3) [m/s, m/s, rad/s].
        footstep: duration of a footstep [s].

    Returns:
        Positions after each footstep (k, t, 2) [m] and headings (k, t) [rad].
    """
    turned = footstep * np.cumsum(body[..., 2], axis=1)
    heading = pose[2] + turned
    middle = heading - 0.5 * footstep * body[..., 2]
    c, s = np.cos(middle), np.sin(middle)
    step = np.stack([c * body[..., 0] - s * body[..., 1], s * body[..., 0] + c * body[..., 1]], -1)
    position: Array = pose[:2] + footstep * np.cumsum(step, axis=1)
    return position, heading


def gaps(position: Array, scene: PlanningScene, radii: Array, max_gap: float) -> Array:
    """Return the gap to the nearest obstacle after every footstep (k, t) [m].

    Args:
        position: of k sequences of t footsteps (k, t, 2) [m].
        scene: obstacles, which continue at constant velocity.
        radii: collision distances of the obstacles (n,) [m].
        max_gap: upper bound of the gap [m].
    """
    k, t, _ = position.shape
    limits, obstacles = scene.limits, scene.obstacles
    dt = limits.footstep
    offset = obstacles.position - scene.pose[:2]
    reach = t * dt * (obstacles.speed + limits.max_speed) + radii + max_gap
    near = np.nonzero(np.hypot(offset[:, 0], offset[:, 1]) < reach)[0].tolist()
    nearest = np.full((k, t), max_gap)
    time = dt * np.arange(1, t + 1)
    for index in near:
        x, y = obstacles.position[index].tolist()
        u, w = obstacles.velocity[index].tolist()
        dx = position[..., 0] - (x + u * time)
        dy = position[..., 1] - (y + w * time)
        np.minimum(nearest, np.sqrt(dx * dx + dy * dy) - radii[index], out=nearest)
    return nearest


def contact_cost(gap: Array) -> Array:
    """Return 1 for a collision after the first footstep, less for later ones, 0 for none (k,).

    The depth of the first footstep in an obstacle [m] is added.
    """
    collides = gap < 0.0
    t = gap.shape[1]
    first = np.where(collides.any(axis=1), collides.argmax(axis=1), t)
    cost: Array = 1.0 - first / t + np.maximum(0.0, -gap[:, 0])
    return cost
