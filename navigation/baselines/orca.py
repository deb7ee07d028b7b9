"""Optimal reciprocal collision avoidance against obstacles that never give way."""

from math import cos, hypot, sin

import numpy as np
from numpy.typing import NDArray

from navigation.baselines.half_planes import HalfPlane, orca_plane, solve
from navigation.baselines.planning_scene import PlanningScene
from navigation.parameters.planner import OrcaParameters

Array = NDArray[np.float64]


class Orca:
    """ORCA with full responsibility, in the box of velocities the body can walk with.

    The published method shares the avoidance with the other side and lets a disc move in
    any direction at once. Here nobody else gives way, and the velocity is sought among
    those the body has with its present heading, from where it will be in a footstep.
    """

    def __init__(self, parameters: OrcaParameters, s_robot: float) -> None:
        """Keep the horizons; `s_robot` is the robot's radius [m]."""
        self.margin = parameters.margin
        self._parameters = parameters
        self._s_robot = s_robot

    def decide(self, scene: PlanningScene) -> Array:
        """Body velocity of the linear program (3,) [m/s, m/s, rad/s]."""
        s = scene.in_effect()
        box = self._box(s)
        wanted, own = s.wanted().tolist(), s.velocity().tolist()
        planes = [*box, *self._planes(s, (own[0], own[1]))]
        v_max = s.envelope.limits.max_speed
        return s.walk(np.array(solve(planes, len(box), (wanted[0], wanted[1]), v_max)))

    def _planes(self, s: PlanningScene, own: tuple[float, float]) -> list[HalfPlane]:
        """Half planes of the obstacles near enough to matter, the nearest first."""
        p = self._parameters
        x, y, _ = s.pose.tolist()
        found = []
        radii = self._s_robot + s.radii(self.margin)
        for (ox, oy), (u, w), radius, static in zip(
            s.obstacles.position.tolist(),
            s.obstacles.velocity.tolist(),
            radii.tolist(),
            s.obstacles.static.tolist(),
            strict=True,
        ):
            horizon = p.static_horizon if static else p.horizon
            gap = hypot(ox - x, oy - y) - radius
            if gap > horizon * (hypot(u, w) + s.envelope.limits.max_speed):
                continue
            plane = orca_plane(
                (ox - x, oy - y),
                (own[0] - u, own[1] - w),
                own,
                radius=radius,
                horizon=horizon,
                footstep=s.envelope.limits.footstep,
                responsibility=p.responsibility,
            )
            found.append((gap, plane))
        return [plane for _, plane in sorted(found, key=lambda pair: pair[0])]

    def _box(self, s: PlanningScene) -> list[HalfPlane]:
        """The envelope of the body at its heading."""
        limits = s.envelope.limits
        c, n = cos(float(s.pose[2])), sin(float(s.pose[2]))
        return [
            HalfPlane(c * limits.vx, n * limits.vx, -n, c),
            HalfPlane(-c * limits.vx_backward, -n * limits.vx_backward, n, -c),
            HalfPlane(-n * limits.vy, c * limits.vy, -c, -n),
            HalfPlane(n * limits.vy, -c * limits.vy, c, n),
        ]
