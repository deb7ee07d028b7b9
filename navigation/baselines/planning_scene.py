"""What a baseline is told: the same belief, task, envelope and delays as our planner."""

from dataclasses import dataclass, replace
from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from navigation.decision import SpeedLimits, Task
from navigation.motion.velocity_mapping import body_velocity
from navigation.obstacle_set import ObstacleSet
from navigation.transform import velocity_in_world

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class BodyEnvelope:
    """What the body can do.

    Attributes:
        limits: largest speeds, acceleration and the footstep a command is latched for.
        turn_gain: turn rate per heading error [1/s].
        turn_change: largest change of the turn rate per footstep [rad/s].
    """

    limits: SpeedLimits
    turn_gain: float
    turn_change: float

    def low(self) -> Array:
        """Least forward, left and turn (3,) [m/s, m/s, rad/s]."""
        return np.array([-self.limits.vx_backward, -self.limits.vy, -self.limits.wz])

    def high(self) -> Array:
        """Largest forward, left and turn (3,) [m/s, m/s, rad/s]."""
        return np.array([self.limits.vx, self.limits.vy, self.limits.wz])

    def change(self) -> Array:
        """Largest change of them from footstep to footstep (3,) [m/s, m/s, rad/s]."""
        step = self.limits.acceleration * self.limits.footstep
        return np.array([step, step, self.turn_change])


@dataclass(frozen=True, slots=True)
class PlanningScene:
    """What one decision is made from.

    Attributes:
        pose: of the robot in W (3,) [m, m, rad].
        body: its present velocity in R (3,) [m/s, m/s, rad/s].
        obstacles: n obstacles in W.
        swelling: uncertainty to add to their radii (n,) [m].
        task: where to go.
        course: direction of the way to the destination in W [rad].
        speed: wanted along it [m/s].
        facing: heading to turn to; None for the direction of motion [rad].
        side: on which a destination to be entered from beyond is circled, see `move_to_goal`.
        envelope: of the body.
    """

    pose: Array
    body: Array
    obstacles: ObstacleSet
    swelling: Array
    task: Task
    course: float
    speed: float
    facing: float | None
    side: int
    envelope: BodyEnvelope

    def wanted(self) -> Array:
        """Velocity towards the destination in W (2,) [m/s]."""
        return self.speed * np.array([cos(self.course), sin(self.course)])

    def velocity(self) -> Array:
        """Present velocity in W (2,) [m/s]."""
        return velocity_in_world(self.pose, self.body)

    def radii(self, margin: float) -> Array:
        """Radii of the obstacles with their uncertainty and a margin (n,) [m]."""
        return self.obstacles.radius + self.swelling + margin

    def yielding(self, gap: Array) -> Array:
        """Share of the repulsion of obstacles at `gap` (n,) [m] that is left (n,).

        It falls when the destination is nearer than the obstacle: else a destination
        beside an obstacle could not be reached (S. S. Ge, Y. J. Cui, "New potential
        functions for mobile robot path planning", IEEE T-RA 16(5), 2000).
        """
        x, y = (self.task.target - self.pose[:2]).tolist()
        share: Array = np.minimum(1.0, np.hypot(x, y) / np.maximum(gap, 1e-3))
        return share

    def in_effect(self) -> "PlanningScene":
        """The scene one footstep later, when the command has become motion."""
        dt = self.envelope.limits.footstep
        moved = self.pose + dt * np.array([*self.velocity().tolist(), float(self.body[2])])
        carried = self.obstacles.position + dt * self.obstacles.velocity
        return replace(self, pose=moved, obstacles=replace(self.obstacles, position=carried))

    def walk(self, velocity: Array) -> Array:
        """Body velocity (3,) that walks with `velocity` in W (2,) [m/s].

        The body turns to where it walks, to the destination when it stands, and to the
        goal's heading near the goal.
        """
        x, y = velocity.tolist()
        speed = float(np.hypot(x, y))
        course = float(np.arctan2(y, x)) if speed > 1e-9 else self.course
        return body_velocity(
            course,
            speed,
            self.pose[2],
            course if self.facing is None else self.facing,
            limits=self.envelope.limits,
            turn_gain=self.envelope.turn_gain,
        )
