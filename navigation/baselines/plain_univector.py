"""Univector field of Yoo & Kim, eqs. (7)-(10), without treatment of moving obstacles."""

from dataclasses import replace
from math import atan2, hypot

import numpy as np
from numpy.typing import NDArray

from navigation.baselines.baseline_planner import Avoidance
from navigation.baselines.planning_scene import PlanningScene
from navigation.motion.motion_field import FieldScene, MotionField
from navigation.parameters.navigation import NavigationParameters

Array = NDArray[np.float64]


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
