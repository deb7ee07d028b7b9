"""All that the baselines share: the way to the destination, arrival, turning at the goal."""

from math import atan2, hypot
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap
from navigation.baselines.planning_scene import BodyEnvelope, PlanningScene
from navigation.belief.belief import Belief
from navigation.decision import MotionDecision, SpeedLimits, Task
from navigation.motion.facing import arriving
from navigation.motion.move_to_goal import ArrivalSide, arrival_gain, move_to_goal
from navigation.motion.velocity_mapping import idle_velocity
from navigation.obstacle_set import ObstacleSet
from navigation.parameters.navigation import NavigationParameters

Array = NDArray[np.float64]


class Avoidance(Protocol):
    """What distinguishes one baseline from another."""

    margin: float

    def decide(self, scene: PlanningScene) -> Array:
        """Body velocity for the next footstep (3,) [m/s, m/s, rad/s]."""


class BaselinePlanner:
    """A published way to avoid obstacles with our way to arrive.

    Direction and speed towards the destination, the turn to the goal's heading near it,
    turning when lost and standing when done are those of our planner; only the avoidance differs.
    """

    def __init__(
        self, parameters: NavigationParameters, limits: SpeedLimits, avoidance: Avoidance
    ) -> None:
        """Start standing.

        Args:
            parameters: profile; univector, body and planner are used.
            limits: envelope of the walking layer.
            avoidance: the baseline.
        """
        self._parameters = parameters
        self._limits = limits
        self._avoidance = avoidance
        self._envelope = BodyEnvelope(
            limits, parameters.velocity_mapping.turn_gain, parameters.safety_filter.turn_change
        )
        self._arrival = ArrivalSide(parameters.univector)
        self._body = np.zeros(3)

    def plan(self, belief: Belief, task: Task) -> MotionDecision:
        """Decide the motion of the next footstep; call once per footstep.

        Args:
            belief: what the robot believes now.
            task: where it is to go.
        """
        heading = float(belief.pose[2])
        if task.done or belief.lost:
            turn = self._parameters.velocity_mapping.lost_turn_rate
            self._body = idle_velocity(not task.done, turn, self._limits)
            return MotionDecision(self._body, heading)
        scene = self._scene(belief, task)
        limits = self._envelope
        self._body = np.clip(self._avoidance.decide(scene), limits.low(), limits.high())
        forward, left, _ = self._body.tolist()
        speed = hypot(forward, left)
        direction = wrap(heading + atan2(left, forward)) if speed > 1e-9 else scene.course
        radii = self._parameters.univector.s_robot + scene.radii(self._avoidance.margin)
        pairs = zip(scene.obstacles.ids.tolist(), radii.tolist(), strict=True)
        return MotionDecision(self._body, direction, speed, extended_radii=tuple(pairs))

    def _scene(self, belief: Belief, task: Task) -> PlanningScene:
        p = self._parameters
        known = [t for t in belief.tracks if t.particles is None or t.age <= p.planner.memory]
        obstacles = ObstacleSet.from_tracks(known)
        course, speed, side = self._way(belief.pose, task)
        turning = arriving(belief.pose[:2], task, p.univector.holonomic_distance)
        return PlanningScene(
            pose=belief.pose,
            body=self._body,
            obstacles=obstacles,
            swelling=np.where(
                obstacles.static, 0.0, np.minimum(p.planner.max_sigma, obstacles.sigma)
            ),
            task=task,
            course=course,
            speed=speed,
            facing=task.heading if turning else None,
            side=side,
            envelope=self._envelope,
        )

    def _way(self, pose: Array, task: Task) -> tuple[float, float, int]:
        """Direction [rad], speed [m/s] and side of our way where there is no obstacle."""
        if task.aligning:
            return float(pose[2]), 0.0, 0
        p = self._parameters.univector
        side = self._arrival.update(pose[:2], task)
        dx, dy = (task.target - pose[:2]).tolist()
        course = float(move_to_goal(pose[:2], pose[2], task.target, task.heading, p, side=side))
        speed = self._limits.vx * arrival_gain(hypot(dx, dy), task.is_goal, p)
        return course, speed, side
