"""Inputs of a baseline: belief, task, speed limits and delay of the default planner."""

from dataclasses import dataclass, replace
from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from navigation.belief.tracks import Tracks
from navigation.decision import SpeedLimits, Task
from navigation.motion.velocity_mapping import body_velocity
from navigation.parameters.navigation import NavigationParameters
from navigation.transform import velocity_in_world

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class PlanningScene:
    """Inputs of one decision.

    Attributes:
        pose: pose of the robot in W (3,) [m, m, rad].
        body: present velocity of the robot in R (3,) [m/s, m/s, rad/s].
        obstacles: n obstacles in W.
        inflation: enlargement of their radii by uncertainty (n,) [m].
        task: task of the mission.
        course: direction of the move-to-goal field in W [rad].
        speed: desired speed along the course [m/s].
        facing: target heading; None for the direction of motion [rad].
        side: side of the arrival, see `move_to_goal`.
        limits: speed limits of the walking layer.
        parameters: profile.
    """

    pose: Array
    body: Array
    obstacles: Tracks
    inflation: Array
    task: Task
    course: float
    speed: float
    facing: float | None
    side: int
    limits: SpeedLimits
    parameters: NavigationParameters

    @property
    def s_robot(self) -> float:
        """Radius of the robot [m]."""
        return self.parameters.univector.s_robot

    @property
    def turn_change(self) -> float:
        """Maximum change of the turn rate between footsteps [rad/s]."""
        return self.parameters.safety_filter.turn_change

    def low(self) -> Array:
        """Return minimum vx, vy, wz (3,) [m/s, m/s, rad/s]."""
        return np.array([-self.limits.vx_backward, -self.limits.vy, -self.limits.wz])

    def high(self) -> Array:
        """Return maximum vx, vy, wz (3,) [m/s, m/s, rad/s]."""
        return np.array([self.limits.vx, self.limits.vy, self.limits.wz])

    def change(self) -> Array:
        """Return maximum changes between footsteps of vx, vy, wz (3,) [m/s, m/s, rad/s]."""
        step = self.limits.acceleration * self.limits.footstep
        return np.array([step, step, self.turn_change])

    def wanted(self) -> Array:
        """Return the desired velocity in W (2,) [m/s]."""
        return self.speed * np.array([cos(self.course), sin(self.course)])

    def velocity(self) -> Array:
        """Return the present velocity in W (2,) [m/s]."""
        return velocity_in_world(self.pose, self.body)

    def radii(self, margin: float) -> Array:
        """Return radii of the obstacles with uncertainty and a margin (n,) [m]."""
        return self.obstacles.radius + self.inflation + margin

    def yielding(self, gap: Array) -> Array:
        """Return the weight of the repulsion of obstacles at `gap` (n,) [m] (n,).

        It falls if the destination is nearer than the obstacle, so that a destination next to an
        obstacle can be reached (S. S. Ge, Y. J. Cui, "New potential functions for mobile robot
        path planning", IEEE T-RA 16(5), 2000).
        """
        x, y = (self.task.target - self.pose[:2]).tolist()
        weight: Array = np.minimum(1.0, np.hypot(x, y) / np.maximum(gap, 1e-3))
        return weight

    def predicted(self) -> "PlanningScene":
        """Return the scene after one footstep, when the command takes effect."""
        dt = self.limits.footstep
        pose = self.pose + dt * np.array([*self.velocity().tolist(), float(self.body[2])])
        return replace(self, pose=pose, obstacles=self.obstacles.moved(dt))

    def walk(self, velocity: Array) -> Array:
        """Return the body velocity (3,) for `velocity` in W (2,) [m/s].

        The target heading is the direction of motion, that of the destination for zero velocity,
        and the heading of the goal near the goal.
        """
        x, y = velocity.tolist()
        speed = float(np.hypot(x, y))
        course = float(np.arctan2(y, x)) if speed > 1e-9 else self.course
        return body_velocity(
            course,
            speed,
            float(self.pose[2]),
            course if self.facing is None else self.facing,
            limits=self.limits,
            turn_gain=self.parameters.velocity_mapping.turn_gain,
        )
