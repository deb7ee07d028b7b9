"""Dynamic virtual obstacle: an oval on the path of a mover, Yoo & Kim, eq. (11)."""

from math import expm1, hypot, log

import numpy as np
from numpy.typing import NDArray

from compilation.value import value
from navigation.parameters.motion import MovingObstacleParameters

Array = NDArray[np.float64]


def oval(h: float, xi: float) -> float:
    """Return the shape f = (rho^(1-h) - 1)/(rho - 1), rho = ((1 - xi)/xi)² (Yoo & Kim, eq. (11)).

    Args:
        h: |p_vo - p_o|/delta_dist, clipped to [0, 1].
        xi: convexity in (0, 1); at 1/2 the oval is a triangle.

    Returns:
        R_vo/S_oe: 1 at h = 0, xi at 1/2, 0 at 1.
    """
    h = min(1.0, max(0.0, h))
    rho = ((1.0 - xi) / xi) ** 2
    if abs(rho - 1.0) < 1e-4:
        return 1.0 - h
    return expm1((1.0 - h) * log(rho)) / (rho - 1.0)


@value
class PathPoint:
    """Projection of the robot onto the path of a mover.

    Attributes:
        ux, uy: unit vector of the mover's velocity.
        along: distance from the mover to the projection, along the velocity [m].
        lateral: lateral position of the robot, left of the path [m].
        x, y: p_vo in W [m].
    """

    ux: float
    uy: float
    along: float
    lateral: float
    x: float
    y: float

    def normal(self, side: int) -> tuple[float, float]:
        """Return n, from the path towards `side` (+1 left, -1 right)."""
        return -side * self.uy, side * self.ux

    def left_of_path(self, direction: tuple[float, float]) -> float:
        """Return the component of a `direction` in W across the path, left positive."""
        return self.ux * direction[1] - self.uy * direction[0]


def path_point(robot: Array, obstacle: Array, velocity: Array) -> PathPoint | None:
    """Return p_vo, the projection of the robot onto the path of the mover (Yoo & Kim, eq. (11)).

    Args:
        robot: position (2,) [m].
        obstacle: position (2,) [m].
        velocity: velocity of the obstacle over ground, not zero (2,) [m/s].

    Returns:
        None if the projection is behind the mover.
    """
    vx, vy = velocity.tolist()
    speed = hypot(vx, vy)
    ux, uy = vx / speed, vy / speed
    ox, oy = obstacle.tolist()
    rx, ry = robot.tolist()
    along = (rx - ox) * ux + (ry - oy) * uy
    if along <= 0.0:
        return None
    lateral = ux * (ry - oy) - uy * (rx - ox)
    return PathPoint(ux, uy, along, lateral, ox + along * ux, oy + along * uy)


def printed_path_length(
    relative_speed: float, psi: float, omega_dist: float, eta_vo: float, eta_imp: float
) -> float:
    """Return delta_dist = omega_dist (eta_vo |v_ro| + eta_imp (psi_sf + psi_ob)) (eq. (11)) [m]."""
    return omega_dist * (eta_vo * relative_speed + eta_imp * psi)


def printed_radius(projection: PathPoint, s_oe: float, length: float, xi: float) -> float | None:
    """Return R_vo = min(f S_oe, |p_vo - p_r|) (Yoo & Kim, eq. (11)) [m]; None beyond the length.

    On the path the radius is zero: the robot is on the circle, which still turns it away.
    """
    if projection.along >= length:
        return None
    return min(oval(projection.along / length, xi) * s_oe, abs(projection.lateral))


class VirtualSides:
    """Side on which the robot leaves the path of each mover, with hysteresis."""

    def __init__(self, parameters: MovingObstacleParameters) -> None:
        self._parameters = parameters
        self._sides: dict[int, int] = {}

    def update(self, track: int, projection: PathPoint, u_muf: tuple[float, float]) -> int:
        """Return the side (+1 left of the path, -1 right) for a mover with the robot in its band.

        Args:
            track: number of the mover.
            projection: robot and path.
            u_muf: move-to-goal direction, which decides near the path.
        """
        p = self._parameters
        side = self._sides.get(track)
        present = 1 if projection.lateral >= 0.0 else -1
        if side is None:
            goal_side = projection.left_of_path(u_muf)
            side = present
            if abs(projection.lateral) < p.side_switch and abs(goal_side) > p.side_aligned:
                side = 1 if goal_side > 0.0 else -1
        elif side != present and abs(projection.lateral) > p.side_hold:
            side = present
        self._sides[track] = side
        return side

    def keep(self, tracks: set[int]) -> None:
        """Forget every mover not in `tracks`."""
        self._sides = {t: s for t, s in self._sides.items() if t in tracks}
