"""Motion of Yoo & Kim, section III: equations (7)-(11) in order, with the minimum of repairs.

The equations (1)-(4) are in `navigation.partial_evaluation`, (5) and (6) in
`navigation.gaze.integrated`, (7) in `navigation.scene`. The docstring of each function names its
repairs; docs/equations.md lists all.
"""

from math import atan2, cos, expm1, hypot, log, sin

import numpy as np
from numpy.typing import NDArray

from compilation.value import value
from navigation.angles import wrap_array
from navigation.decision import Situation, SpeedLimits, VirtualObstacle
from navigation.motion.avoid_obstacle import spiral_turn, turning_sign
from navigation.motion.collision_band import CollisionCase, Encounter, free_intervals
from navigation.motion.planning_scene import Desired, PlanningScene
from navigation.motion.univector import normalized, unit_vectors
from navigation.parameters.planner import PaperParameters

Array = NDArray[np.float64]

WEIGHTS = {"printed": (0.75, 0.25), "exchanged": (0.25, 0.75)}  # w_muf and w_auf of (10)
MIN_DISTANCE = 0.01  # from the centre of a virtual obstacle that still defines "outward" [m]
TOUCH = 1e-9  # speed beyond one that just touches [m/s]


def move_to_goal(points: Array, target: Array, heading: float, p: PaperParameters) -> Array:
    """Return the direction of u_muf at `points` (..., 2), eq. (8) (...) [rad].

    With k_alpha = 1 the heading of the robot cancels. Repair: the signs are plus, since minus leads
    away from the destination.
    """
    offset = target - points
    theta_rd = np.arctan2(offset[..., 1], offset[..., 0])
    theta_c = theta_rd + p.k_beta * wrap_array(heading - theta_rd)
    far = np.hypot(offset[..., 0], offset[..., 1]) > p.d_con
    direction: Array = np.where(far, theta_rd, theta_c)
    return direction


@value
class Discs:
    """Obstacles of (9), dynamic virtual ones included.

    Attributes:
        centres: positions (n, 2) [m].
        radii: S_oe or R_vo (n,) [m].
        outward: outward angle at the centre of a virtual obstacle (n,) [rad].
        virtual: whether each is virtual (n,).
    """

    centres: Array
    radii: Array
    outward: Array
    virtual: NDArray[np.bool_]


def avoid_obstacle(points: Array, target: Array, discs: Discs, p: PaperParameters) -> Array:
    """Return u_auf of every obstacle at `points` (..., 2), eq. (9) (..., n, 2).

    Repairs: theta_or points outward. Inside S_oe the field is outward instead of zero: as (11) caps
    R_vo "to maintain the effect", S_oe is at most the distance. The third condition does not hold
    for a virtual obstacle, which is always abeam of a mover ahead.
    """
    p_or, p_rd = points[..., None, :] - discs.centres, (target - points)[..., None, :]
    p_od = target - discs.centres
    rho_or, rho_rd = np.hypot(*np.moveaxis(p_or, -1, 0)), np.hypot(*np.moveaxis(p_rd, -1, 0))
    theta_or = np.arctan2(p_or[..., 1], p_or[..., 0])
    theta_or = np.where(discs.virtual & (rho_or < MIN_DISTANCE), discs.outward, theta_or)
    turn = spiral_turn(rho_or - discs.radii, discs.radii, p.d_e, p.k_r)
    phi = theta_or + turning_sign(p_od, p_or) * turn
    active = (
        (rho_or <= discs.radii + p.d_e + p.d_b)
        & (rho_rd + discs.radii >= np.hypot(p_od[..., 0], p_od[..., 1]))
        & (discs.virtual | (np.sum(p_or * p_rd, axis=-1) < 0.0))
    )
    u_auf: Array = unit_vectors(phi) * active[..., None]
    return u_auf


@value
class PaperField:
    """Vector field u_T of one decision, eq. (10).

    Attributes:
        target: destination (2,) [m].
        heading: arrival heading [rad].
        discs: obstacles and virtual obstacles.
        parameters: constants.
    """

    target: Array
    heading: float
    discs: Discs
    parameters: PaperParameters

    def at(self, points: Array) -> Array:
        """Return u_T at `points` (..., 2) in W [m]: (..., 2)."""
        p, points = self.parameters, np.asarray(points, dtype=np.float64)
        w_muf, w_auf = WEIGHTS[p.weights]
        u_muf = unit_vectors(move_to_goal(points, self.target, self.heading, p))
        u_auf = avoid_obstacle(points, self.target, self.discs, p)
        total: Array = w_muf * u_muf + w_auf * normalized(u_auf.sum(axis=-2))
        return total


def modified_speed(
    encounters: tuple[Encounter, ...],
    desired: float,
    now: float,
    limits: SpeedLimits,
    horizon: float,
) -> tuple[float, Situation]:
    """Return the speed on the same line that avoids all movers [m/s], and how.

    Keep the desired speed if it is free; else the lowest free one above that can be reached in
    time; else, outside of all collision bands, the highest free one below; else the path changes.
    Repair: to pass before a mover the robot must exceed v_c1, not v_c2.
    """
    if not any(e.collides(desired, horizon) for e in encounters):
        return desired, "free"
    intervals = free_intervals(encounters, limits.vx, horizon)
    in_band = any(e.in_band() and e.collides(desired, horizon) for e in encounters)
    above = [low for low, _ in intervals if low > desired]
    if above:
        time = min(horizon, *(e.touch_time(above[0]) for e in encounters))
        # a_i = 2 (|p_oc| - |v_r| t_c)/t_c², with |p_oc| = v_c t_c.
        needed = 2.0 * (above[0] - now) / max(time, limits.footstep)
        if needed <= limits.acceleration:
            return min(limits.vx, above[0] + TOUCH), "escape" if in_band else "accelerate"
    below = [high for _, high in intervals if high < desired]
    if below and not in_band:
        return max(0.0, below[-1] - TOUCH), "brake"
    return desired, "path_change"


def oval(h: float, xi: float) -> float:
    """Return (rho^(1-h) - 1)/(rho - 1), rho = ((1 - xi)/xi)², of eq. (11).

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


class PaperMethod:
    """Modified univector field with velocity modification and dynamic virtual obstacles.

    Args:
        parameters: constants; those of (7) are in `UnivectorParameters`.
    """

    def __init__(self, parameters: PaperParameters) -> None:
        self._parameters = parameters

    def desired(self, scene: PlanningScene) -> Desired:
        """Return the desired velocity: direction of (10), speed by velocity modification."""
        s, p = scene, self._parameters
        if s.task.aligning:
            return Desired(np.zeros(2), s.course, radii=s.s_oe)
        field = self.field(s, {})
        direction = self._direction(field, s)
        encounters = self._encounters(s, direction)
        now = max(0.0, float(s.velocity() @ [cos(direction), sin(direction)]))
        speed, situation = modified_speed(
            tuple(encounters.values()), p.nominal * s.speed, now, s.limits, p.horizon
        )
        blocked = [
            index
            for index, e in encounters.items()
            if e.case(s.limits.vx, p.horizon) is CollisionCase.DEFINITE
            or (situation == "path_change" and e.in_band())
        ]
        virtual = {i: v for i in blocked if (v := self.virtual_obstacle(s, i)) is not None}
        if virtual:
            field = self.field(s, virtual)
            direction = self._direction(field, s)
        return Desired(
            speed * np.array([cos(direction), sin(direction)]),
            direction,
            situation,
            tuple(virtual.values()),
            s.s_oe,
            field,
        )

    def field(self, s: PlanningScene, virtual: dict[int, VirtualObstacle]) -> PaperField:
        """Return the field; a virtual obstacle replaces the mover of its index."""
        centres, radii = s.obstacles.position.copy(), s.s_oe.copy()
        outward, is_virtual = np.zeros(len(radii)), np.zeros(len(radii), np.bool_)
        for index, v in virtual.items():
            centres[index], radii[index], is_virtual[index] = v.position, v.radius, True
            outward[index] = self._outward(s, index)
        discs = Discs(centres, radii, outward, is_virtual)
        return PaperField(s.task.target, s.task.heading, discs, self._parameters)

    def virtual_obstacle(self, s: PlanningScene, index: int) -> VirtualObstacle | None:
        """Return the dynamic virtual obstacle of a mover, eq. (11); None if it has none.

        Repairs: |v_o| must not be zero, the projection must be ahead of the mover, and h < 1.
        """
        p, u = self._parameters, s.parameters.univector
        p_o, v_o = s.obstacles.position[index], s.obstacles.velocity[index]
        path = normalized(v_o)
        along = float((s.pose[:2] - p_o) @ path)
        v_ro = hypot(*(v_o - s.velocity()).tolist())
        length = p.omega_dist * (u.eta_vo * v_ro + u.eta_imp * float(s.psi[index]))
        if not 0.0 < along < length:
            return None
        p_vo = p_o + along * path
        distance = hypot(*(p_vo - s.pose[:2]).tolist())
        radius = min(oval(along / length, p.xi) * float(s.s_oe[index]), distance)
        return VirtualObstacle(p_vo, radius, int(s.obstacles.ids[index]))

    def _outward(self, s: PlanningScene, index: int) -> float:
        """Return the direction out of the path of a mover for a robot on it: the goal's side."""
        vx, vy = s.obstacles.velocity[index].tolist()
        to_goal = float(move_to_goal(s.pose[:2], s.task.target, s.task.heading, self._parameters))
        left = vx * sin(to_goal) - vy * cos(to_goal) >= 0.0
        return atan2(vx, -vy) if left else atan2(-vx, vy)

    def _direction(self, field: PaperField, s: PlanningScene) -> float:
        """Return the direction of u_T at the robot [rad]; its weights differ, so it is not 0."""
        u_x, u_y = field.at(s.pose[:2]).tolist()
        return atan2(u_y, u_x)

    def _encounters(self, s: PlanningScene, direction: float) -> dict[int, Encounter]:
        """Return the movers in axes of the line of motion, by their index in the scene."""
        o = s.obstacles
        return {
            index: Encounter.on_line(
                direction, o.position[index] - s.pose[:2], o.velocity[index], float(s.s_oe[index])
            )
            for index in np.nonzero(o.speed >= self._parameters.min_speed)[0].tolist()
        }
