"""Potential field.

O. Khatib, "Real-time obstacle avoidance for manipulators and mobile robots",
IJRR 5(1), 1986; S. S. Ge, Y. J. Cui, "Dynamic motion planning for mobile robots using potential
field method", Autonomous Robots 13, 2002; the tangential part after A. De Luca, G. Oriolo,
"Local incremental planning for nonholonomic mobile robots", ICRA 1994.
"""

import numpy as np
from numpy.typing import NDArray

from navigation.motion.planning_scene import Desired, PlanningScene
from navigation.motion.univector import normalized
from navigation.parameters.planner import ApfParameters

Array = NDArray[np.float64]


class PotentialField:
    """Sum of the desired velocity and the repulsion of near obstacles."""

    def __init__(self, parameters: ApfParameters) -> None:
        self._parameters = parameters

    def desired(self, scene: PlanningScene) -> Desired:
        s = scene.predicted()
        limits = s.limits
        total = s.to_goal() + limits.vx * self._repulsion(s)
        speed = float(np.hypot(*total))
        velocity = total * min(1.0, limits.vx / max(speed, 1e-9))
        return Desired.towards(velocity, s, s.radii(self._parameters.margin))

    def _repulsion(self, s: PlanningScene) -> Array:
        """Return the sum over the obstacles (2,), ratio to the maximum speed."""
        p = self._parameters
        away = s.pose[:2] - s.obstacles.position
        distance = np.hypot(away[:, 0], away[:, 1])
        out = normalized(away)
        gap = distance - s.radii(p.margin)
        relative = s.obstacles.velocity - s.velocity()
        approach = np.maximum(0.0, np.sum(relative * out, axis=1))
        braking = p.reaction * approach + approach**2 / (2.0 * s.limits.acceleration)
        braking = np.where(s.obstacles.speed > 0.0, braking, 0.0)
        effective = np.maximum(p.min_gap, gap - braking)
        strength = p.gain * np.maximum(0.0, 1.0 / effective - 1.0 / p.influence)
        strength = strength * s.yielding(effective)
        # Side of the desired velocity; of a mover, away from its velocity.
        reference = s.to_goal()[None] - s.obstacles.velocity
        across = out[:, 0] * reference[:, 1] - out[:, 1] * reference[:, 0]
        side = np.where(across >= 0.0, 1.0, -1.0)
        ahead = np.sum(reference * out, axis=1) < 0.0
        around = np.stack([-out[:, 1], out[:, 0]], axis=1) * (p.swirl * side * ahead)[:, None]
        total: Array = (strength[:, None] * (out + around)).sum(axis=0)
        return total
