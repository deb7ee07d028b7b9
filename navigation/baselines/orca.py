"""Optimal reciprocal collision avoidance against obstacles that never give way.

J. van den Berg, S. Guy, M. Lin, D. Manocha, "Reciprocal n-body collision avoidance",
Robotics Research 2011 (ISRR 2009).
"""

from math import cos, hypot, sin

import numpy as np

from navigation.baselines.half_planes import HalfPlane, orca_plane, solve
from navigation.motion.planning_scene import Desired, PlanningScene
from navigation.parameters.planner import OrcaParameters


class Orca:
    """ORCA with full responsibility, within the speed limits of the body at its heading.

    The published method splits the avoidance between both agents and lets a disc move in any
    direction at once. Here obstacles do not give way, and four more half-planes are the speed
    limits at the present heading.
    """

    def __init__(self, parameters: OrcaParameters) -> None:
        self._parameters = parameters

    def desired(self, scene: PlanningScene) -> Desired:
        s = scene.predicted()
        box = self._box(s)
        desired, own = s.to_goal().tolist(), s.velocity().tolist()
        planes = [*box, *self._planes(s, (own[0], own[1]))]
        v_max = s.limits.max_speed
        velocity = np.array(solve(planes, len(box), (desired[0], desired[1]), v_max))
        return Desired.towards(velocity, s, s.radii(self._parameters.margin))

    def _planes(self, s: PlanningScene, own: tuple[float, float]) -> list[HalfPlane]:
        """Return the half-planes of the obstacles within reach, the nearest first."""
        p = self._parameters
        x, y, _ = s.pose.tolist()
        planes = []
        radii = s.radii(p.margin)
        for (ox, oy), (u, w), radius, static in zip(
            s.obstacles.position.tolist(),
            s.obstacles.velocity.tolist(),
            radii.tolist(),
            s.obstacles.static.tolist(),
            strict=True,
        ):
            horizon = p.static_horizon if static else p.horizon
            gap = hypot(ox - x, oy - y) - radius
            if gap > horizon * (hypot(u, w) + s.limits.max_speed):
                continue
            plane = orca_plane(
                (ox - x, oy - y),
                (own[0] - u, own[1] - w),
                own,
                radius=radius,
                horizon=horizon,
                footstep=s.limits.footstep,
                responsibility=p.responsibility,
            )
            planes.append((gap, plane))
        return [plane for _, plane in sorted(planes, key=lambda pair: pair[0])]

    def _box(self, s: PlanningScene) -> list[HalfPlane]:
        """Return the half-planes of the speed limits at the present heading."""
        limits = s.limits
        c, n = cos(float(s.pose[2])), sin(float(s.pose[2]))
        return [
            HalfPlane(c * limits.vx, n * limits.vx, -n, c),
            HalfPlane(-c * limits.vx_backward, -n * limits.vx_backward, n, -c),
            HalfPlane(-n * limits.vy, c * limits.vy, -c, -n),
            HalfPlane(n * limits.vy, -c * limits.vy, c, n),
        ]
