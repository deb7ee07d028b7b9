"""Univector posture field of Kim et al. with the obstacle field of Lim et al.

phi = angle(g - p) - n wrap(angle(r - p) - angle(g - p)), r = g + d [cos, sin] of the
arrival heading; an obstacle repels radially from p_o + K_o (v_o - v_r), mixed in by a
Gaussian of the gap. Sources: Y.-J. Kim, J.-H. Kim, D.-S. Kwon, "Evolutionary programming-
based univector field navigation method for fast mobile robots", IEEE T-SMC-B 31(3), 2001;
Y. Lim, S.-H. Choi, J.-H. Kim, D.-H. Kim, "Evolutionary univector field-based navigation
with collision avoidance for mobile robot", IFAC World Congress, 2008.
"""

from math import atan2, hypot

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap
from navigation.motion.planning_scene import Desired, PlanningScene
from navigation.motion.univector import normalized
from navigation.parameters.planner import NPostureParameters

Array = NDArray[np.float64]


class NPosture:
    """Posture field with the obstacle field of the nearest obstacle."""

    def __init__(self, parameters: NPostureParameters) -> None:
        self._parameters = parameters

    def desired(self, scene: PlanningScene) -> Desired:
        s = scene.predicted()
        velocity = np.zeros(2)
        if s.speed > 0.0:
            phi = self._posture(s)
            velocity = s.speed * self._mixed(s, np.array([np.cos(phi), np.sin(phi)]))
        return Desired.towards(velocity, s, s.radii(self._parameters.margin))

    def _posture(self, s: PlanningScene) -> float:
        """Return the direction of Kim's field at the robot [rad]."""
        p = self._parameters
        dx, dy = (s.task.target - s.pose[:2]).tolist()
        bearing = atan2(dy, dx)
        x = dx + p.offset * np.cos(s.task.heading)
        y = dy + p.offset * np.sin(s.task.heading)
        turn = p.gain * wrap(atan2(y, x) - bearing)
        # More than a right angle would lead away from the destination.
        return bearing - float(np.clip(turn, -0.5 * np.pi, 0.5 * np.pi))

    def _mixed(self, s: PlanningScene, u_goal: Array) -> Array:
        """Return Lim's blend of the field of the nearest obstacle with `u_goal` (2,)."""
        p = self._parameters
        if len(s.obstacles) == 0:
            return u_goal
        relative = s.obstacles.velocity - s.velocity()
        moving = (s.obstacles.speed > 0.0)[:, None]
        shifted = s.obstacles.position + p.lead * relative * moving
        away = s.pose[:2] - s.obstacles.position
        distance = np.hypot(away[:, 0], away[:, 1])
        # A shift beyond the robot would repel towards the obstacle.
        reach = np.hypot(*(shifted - s.obstacles.position).T)
        scale = np.minimum(1.0, 0.5 * distance / np.maximum(reach, 1e-9))[:, None]
        shifted = s.obstacles.position + scale * (shifted - s.obstacles.position)
        gap = np.hypot(*(s.pose[:2] - shifted).T) - s.radii(p.margin)
        gap = np.minimum(gap, distance - s.radii(p.margin))
        nearest = int(np.argmin(gap))
        over = max(0.0, float(gap[nearest]) - p.d_min)
        weight = float(np.exp(-(over**2) / (2.0 * p.delta**2)) * s.yielding(gap)[nearest])
        out = normalized(s.pose[:2] - shifted[nearest])
        mixed: Array = weight * out + (1.0 - weight) * u_goal
        # If the two cancel, the robot slides along the obstacle on the side of the goal.
        if hypot(*mixed.tolist()) < 0.3:
            side = 1.0 if out[0] * u_goal[1] - out[1] * u_goal[0] >= 0.0 else -1.0
            mixed = mixed + side * np.array([-out[1], out[0]])
        return normalized(mixed)
