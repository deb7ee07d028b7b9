"""Reward: progress, time, tracking errors and outcome, computed from the ground truth."""

from collections.abc import Mapping
from itertools import pairwise
from math import hypot

import numpy as np
from numpy.typing import NDArray

from hsr8.simulation.decisions import Situation
from hsr8.world.field.layout import Layout
from hsr8.world.truth.truth import Truth
from navigation.belief.belief import Belief

Array = NDArray[np.float64]

WEIGHTS = {
    "progress": 1.0,  # along the mission [1/m]
    "time": -0.05,  # [1/s]
    "tracking": -0.2,  # mean error of the obstacles near the robot, of 1 [1/s]
    "outcome": 5.0,  # 1 for success, -1 for a collision, a fall or divergence [1]
}
# Lengths are those in a world of scale 1.
RANGE = 1.5  # from the robot to an obstacle whose tracking counts [m]
MAX_ERROR = 0.4  # distance from obstacle to track that counts as 1 [m]


class Reward:
    """Reward terms of one run.

    Args:
        layout: layout of the run's world.
        weights: weights of the terms.
    """

    def __init__(self, layout: Layout, weights: Mapping[str, float]) -> None:
        self._weights = weights
        self._scale = layout.scale
        self._points = np.reshape(layout.waypoints, (-1, 2)).tolist()
        self._progress, self._time = 0.0, 0.0

    def start(self, truth: Truth) -> None:
        """Count progress and time from here."""
        self._progress, self._time = self._travelled(truth, 0), truth.time

    def terms(self, truth: Truth, situation: Situation, outcome: int) -> dict[str, float]:
        """Return the weighted terms since the previous call; their sum is the reward.

        Args:
            truth: truth of the world.
            situation: situation of the latest decision.
            outcome: 1 for success, -1 for failure, 0 otherwise.
        """
        progress, elapsed = self._travelled(truth, situation.task.index), truth.time - self._time
        values = {
            "progress": progress - self._progress,
            "time": elapsed,
            "tracking": elapsed * self._tracking_error(truth, situation.belief),
            "outcome": outcome,
        }
        self._progress, self._time = progress, truth.time
        return {name: self._weights[name] * value for name, value in values.items()}

    def _travelled(self, truth: Truth, index: int) -> float:
        """Return the length of the mission up to the next point, less the distance to it [m]."""
        points = self._points
        if not points:
            return 0.0
        passed = [points[k % len(points)] for k in range(index + 1)]
        x, y, _ = truth.robot.tolist()
        legs = sum(hypot(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(passed))
        return legs - hypot(passed[-1][0] - x, passed[-1][1] - y)

    def _tracking_error(self, truth: Truth, belief: Belief) -> float:
        """Return the mean error of the obstacles near the robot, each from 0 to 1."""
        offsets = truth.obstacle_positions - truth.robot[:2]
        near = truth.obstacle_positions[np.hypot(*offsets.T) < RANGE * self._scale]
        if not len(near):
            return 0.0
        if not belief.tracks:
            return 1.0
        tracks = np.array([track.position for track in belief.tracks])
        distances = np.hypot(*np.moveaxis(near[:, None] - tracks, -1, 0)).min(axis=1)
        return float(np.minimum(distances / (MAX_ERROR * self._scale), 1.0).mean())
