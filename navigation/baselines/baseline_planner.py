"""Planner of all baselines: move-to-goal field, arrival, turn at the goal."""

from math import atan2, hypot
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap
from navigation.baselines.planning_scene import PlanningScene
from navigation.belief.belief import Belief
from navigation.belief.tracks import Tracks
from navigation.decision import MotionDecision, SpeedLimits, Task, read_only
from navigation.motion.move_to_goal import ArrivalSide, arrival_gain, move_to_goal
from navigation.motion.velocity_mapping import idle_velocity, target_heading
from navigation.parameters.navigation import NavigationParameters

Array = NDArray[np.float64]


class Avoidance(Protocol):
    """Obstacle avoidance of one baseline.

    Attributes:
        margin: distance to the bodies of obstacles [m].
    """

    margin: float

    def decide(self, scene: PlanningScene) -> Array:
        """Return the body velocity of the next footstep, vx, vy, wz (3,) [m/s, m/s, rad/s]."""


class BaselinePlanner:
    """Published obstacle avoidance with the arrival of the default planner.

    Direction and speed towards the destination, the turn to the heading of the goal, the turn of
    a lost robot and the stop at the end are those of the default planner.
    """

    def __init__(
        self, parameters: NavigationParameters, limits: SpeedLimits, avoidance: Avoidance
    ) -> None:
        """Start standing.

        Args:
            parameters: profile; univector, velocity_mapping and planner are used.
            limits: speed limits of the walking layer.
            avoidance: obstacle avoidance of the baseline.
        """
        self._parameters = parameters
        self._limits = limits
        self._avoidance = avoidance
        self._arrival = ArrivalSide(parameters.univector)
        self._body = np.zeros(3)

    def plan(self, belief: Belief, task: Task, look: float | None = None) -> MotionDecision:
        """Decide the motion of the next footstep; call once per footstep.

        Args:
            belief: belief of the robot.
            task: task of the mission.
            look: direction in W that the body turns to for a fixed camera, if any [rad].
        """
        heading = float(belief.pose[2])
        if task.done or belief.lost:
            turn_rate = self._parameters.velocity_mapping.lost_turn_rate
            self._body = idle_velocity(not task.done, turn_rate, self._limits)
            return MotionDecision(read_only(self._body), heading)
        scene = self._scene(belief, task, look)
        self._body = np.clip(self._avoidance.decide(scene), scene.low(), scene.high())
        vx, vy, _ = self._body.tolist()
        speed = hypot(vx, vy)
        direction = wrap(heading + atan2(vy, vx)) if speed > 1e-9 else scene.course
        radii = scene.s_robot + scene.radii(self._avoidance.margin)
        pairs = zip(scene.obstacles.ids.tolist(), radii.tolist(), strict=True)
        return MotionDecision(read_only(self._body), direction, speed, extended_radii=tuple(pairs))

    def _scene(self, belief: Belief, task: Task, look: float | None) -> PlanningScene:
        p = self._parameters
        obstacles = Tracks.of(belief.tracks)
        obstacles = obstacles.where(~obstacles.lost | (obstacles.age <= p.planner.memory))
        sigma = np.minimum(p.planner.max_sigma, obstacles.sigma)
        course, speed, side = self._move_to_goal(belief.pose, task)
        return PlanningScene(
            pose=belief.pose,
            body=self._body,
            obstacles=obstacles,
            inflation=np.where(obstacles.static, 0.0, sigma),
            task=task,
            course=course,
            speed=speed,
            facing=target_heading(belief.pose[:2], task, look, course, p),
            side=side,
            limits=self._limits,
            parameters=p,
        )

    def _move_to_goal(self, pose: Array, task: Task) -> tuple[float, float, int]:
        """Return direction [rad], speed [m/s] and arrival side without obstacles."""
        if task.aligning:
            return float(pose[2]), 0.0, 0
        p = self._parameters.univector
        side = self._arrival.update(pose[:2], task)
        dx, dy = (task.target - pose[:2]).tolist()
        course = float(move_to_goal(pose[:2], pose[2], task.target, task.heading, p, side=side))
        speed = self._limits.vx * arrival_gain(hypot(dx, dy), task.is_goal, p)
        return course, speed, side
