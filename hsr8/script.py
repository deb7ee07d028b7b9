"""A walk without navigation: the velocities come from the scenario, one after the other."""

from math import atan2, cos, hypot, sin

import numpy as np
from numpy.typing import NDArray

from hsr8.scenario.mission import Walk
from navigation.belief import Belief
from navigation.decision import MotionDecision, Task

Array = NDArray[np.float64]


class ScriptedMission:
    """Nowhere to go and never done."""

    def update(self, pose: Array) -> Task:
        """A target straight ahead, so that the gaze has somewhere to look."""
        x, y, yaw = pose.tolist()
        ahead = np.array([x + cos(yaw), y + sin(yaw)])
        return Task(ahead, yaw, is_goal=False, index=0, aligning=False, done=False)


class ScriptedPlanner:
    """Asks for the velocities of the scenario, whatever the robot believes.

    Args:
        walk: section of the scenario with the velocities; after the last the robot stands.
    """

    def __init__(self, walk: Walk) -> None:
        self._commands = walk.command

    def plan(self, belief: Belief, task: Task) -> MotionDecision:
        """The velocity in force now."""
        forward, left, turn = self._velocity(belief.time)
        return MotionDecision(
            velocity=np.array([forward, left, turn]),
            direction=float(belief.pose[2]) + atan2(left, forward),
            speed=hypot(forward, left),
            situation="free",
            virtual_obstacles=(),
            extended_radii=(),
        )

    def _velocity(self, time: float) -> tuple[float, float, float]:
        end = 0.0
        for stretch in self._commands:
            end += stretch.duration
            if time < end:
                return stretch.forward, stretch.left, stretch.turn
        return 0.0, 0.0, 0.0
