"""How an obstacle may move: three Kalman filters that interact (Blom & Bar-Shalom).

An obstacle stands still, goes on, or has turned back. Every mode has a filter of
(x, y, vx, vy) and a probability. Before a prediction the modes mix as an obstacle may
change its mode: what turns back keeps its place and reverses its velocity. ON and BACK are
each other's reversal, so after one the other takes over without any switch. All tracks
are stacked: n obstacles, 3 modes.
"""

from math import exp
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navigation import mode_kernel
from navigation.belief_parameters import TrackingParameters
from navigation.mode_kernel import BACK, ON, STILL

Array = NDArray[np.float64]

__all__ = ["BACK", "ON", "STILL", "Modes"]

FLOOR = 1e-6
"""Least probability of a mode."""


class Modes(NamedTuple):
    """Filters of obstacles, one per mode; the first axis may be missing for one obstacle.

    Attributes:
        weights: probabilities of the modes (n, 3).
        states: x, y, vx, vy (n, 3, 4).
        covariances: (n, 3, 4, 4).
    """

    weights: Array
    states: Array
    covariances: Array

    @property
    def moving(self) -> float | Array:
        """Probability that the obstacle moves ()."""
        probability: Array = 1.0 - self.weights[..., STILL]
        return probability


def begun(z: Array, R: Array, moving: float, velocity_sigma: float) -> Modes:
    """One obstacle seen for the first time, or again where nothing explains it.

    Args:
        z: position (2,) [m].
        R: its covariance (2, 2) [m²].
        moving: probability that it moves.
        velocity_sigma: standard deviation of its velocity if it does [m/s].
    """
    states = np.zeros((3, 4))
    states[:, :2] = z
    covariances = np.zeros((3, 4, 4))
    covariances[:, :2, :2] = R
    covariances[ON:, 2, 2] = covariances[ON:, 3, 3] = velocity_sigma**2
    weights = np.array([1.0 - moving, moving - FLOOR, FLOOR])
    return Modes(weights, states, covariances)


def predict(modes: Modes, dt: float, p: TrackingParameters) -> Modes:
    """Let the modes interact, then move on for `dt` [s]."""
    # Turning back twice is going on.
    turns = 0.5 * (1.0 - exp(-2.0 * p.reversal_rate * dt))
    stops, starts = 1.0 - exp(-p.stop_rate * dt), 1.0 - exp(-p.start_rate * dt)
    stops = min(stops, 1.0 - FLOOR)  # else nothing goes back, and is divided by
    turns *= 1.0 - stops
    change = np.array(
        [
            [1.0 - starts, starts, 0.0],
            [stops, 1.0 - stops - turns, turns],
            [stops, turns, 1.0 - stops - turns],
        ]
    )
    mixed = Modes(*mode_kernel.interact(*modes, change, dt, p.velocity_sigma**2))
    mode_kernel.move_on(
        mixed.states, mixed.covariances, dt, p.acceleration_noise, p.static_diffusion
    )
    return mixed


def surprise(modes: Modes, z: Array, R: Array) -> Array:
    """Squared Mahalanobis distance of each obstacle's position to its nearest mode (n,).

    Args:
        modes: predicted.
        z: positions (n, 2) [m].
        R: their covariances (n, 2, 2) [m²].
    """
    return mode_kernel.surprise(modes.states, modes.covariances, z, R)


def costs(modes: Modes, z: Array, R: Array, gate: float) -> Array:
    """Minus twice the log likelihood of every position, infinite beyond the gate (n, m).

    Args:
        modes: predicted.
        z: positions (m, 2) [m].
        R: their covariances (m, 2, 2) [m²].
        gate: squared Mahalanobis distance above which no mode explains a position [1].
    """
    return mode_kernel.costs(*modes, z, R, gate)


def update(modes: Modes, z: Array, R: Array, limit: float) -> Modes:
    """Correct the filters, and weigh the modes by their likelihoods.

    Args:
        modes: predicted.
        z: positions (n, 2) [m].
        R: their covariances (n, 2, 2) [m²].
        limit: largest ratio of the modes' likelihoods, logarithm [1].
    """
    corrected = Modes(*(part.copy() for part in modes))
    mode_kernel.update(*corrected, z, R, limit, FLOOR)
    return corrected


def mean(modes: Modes) -> Array:
    """Mean (4,) of one obstacle, given that it moves."""
    return mode_kernel.mean(modes.weights, modes.states)


def moments(modes: Modes) -> tuple[Array, Array]:
    """Mean (4,) and covariance (4, 4) of one obstacle, given that it moves."""
    return mode_kernel.moments(*modes)
