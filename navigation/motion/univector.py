"""Extended radius and sum of the univector fields, Yoo & Kim, eqs. (7) and (10)."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from navigation.belief.tracks import Tracks
from navigation.parameters.motion import UnivectorParameters

Array = NDArray[np.float64]

_ZERO = 1e-9


def normalized(v: Array) -> Array:
    """Return v/|v| over the last axis, zero where v is zero."""
    norm = np.hypot(v[..., 0], v[..., 1])[..., None]
    unit: Array = np.where(norm > _ZERO, v / np.maximum(norm, _ZERO), 0.0)
    return unit


def weighted_sum(u_muf: Array, u_auf: Array, w_muf: float, w_auf: float) -> Array:
    """Return u_T = w_muf u_muf + w_auf N(sum u_auf) (Yoo & Kim, eq. (10)), as printed.

    Args:
        u_muf: unit vectors (..., 2).
        u_auf: unit vectors u_auf of n obstacles (..., n, 2).
        w_muf: weight of move-to-goal.
        w_auf: weight of avoid-obstacle.

    Returns:
        (..., 2); its norm is not a speed.
    """
    total: Array = w_muf * u_muf + w_auf * normalized(u_auf.sum(axis=-2))
    return total


def nearness(rho: Array, s_oe: Array, d_e: ArrayLike, d_b: float) -> Array:
    """Return the ramp of an obstacle: 1 up to S_oe + d_e/2, 0 from S_oe + d_e + d_b on (..., n)."""
    half = 0.5 * np.asarray(d_e)
    ramp: Array = np.clip(1.0 - (rho - s_oe - half) / (half + d_b), 0.0, 1.0)
    return ramp


def blended_sum(
    u_muf: Array,
    u_auf: Array,
    ramp: Array,
    u_virtual: Array,
    weight: Array,
    *,
    virtual_weight: float,
) -> Array:
    """Return the sum weighted by distance: 0 far from the nearest obstacle, 1 at the obstacle.

    Fixed weights limit the turn of the field from the direction of the destination to
    asin(w_auf/w_muf). This sum has no such limit and is continuous.

    Args:
        u_muf: unit vectors (..., 2).
        u_auf: unit vectors u_auf of n obstacles (..., n, 2).
        ramp: nearness of the obstacles (..., n).
        u_virtual: directions at m dynamic virtual obstacles (..., m, 2), or (m, 2) for all.
        weight: f of the virtual obstacles in [0, 1] (..., m), or (m,) for all.
        virtual_weight: weight of virtual obstacles relative to real ones.

    Returns:
        (..., 2).
    """
    active = ramp * (np.abs(u_auf).sum(axis=-1) > 0.0)
    avoid = (active[..., None] ** 2 * u_auf).sum(axis=-2)
    avoid = avoid + virtual_weight * (weight[..., None] ** 2 * u_virtual).sum(axis=-2)
    w_auf = np.maximum(active.max(axis=-1, initial=0.0), weight.max(axis=-1, initial=0.0))
    total: Array = (1.0 - w_auf)[..., None] * u_muf + w_auf[..., None] * normalized(avoid)
    vanishing = np.hypot(total[..., 0], total[..., 1])[..., None] < _ZERO
    return np.where(vanishing, u_muf, total)


def shrunk_for_goal(
    s_oe: Array, s_physical: Array, goal_distance: Array, parameters: UnivectorParameters
) -> tuple[Array, Array]:
    """Shrink radii and offsets so that the destination is outside S_oe + d_e of all obstacles.

    Args:
        s_oe: extended radii (n,) [m].
        s_physical: radii at which the bodies touch (n,) [m].
        goal_distance: rho_od (n,) [m].
        parameters: radius offset and lower bounds.

    Returns:
        Radii and offsets (n,), (n,) [m].
    """
    p, d_e = parameters, parameters.d_e
    room = p.goal_fraction * np.maximum(p.min_goal_gap, goal_distance - s_physical)
    near = goal_distance < s_oe + d_e
    radius = np.where(near, np.minimum(s_oe, s_physical + room), s_oe)
    offset = np.where(
        near, np.minimum(d_e, np.maximum(p.min_goal_offset, goal_distance - radius)), d_e
    )
    return radius, offset


def extended_radius(
    obstacles: Tracks, psi_sf: float, psi_ob: Array, parameters: UnivectorParameters
) -> Array:
    """Return S_oe = S_r + S_o + omega (eta_vo |v_o| + eta_imp (psi_sf + psi_ob)), eq. (7).

    |v_o| is the speed over ground: a speed relative to the walking robot would inflate every
    static obstacle and close the gaps.

    Args:
        obstacles: n obstacles.
        psi_sf: eq. (2).
        psi_ob: eq. (3) of each (n,).
        parameters: radii and gains.

    Returns:
        (n,) [m].
    """
    inflation = parameters.eta_vo * obstacles.speed + parameters.eta_imp * (psi_sf + psi_ob)
    s_phys = physical_radius(obstacles, parameters)
    return s_phys + parameters.margin + parameters.omega_soe * inflation


def physical_radius(obstacles: Tracks, parameters: UnivectorParameters) -> Array:
    """Return S_phys = S_robot + S_o, the distance at which the bodies touch (n,) [m]."""
    return parameters.s_robot + obstacles.radius
