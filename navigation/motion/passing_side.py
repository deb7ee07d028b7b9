"""Passing side of obstacles: remembered, and common to a group.

Eq. (9) takes the shorter side of each obstacle. It leads the robot into a gap that is too narrow,
and near the line to the destination the side may flip from step to step.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

from navigation.belief.tracks import Tracks
from navigation.motion.avoid_obstacle import turning_sign
from navigation.parameters.motion import UnivectorParameters

Array = NDArray[np.float64]


def groups(obstacles: Tracks, width: float) -> NDArray[np.int64]:
    """Return the group of each obstacle (n,); gaps in a group are narrower than `width` [m]."""
    if len(obstacles) == 0:
        return np.zeros(0, dtype=np.int64)
    offset = obstacles.position[:, None] - obstacles.position
    gap = np.hypot(offset[..., 0], offset[..., 1]) - obstacles.radius[:, None] - obstacles.radius
    _, labels = connected_components(gap < width, directed=False)
    return np.asarray(labels, dtype=np.int64)


class PassingSides:
    """Signs of (9), kept from step to step."""

    def __init__(self, parameters: UnivectorParameters) -> None:
        self._parameters = parameters
        self._signs: dict[int, float] = {}

    def signs(self, position: Array, target: Array, obstacles: Tracks, s_oe: Array) -> Array:
        """Return the sign of (9) for each obstacle (n,).

        Args:
            position: position of the robot (2,) [m].
            target: destination (2,) [m].
            obstacles: n obstacles.
            s_oe: extended radii (n,) [m].
        """
        p = self._parameters
        chosen = turning_sign(target - obstacles.position, position - obstacles.position)
        label = groups(obstacles, 2.0 * p.s_robot) if p.grouping else np.arange(len(obstacles))
        if p.grouping:
            for group in np.unique(label):
                members = label == group
                middle = obstacles.position[members].mean(axis=0)
                chosen[members] = turning_sign(target - middle, position - middle)
        if p.side_memory:
            offset = obstacles.position - position
            near = np.hypot(offset[:, 0], offset[:, 1]) <= s_oe + p.d_e + p.d_b
            ids = obstacles.ids.tolist()
            for group in np.unique(label):
                members = np.flatnonzero((label == group) & near).tolist()
                known = [self._signs[ids[k]] for k in members if ids[k] in self._signs]
                if known:
                    chosen[label == group] = known[0]
            self._signs = {ids[k]: float(chosen[k]) for k in np.flatnonzero(near).tolist()}
        return chosen
