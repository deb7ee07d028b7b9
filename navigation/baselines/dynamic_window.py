"""Dynamic window approach, Fox, Burgard & Thrun 1997, with obstacles that move.

"The dynamic window approach to collision avoidance", IEEE RAM 4(1); obstacles at constant
velocity as in M. Seder, I. Petrovic, "Dynamic window based approach to mobile robot motion
control in the presence of moving obstacles", ICRA 2007.
"""

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap_array
from navigation.baselines.baseline_planner import Avoidance
from navigation.baselines.planning_scene import PlanningScene
from navigation.baselines.rollout import contact_cost, gaps, rollout
from navigation.parameters.planner import DwaParameters

Array = NDArray[np.float64]


class DynamicWindow(Avoidance):
    """Best body velocity among those within reach of the next footstep."""

    def __init__(self, parameters: DwaParameters) -> None:
        self.margin = parameters.margin
        self._parameters = parameters

    def decide(self, scene: PlanningScene) -> Array:
        s, p = scene, self._parameters
        limits = s.limits
        window = self._window(s)
        steps = max(1, round(p.horizon / limits.footstep))
        constant = np.broadcast_to(window[:, None], (len(window), steps, 3))
        position, heading = rollout(s.pose, constant, limits.footstep)
        horizon = steps * limits.footstep
        # A point ahead at the desired speed: the horizon may reach beyond the destination.
        error = position[:, -1] - (s.pose[:2] + horizon * s.wanted())
        gap = gaps(position, s, s.s_robot + s.radii(p.margin), p.clearance)
        facing = s.course if s.facing is None else s.facing
        wz = window[:, 2]
        stopping = 0.5 * wz * np.abs(wz) / s.turn_change * limits.footstep
        heading_error = np.abs(wrap_array(facing - heading[:, 0] - stopping))
        cost = (
            np.hypot(error[:, 0], error[:, 1]) / (horizon * limits.vx)
            + p.heading_weight * heading_error / np.pi
            + p.clearance_weight * np.maximum(0.0, 1.0 - gap.min(axis=1) / p.clearance)
            + p.contact_weight * contact_cost(gap)
        )
        best: Array = window[int(np.argmin(cost))]
        return best

    def _window(self, s: PlanningScene) -> Array:
        """Return velocities within reach (n, 3), with zero components where possible."""
        low, high, change = s.low(), s.high(), s.change()
        low, high = np.maximum(low, s.body - change), np.minimum(high, s.body + change)
        axes = [
            np.linspace(a, b, n)
            for a, b, n in zip(low, high, self._parameters.samples, strict=True)
        ]
        axes = [np.sort(np.append(axis, np.clip(0.0, axis[0], axis[-1]))) for axis in axes]
        grid = np.meshgrid(*axes, indexing="ij")
        window: Array = np.stack([g.ravel() for g in grid], axis=1)
        return window
