"""Avoid-obstacle univector field: the hyperbolic spiral, Yoo & Kim, eq. (9)."""

from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from navigation.parameters.motion import UnivectorParameters

Array = NDArray[np.float64]

_AT_CENTRE = 0.01
"""Distance from a centre below which the outward direction is undefined [m]."""


def spiral_turn(gap: ArrayLike, s_oe: ArrayLike, d_e: ArrayLike, k_r: float) -> Array:
    """Return the angle from the outward direction to the spiral (Yoo & Kim, eq. (9)).

    Args:
        gap: rho_or - S_oe (...) [m], >= 0.
        s_oe: extended radius (...) [m].
        d_e: radius offset (...) [m].
        k_r: curvature [m].

    Returns:
        From 0 on the circle over pi/2 at S_oe + d_e towards pi at infinity (...) [rad].
    """
    gap_, s, e = np.asarray(gap, np.float64), np.asarray(s_oe), np.asarray(d_e)
    near = np.sqrt(np.maximum(gap_, 0.0) / e)
    far = 2.0 - (s + e + k_r) / (np.maximum(gap_, 0.0) + s + k_r)
    turn: Array = 0.5 * pi * np.where(gap_ < e, near, far)
    return turn


def turning_sign(p_od: Array, p_or: Array) -> Array:
    """Return the sign of the shorter side (Yoo & Kim, eq. (9)): +1, counter-clockwise, or -1.

    Args:
        p_od: vectors from obstacles to the destination (..., 2) [m].
        p_or: vectors from obstacles to the robot (..., 2) [m].

    Returns:
        (...).
    """
    cross = p_od[..., 0] * p_or[..., 1] - p_od[..., 1] * p_or[..., 0]
    return np.where(cross < 0.0, 1.0, -1.0)


def avoid_obstacle(
    position: Array,
    target: Array,
    centres: Array,
    s_oe: Array,
    parameters: UnivectorParameters,
    *,
    d_e: ArrayLike | None = None,
    outward: Array | None = None,
    abeam: bool = False,
    signs: Array | None = None,
) -> Array:
    """Return u_auf of every obstacle at every point (Yoo & Kim, eq. (9)).

    theta_or points outward, from the obstacle to the robot. Obstacles beyond the destination or
    behind the robot have no effect (second and third condition).

    Args:
        position: points in W (..., 2) [m].
        target: destination (2,) [m].
        centres: obstacles (n, 2) [m].
        s_oe: extended radii (n,) [m].
        parameters: d_e, d_b, k_r and the field inside the extended radius.
        d_e: radius offsets (n,) instead of that of `parameters` [m].
        outward: outward angle at a centre (n,) [rad].
        abeam: whether to waive the third condition. The centre of a dynamic virtual obstacle is
            the foot of a perpendicular: with a mover head-on it is exactly abeam, and the
            condition would always switch it off.
        signs: +1 counter-clockwise, -1 clockwise (n,); None for the shorter side.

    Returns:
        Unit vectors or zeros (..., n, 2).
    """
    p = parameters
    d_e = p.d_e if d_e is None else d_e
    p_or = np.asarray(position)[..., None, :] - centres
    p_rd = target - np.asarray(position)[..., None, :]
    p_od = target - centres
    rho = np.hypot(p_or[..., 0], p_or[..., 1])
    angle = np.arctan2(p_or[..., 1], p_or[..., 0])
    if outward is not None:
        angle = np.where(rho < _AT_CENTRE, outward, angle)
    gap = rho - s_oe
    sign = turning_sign(p_od, p_or) if signs is None else signs
    turn = sign * spiral_turn(gap, s_oe, d_e, p.k_r)
    before_target = np.hypot(p_rd[..., 0], p_rd[..., 1]) + s_oe >= np.hypot(
        p_od[..., 0], p_od[..., 1]
    )
    ahead = (np.sum(p_or * p_rd, axis=-1) < 0.0) | abeam
    active = (gap >= 0.0) & (gap <= np.asarray(d_e) + p.d_b) & before_target & ahead
    if p.inside == "outward":
        turn = np.where(gap < 0.0, 0.0, turn)
        active |= gap < 0.0
    direction = angle + turn
    field: Array = np.stack([np.cos(direction), np.sin(direction)], axis=-1) * active[..., None]
    return field
