"""A mover in view that turns back: a running sum tells it before one look could.

One detection of a near, cut or distant mover is too coarse to show that it no longer goes
on. Page's cumulative sum of how far the detections lag behind the prediction is: it forgets
what is no worse than chance, adds up what is, and its last zero tells when it began.
"""

from math import sqrt

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

ALLOWANCE = 0.5
"""Lag per detection that is put down to chance [standard deviations]."""


def accumulated_lag(lag: float, residual: Array, S: Array, velocity: Array) -> float:
    """Page's sum after one more detection, zero or more.

    Args:
        lag: the sum before [standard deviations].
        residual: detection minus predicted position (2,) [m].
        S: covariance of the residual (2, 2) [m²].
        velocity: of the prediction, not zero (2,) [m/s].
    """
    u, w = float(velocity[0]), float(velocity[1])
    a, b = float(residual[0]), float(residual[1])
    xx, xy, yy = float(S[0, 0]), float(S[0, 1]), float(S[1, 1])
    spread = sqrt(u * u * xx + 2.0 * u * w * xy + w * w * yy)
    return max(0.0, lag - (u * a + w * b) / spread - ALLOWANCE)


def perhaps_turned(state: Array, covariance: Array, ago: float) -> Array:
    """Covariance (4, 4) of a mover that may have turned back some time ago.

    Going on and having turned, equally likely, differ by 2 v in velocity and 2 v `ago` in
    position: a spread of one rank, so that the next detections correct both together.

    Args:
        state: x, y, vx, vy as if it went on (4,).
        covariance: (4, 4).
        ago: when it would have turned [s].
    """
    way = np.concatenate([ago * state[2:], state[2:]])
    return covariance + np.outer(way, way)
