"""Wrapping of angles into (-pi, pi], for a scalar and for arrays."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from compilation import compiled

TWO_PI = 2.0 * math.pi


@compiled
def wrap(a: float) -> float:
    """Wrap an angle into (-pi, pi], without a rounding error.

    Args:
        a: angle [rad].
    """
    turn = float(np.fmod(a, TWO_PI))
    if turn > math.pi:
        return turn - TWO_PI
    return turn + TWO_PI if turn <= -math.pi else turn


def wrap_array(a: ArrayLike) -> NDArray[np.float64]:
    """Wrap every angle of an array into (-pi, pi].

    Args:
        a: angles of any shape [rad].

    Returns:
        New array of the same shape [rad].
    """
    angles = np.asarray(a, dtype=np.float64)
    wrapped = math.pi - np.mod(math.pi - angles, TWO_PI)
    half_open: NDArray[np.float64] = np.where(wrapped <= -math.pi, math.pi, wrapped)
    return half_open
