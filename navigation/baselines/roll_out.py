"""Sequences of footsteps rolled out over time, for the baselines that sample."""

import numpy as np
from numpy.typing import NDArray

from navigation.baselines.planning_scene import PlanningScene

Array = NDArray[np.float64]


def roll_out(pose: Array, body: Array, footstep: float) -> tuple[Array, Array]:
    """Walk with body velocities, each for one footstep.

    Args:
        pose: where to begin (3,) [m, m, rad].
        body: forward, left, turn of k sequences of t footsteps (k, t, 3).
        footstep: its duration [s].

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


def gaps(position: Array, scene: PlanningScene, radii: Array, most: float) -> Array:
    """Gap to the nearest obstacle after every footstep (k, t) [m].

    Args:
        position: of k sequences of t footsteps (k, t, 2) [m].
        scene: with the obstacles, which go on at constant velocity.
        radii: distances at which they are touched (n,) [m].
        most: gap that is told where it is larger [m].
    """
    k, t, _ = position.shape
    limits, obstacles = scene.envelope.limits, scene.obstacles
    dt = limits.footstep
    offset = obstacles.position - scene.pose[:2]
    reach = t * dt * (obstacles.speed + limits.max_speed) + radii + most
    near = np.nonzero(np.hypot(offset[:, 0], offset[:, 1]) < reach)[0].tolist()
    least = np.full((k, t), most)
    when = dt * np.arange(1, t + 1)
    for index in near:
        x, y = obstacles.position[index].tolist()
        u, w = obstacles.velocity[index].tolist()
        dx = position[..., 0] - (x + u * when)
        dy = position[..., 1] - (y + w * when)
        np.minimum(least, np.sqrt(dx * dx + dy * dy) - radii[index], out=least)
    return least


def contact_cost(gap: Array) -> Array:
    """From one for a contact after the first footstep down to zero for none (k,).

    Where the first footstep already ends in an obstacle, its depth [m] is added.
    """
    touched = gap < 0.0
    t = gap.shape[1]
    first = np.where(touched.any(axis=1), touched.argmax(axis=1), t)
    cost: Array = 1.0 - first / t + np.maximum(0.0, -gap[:, 0])
    return cost
