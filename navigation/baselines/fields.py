"""Baselines that follow a field: potential field, and the univector field alone.

Potential field: O. Khatib, "Real-time obstacle avoidance for manipulators and mobile robots",
IJRR 5(1), 1986; S. S. Ge, Y. J. Cui, "Dynamic motion planning for mobile robots using potential
field method", Autonomous Robots 13, 2002; the tangential part after A. De Luca, G. Oriolo,
"Local incremental planning for nonholonomic mobile robots", ICRA 1994. Univector field: Yoo & Kim,
eqs. (7)-(10).
"""

from dataclasses import replace
from math import atan2, hypot

import numpy as np
from numpy.typing import NDArray

from navigation.baselines.baseline_planner import Avoidance
from navigation.baselines.planning_scene import PlanningScene
from navigation.motion.motion_field import FieldScene, MotionField
from navigation.motion.univector import normalized
from navigation.parameters.navigation import NavigationParameters
from navigation.parameters.planner import ApfParameters

Array = NDArray[np.float64]


class PotentialField(Avoidance):
    """Sum of the desired velocity and the repulsion of near obstacles."""

    def __init__(self, parameters: ApfParameters) -> None:
        self.margin = parameters.margin
        self._parameters = parameters

    def decide(self, scene: PlanningScene) -> Array:
        s = scene.predicted()
        limits = s.limits
        total = s.wanted() + limits.vx * self._repulsion(s)
        speed = float(np.hypot(*total))
        return s.walk(total * min(1.0, limits.vx / max(speed, 1e-9)))

    def _repulsion(self, s: PlanningScene) -> Array:
        """Return the sum over the obstacles (2,), ratio to the maximum speed."""
        p = self._parameters
        away = s.pose[:2] - s.obstacles.position
        distance = np.hypot(away[:, 0], away[:, 1])
        out = normalized(away)
        gap = distance - s.s_robot - s.radii(self.margin)
        relative = s.obstacles.velocity - s.velocity()
        approach = np.maximum(0.0, np.sum(relative * out, axis=1))
        braking = p.reaction * approach + approach**2 / (2.0 * s.limits.acceleration)
        braking = np.where(s.obstacles.speed > 0.0, braking, 0.0)
        effective = np.maximum(p.min_gap, gap - braking)
        strength = p.gain * np.maximum(0.0, 1.0 / effective - 1.0 / p.influence)
        strength = strength * s.yielding(effective)
        # Side of the desired velocity; of a mover, away from its velocity.
        reference = s.wanted()[None] - s.obstacles.velocity
        side = np.sign(out[:, 0] * reference[:, 1] - out[:, 1] * reference[:, 0])
        ahead = np.sum(reference * out, axis=1) < 0.0
        around = np.stack([-out[:, 1], out[:, 0]], axis=1) * (p.swirl * side * ahead)[:, None]
        total: Array = (strength[:, None] * (out + around)).sum(axis=0)
        return total


class PlainUnivector(Avoidance):
    """Univector field alone: a mover is a disc at its present position, inflated by its speed.

    There is no dynamic virtual obstacle, no velocity modification and no safety filter.
    """

    def __init__(self, parameters: NavigationParameters) -> None:
        """Combine the form of `univector` with the sizes of `planner.univector_plain`."""
        p = parameters.planner.univector_plain
        self.margin = p.margin
        self._eta_vo = p.eta_vo
        shape = replace(parameters.univector, d_e=p.d_e, d_b=p.d_b, k_r=p.k_r)
        self._field = MotionField(shape, parameters.moving_obstacles)

    def decide(self, scene: PlanningScene) -> Array:
        s = scene.predicted()
        if s.speed == 0.0:
            return s.walk(np.zeros(2))
        n = len(s.obstacles)
        radii = s.s_robot + s.radii(self.margin) + self._eta_vo * s.obstacles.speed
        discs = FieldScene(s.obstacles, radii, np.zeros(n), s.task.target, s.task.heading, s.side)
        u_x, u_y = self._field.at(s.pose[:2], float(s.pose[2]), discs, ()).tolist()
        if hypot(u_x, u_y) < 1e-9:
            return s.walk(s.wanted())
        angle = atan2(u_y, u_x)
        return s.walk(s.speed * np.array([np.cos(angle), np.sin(angle)]))
