"""Covariance ellipses."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def axes(covariance: Array) -> tuple[Array, Array]:
    """Return the ellipses of one standard deviation.

    Args:
        covariance: (n, 2, 2) [m²].

    Returns:
        Half axes, the longer first (n, 2) [m], and the direction of the longer (n,) [rad].
    """
    xx, xy, yy = covariance[:, 0, 0], covariance[:, 0, 1], covariance[:, 1, 1]
    middle, half = 0.5 * (xx + yy), np.hypot(0.5 * (xx - yy), xy)
    direction: Array = 0.5 * np.arctan2(2.0 * xy, xx - yy)
    squares = np.stack([middle + half, middle - half], axis=1)
    return np.sqrt(np.maximum(squares, 0.0)), direction
