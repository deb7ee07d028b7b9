"""Dynamic window approach, Fox, Burgard & Thrun 1997, with obstacles that move.

"The dynamic window approach to collision avoidance", IEEE RAM 4(1); obstacles at constant
velocity as in M. Seder, I. Petrovic, "Dynamic window based approach to mobile robot motion
control in the presence of moving obstacles", ICRA 2007.
"""

import numpy as np
from numpy.typing import NDArray

from navigation.angles import wrap_array
from navigation.baselines.planning_scene import PlanningScene
from navigation.baselines.roll_out import contact_cost, gaps, roll_out
from navigation.parameters.planner import DwaParameters

Array = NDArray[np.float64]


class DynamicWindow:
    """The best of all body velocities that the next footstep can reach."""

    def __init__(self, parameters: DwaParameters, s_robot: float) -> None:
        """Keep the weights; `s_robot` is the robot's radius [m]."""
        self.margin = parameters.margin
        self._parameters = parameters
        self._s_robot = s_robot

    def decide(self, scene: PlanningScene) -> Array:
        """Body velocity of least cost (3,) [m/s, m/s, rad/s]."""
        s, p = scene, self._parameters
        limits = s.envelope.limits
        window = self._window(s)
        steps = max(1, round(p.horizon / limits.footstep))
        held = np.broadcast_to(window[:, None], (len(window), steps, 3))
        position, heading = roll_out(s.pose, held, limits.footstep)
        horizon = steps * limits.footstep
        # A carrot on the way: the destination itself would be overrun in the horizon.
        carrot = s.pose[:2] + horizon * s.wanted()
        off = position[:, -1] - carrot
        gap = gaps(position, s, self._s_robot + s.radii(p.margin), p.clearance)
        facing = s.course if s.facing is None else s.facing
        turn = window[:, 2]
        stopping = 0.5 * turn * np.abs(turn) / s.envelope.turn_change * limits.footstep
        left = np.abs(wrap_array(facing - heading[:, 0] - stopping))
        cost = (
            np.hypot(off[:, 0], off[:, 1]) / (horizon * limits.vx)
            + p.heading_weight * left / np.pi
            + p.clearance_weight * np.maximum(0.0, 1.0 - gap.min(axis=1) / p.clearance)
            + p.contact_weight * contact_cost(gap)
        )
        best: Array = window[int(np.argmin(cost))]
        return best

    def _window(self, s: PlanningScene) -> Array:
        """Velocities within reach (n, 3), standing still among them if it is."""
        low, high, change = s.envelope.low(), s.envelope.high(), s.envelope.change()
        low, high = np.maximum(low, s.body - change), np.minimum(high, s.body + change)
        axes = [
            np.linspace(a, b, n)
            for a, b, n in zip(low, high, self._parameters.samples, strict=True)
        ]
        axes = [np.sort(np.append(axis, np.clip(0.0, axis[0], axis[-1]))) for axis in axes]
        grid = np.meshgrid(*axes, indexing="ij")
        window: Array = np.stack([g.ravel() for g in grid], axis=1)
        return window
