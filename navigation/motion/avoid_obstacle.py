"""Hyperbolic spiral around an obstacle, Yoo & Kim, eq. (9)."""

from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


def spiral_turn(gap: ArrayLike, s_oe: ArrayLike, d_e: ArrayLike, k_r: float) -> Array:
    """Return the angle from the outward direction to the spiral (Yoo & Kim, eq. (9)).

    Args:
        gap: rho_or - S_oe (...) [m]; a negative one counts as 0.
        s_oe: extended radius (...) [m].
        d_e: radius offset (...) [m].
        k_r: curvature [m].

    Returns:
        From 0 on the circle over pi/2 at S_oe + d_e towards pi at infinity (...) [rad].
    """
    gap_, s, e = np.maximum(np.asarray(gap, np.float64), 0.0), np.asarray(s_oe), np.asarray(d_e)
    near = np.sqrt(gap_ / e)
    far = 2.0 - (s + e + k_r) / (gap_ + s + k_r)
    turn: Array = 0.5 * pi * np.where(gap_ < e, near, far)
    return turn


def turning_sign(direction: Array, p_or: Array) -> Array:
    """Return the sign of the shorter side (Yoo & Kim, eq. (9)): +1, counter-clockwise, or -1.

    Args:
        direction: vectors from obstacles to the destination, p_od in (9) (..., 2).
        p_or: vectors from obstacles to the robot (..., 2).

    Returns:
        (...).
    """
    cross = direction[..., 0] * p_or[..., 1] - direction[..., 1] * p_or[..., 0]
    return np.where(cross < 0.0, 1.0, -1.0)
