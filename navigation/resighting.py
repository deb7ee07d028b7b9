"""A mover found again: did it go on, turn back while nobody looked, or do something else?

A shuttle that reversed at an unknown time is anywhere on its old line between where it
would be had it turned at once and where it would be had it not turned at all. The three
explanations are weighed by their likelihoods.
"""

from math import erf, exp, pi, sqrt

import numpy as np
from numpy.typing import NDArray

from navigation.belief_parameters import TrackingParameters

Array = NDArray[np.float64]

OTHERWISE = 0.02
"""Prior probability that a mover neither went on nor turned back on its line."""


def found_again(z: Array, R: Array, velocity: Array, sigma: float) -> tuple[Array, Array]:
    """State and covariance of an obstacle at `z` (2,) with a velocity known to `sigma` [m/s]."""
    covariance = np.zeros((4, 4))
    covariance[:2, :2] = R
    covariance[2, 2] = covariance[3, 3] = sigma**2
    return np.concatenate([z, velocity]), covariance


def resight_mover(
    state: Array,
    covariance: Array,
    last: tuple[Array, float],
    sighting: tuple[Array, Array],
    p: TrackingParameters,
) -> tuple[Array, Array]:
    """State of a mover before the update with the sighting that ends a gap.

    Args:
        state: predicted x, y, vx, vy (4,).
        covariance: its covariance (4, 4).
        last: where it was detected before the gap (2,) [m], and how long ago [s].
        sighting: where it is seen in W (2,) [m], and the covariance (2, 2) [m²].
        p: rates and spreads.

    Returns:
        State and covariance: the prediction, with a velocity uncertain by the chance of
        a reversal; or a new start at the sighting, reversed or with unknown velocity.
    """
    last_seen, gap = last
    z, R = sighting
    speed = float(np.hypot(state[2], state[3]))
    turned = 1.0 - exp(-p.reversal_rate * gap)
    S = covariance[:2, :2] + R
    y = z - state[:2]
    goes_on = (1.0 - turned) * exp(-0.5 * float(y @ np.linalg.solve(S, y)))
    goes_on /= 2.0 * pi * sqrt(float(np.linalg.det(S)))
    ahead = state[2:] / speed if speed > 1e-9 else np.array([1.0, 0.0])
    aside = np.array([-ahead[1], ahead[0]])
    gone = z - last_seen
    along, across = float(gone @ ahead), float(gone @ aside)
    blur = sqrt(2.0 * float(ahead @ R @ ahead))
    width = float(aside @ S @ aside)
    way = max(speed * gap, blur)
    on_line = erf((along + way) / (blur * sqrt(2.0))) - erf((along - way) / (blur * sqrt(2.0)))
    turns = turned * 0.5 * on_line / (2.0 * way)
    turns *= exp(-0.5 * across**2 / width) / sqrt(2.0 * pi * width)
    reach = p.line_width + way
    elsewhere = OTHERWISE / (pi * reach * reach)
    if speed > p.moving_speed and turns > max(goes_on, elsewhere):
        return found_again(z, R, -state[2:], p.reversal_sigma)
    if elsewhere > goes_on:
        return found_again(z, R, np.zeros(2), p.resighting_sigma)
    chance = turns / (turns + goes_on)
    widened = covariance.copy()
    widened[2:, 2:] += chance * (1.0 - chance) * 4.0 * np.outer(state[2:], state[2:])
    return state, widened
