"""Inputs and result of a method of motion planning."""

from dataclasses import replace
from math import atan2, cos, hypot, sin
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from compilation.value import value
from navigation.belief.tracks import Tracks
from navigation.decision import DirectionField, Situation, SpeedLimits, Task, VirtualObstacle
from navigation.motion.velocity_mapping import body_velocity
from navigation.parameters.navigation import NavigationParameters
from navigation.transform import velocity_in_world

Array = NDArray[np.float64]


@value
class PlanningScene:
    """Inputs of one decision: obstacles that the method avoids, and the motion without them.

    Attributes:
        pose: pose of the robot in W (3,) [m, m, rad].
        body: present velocity of the robot in R (3,) [m/s, m/s, rad/s].
        obstacles: n obstacles in W.
        psi: psi_sf + psi_ob of each (n,).
        s_oe: extended radius of each, eq. (7) (n,) [m].
        task: task of the mission.
        course: direction of the move-to-goal field in W [rad].
        speed: desired speed along the course [m/s].
        facing: target heading; None for the direction of motion [rad].
        side: side of the arrival, see `move_to_goal`.
        limits: speed limits of the walking layer.
        parameters: profile.
        plan: state of the method after its latest decision; None at the start.
    """

    pose: Array
    body: Array
    obstacles: Tracks
    psi: Array
    s_oe: Array
    task: Task
    course: float
    speed: float
    facing: float | None
    side: int
    limits: SpeedLimits
    parameters: NavigationParameters
    plan: object = None

    @property
    def touching(self) -> Array:
        """Distances at which the bodies touch (n,) [m]."""
        return self.parameters.univector.s_robot + self.obstacles.radius

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

    def to_goal(self) -> Array:
        """Return the velocity of the move-to-goal field in W (2,) [m/s]."""
        return self.speed * np.array([cos(self.course), sin(self.course)])

    def velocity(self) -> Array:
        """Return the present velocity in W (2,) [m/s]."""
        return velocity_in_world(self.pose, self.body)

    def radii(self, margin: float) -> Array:
        """Return collision distances with position uncertainty and a margin (n,) [m]."""
        o = self.obstacles
        sigma = np.minimum(self.parameters.planner.max_sigma, o.sigma)
        return self.touching + np.where(o.static, 0.0, sigma) + margin

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

    def walk(self, direction: float, speed: float) -> Array:
        """Return the body velocity (3,) for a direction in W [rad] and a speed [m/s].

        The target heading is the direction of motion, and the heading of the goal near the goal.
        """
        return body_velocity(
            direction,
            speed,
            float(self.pose[2]),
            direction if self.facing is None else self.facing,
            limits=self.limits,
            turn_gain=self.parameters.velocity_mapping.turn_gain,
        )


@value
class Desired:
    """Desired motion, the result of a method.

    Attributes:
        velocity: velocity in W (2,) [m/s].
        direction: its direction, defined also for zero velocity [rad].
        situation: why it differs from the desired motion, see `Situation`.
        virtual: active virtual obstacles of the method of the paper.
        radii: collision distances of the obstacles, for displays (n,) [m].
        field: vector field; None for a method without one.
        body: velocity in R, which replaces `velocity`, of a method that decides the turn rate,
            too (3,) [m/s, m/s, rad/s].
        plan: state of the method for its next decision.
    """

    velocity: Array
    direction: float
    situation: Situation = "free"
    virtual: tuple[VirtualObstacle, ...] = ()
    radii: Array | None = None
    field: DirectionField | None = None
    body: Array | None = None
    plan: object = None

    @classmethod
    def towards(cls, velocity: Array, scene: PlanningScene, radii: Array) -> "Desired":
        """Return the motion at `velocity` in W (2,) [m/s]; a robot that stands faces its course."""
        x, y = velocity.tolist()
        return cls(velocity, atan2(y, x) if hypot(x, y) > 1e-9 else scene.course, radii=radii)


class Method(Protocol):
    """Method of motion planning; its only state is `Desired.plan`."""

    def desired(self, scene: PlanningScene) -> Desired:
        """Return the motion of the next footstep."""
