"""Univector field of the default planner, Yoo & Kim, eqs. (7)-(10), with weights by distance.

It differs from the printed field, which is in `navigation.paper`, in three respects: inside the
extended radius it points outward, where the printed one is zero; the nearness of the obstacles
replaces the weights of (10); and an obstacle fades out abeam of the robot, where the printed one is
switched off.
"""

from math import atan2, cos, hypot, sin

import numpy as np
from numpy.typing import ArrayLike, NDArray

from compilation.value import value
from navigation.motion.avoid_obstacle import spiral_turn, turning_sign
from navigation.motion.move_to_goal import move_to_goal
from navigation.motion.planning_scene import Desired, PlanningScene
from navigation.parameters.motion import UnivectorParameters

Array = NDArray[np.float64]

_ZERO = 1e-9


def normalized(v: Array) -> Array:
    """Return v/|v| over the last axis, zero where v is zero."""
    norm = np.hypot(v[..., 0], v[..., 1])[..., None]
    unit: Array = np.where(norm > _ZERO, v / np.maximum(norm, _ZERO), 0.0)
    return unit


def unit_vectors(angle: Array) -> Array:
    """Return the unit vectors (..., 2) of angles (...) [rad]."""
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def nearness(rho: Array, s_oe: Array, d_e: ArrayLike, d_b: float) -> Array:
    """Return the ramp of an obstacle: 1 up to S_oe + d_e/2, 0 from S_oe + d_e + d_b on (..., n)."""
    half = 0.5 * np.asarray(d_e)
    ramp: Array = np.clip(1.0 - (rho - s_oe - half) / (half + d_b), 0.0, 1.0)
    return ramp


def blended_sum(u_muf: Array, u_auf: Array, ramp: Array) -> Array:
    """Return the sum of both fields, weighted by the nearness of the nearest obstacle.

    Fixed weights limit the turn of the field from the direction of the destination to
    asin(w_auf/w_muf). This sum has no such limit and is continuous.

    Args:
        u_muf: unit vectors (..., 2).
        u_auf: unit vectors u_auf of n obstacles (..., n, 2).
        ramp: nearness of the obstacles (..., n).

    Returns:
        Vectors from u_muf, far from all obstacles, to the mean of u_auf, at an obstacle (..., 2).
    """
    avoid = normalized((ramp[..., None] ** 2 * u_auf).sum(axis=-2))
    w_auf = ramp.max(axis=-1, initial=0.0)[..., None]
    total: Array = (1.0 - w_auf) * u_muf + w_auf * avoid
    vanishing = np.hypot(total[..., 0], total[..., 1])[..., None] < _ZERO
    return np.where(vanishing, u_muf, total)


def shrunk_for_goal(
    s_oe: Array, s_physical: Array, goal_distance: Array, parameters: UnivectorParameters
) -> tuple[Array, Array]:
    """Shrink radii and offsets so that the destination is outside S_oe + d_e of all obstacles.

    Args:
        s_oe: extended radii (n,) [m].
        s_physical: radii at which the bodies touch (n,) [m].
        goal_distance: distance rho_od of the destination from the obstacles (n,) [m].
        parameters: radius offset and lower bounds.

    Returns:
        Radii (n,) and offsets (n,) [m].
    """
    p, d_e = parameters, parameters.d_e
    room = p.goal_fraction * np.maximum(p.min_goal_gap, goal_distance - s_physical)
    near = goal_distance < s_oe + d_e
    radius = np.where(near, np.minimum(s_oe, s_physical + room), s_oe)
    offset = np.where(
        near, np.minimum(d_e, np.maximum(p.min_goal_offset, goal_distance - radius)), d_e
    )
    return radius, offset


@value
class UnivectorField:
    """Vector field u_T of one decision.

    Attributes:
        centres: positions of n obstacles (n, 2) [m].
        radii: extended radii S_oe (n,) [m].
        offsets: radius offsets d_e (n,) [m].
        target: destination (2,) [m].
        heading: arrival heading [rad].
        side: remembered side of the arrival, see `move_to_goal`.
        parameters: constants of (8)-(10).
    """

    centres: Array
    radii: Array
    offsets: Array
    target: Array
    heading: float
    side: int
    parameters: UnivectorParameters

    @classmethod
    def of(cls, s: PlanningScene) -> "UnivectorField":
        """Return the field of a scene; radii leave the destination reachable."""
        p, target, centres = s.parameters.univector, s.task.target, s.obstacles.position
        p_od = target - centres
        distance = np.hypot(p_od[:, 0], p_od[:, 1])
        radii, offsets = shrunk_for_goal(s.s_oe, s.touching, distance, p)
        return cls(centres, radii, offsets, target, s.task.heading, s.side, p)

    def at(self, points: Array) -> Array:
        """Return u_T at `points` (..., 2) in W [m]: (..., 2)."""
        p, points = self.parameters, np.asarray(points, dtype=np.float64)
        phi = move_to_goal(points, self.target, self.heading, p, side=self.side)
        arrived = np.all(points == self.target, axis=-1)[..., None]
        u_muf = np.where(arrived, 0.0, unit_vectors(phi))
        p_or = points[..., None, :] - self.centres
        rho = np.hypot(p_or[..., 0], p_or[..., 1])
        sign = turning_sign(self.target - self.centres, p_or)
        turn = spiral_turn(rho - self.radii, self.radii, self.offsets, p.k_r)
        outward = np.arctan2(p_or[..., 1], p_or[..., 0])
        ramp = nearness(rho, self.radii, self.offsets, p.d_b) * self._relevance(points, p_or, rho)
        return blended_sum(u_muf, unit_vectors(outward + sign * turn), ramp)

    def _relevance(self, points: Array, p_or: Array, rho: Array) -> Array:
        """Return weights: 1 for obstacles ahead and before the destination, fading to 0 (..., n).

        The weights replace the second and third condition of (9). Inside the extended radius they
        rise to 1 in any direction.
        """
        p, p_rd = self.parameters, (self.target - points)[..., None, :]
        rho_rd = np.hypot(p_rd[..., 0], p_rd[..., 1])
        p_od = self.target - self.centres
        cosine = -np.sum(p_or * p_rd, axis=-1) / np.maximum(rho * rho_rd, _ZERO)
        beyond = np.hypot(p_od[..., 0], p_od[..., 1]) - self.radii - rho_rd
        ahead = np.clip(cosine / p.fade, 0.0, 1.0)
        before = np.clip(1.0 - beyond / self.offsets, 0.0, 1.0)
        inside: Array = np.clip((self.radii - rho) / p.inside, 0.0, 1.0)
        weight: Array = np.maximum(ahead * before, inside)
        return weight


class Univector:
    """Motion along the univector field at constant speed."""

    def desired(self, scene: PlanningScene) -> Desired:
        """Return the desired velocity one footstep ahead, when it takes effect."""
        s = scene.predicted()
        field = UnivectorField.of(s)
        u_x, u_y = field.at(s.pose[:2]).tolist()
        direction = s.course if hypot(u_x, u_y) < _ZERO else atan2(u_y, u_x)
        velocity = s.speed * np.array([cos(direction), sin(direction)])
        return Desired(velocity, direction, radii=s.s_oe, field=field)
