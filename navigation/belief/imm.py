"""How an obstacle may move: three Kalman filters that interact (Blom & Bar-Shalom).

An obstacle stands still, goes on, or has turned back; what moves may walk a bend. Every mode
has a filter of (x, y, vx, vy, turn rate) and a probability. Before a prediction the modes mix
as an obstacle may change its mode: what turns back walks its path again, with its velocity and
turn rate reversed. ON and BACK are each other's reversal, so after one the other takes over
without any switch. All tracks are stacked: n obstacles, 3 modes.
"""

from collections.abc import Sequence
from math import exp, hypot
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navigation.belief import imm_kernel
from navigation.belief.imm_kernel import BACK, ON, SIZE, STILL, Mask, Rows
from navigation.parameters.belief import TrackingParameters

Array = NDArray[np.float64]

__all__ = ["BACK", "ON", "STILL", "Modes"]

FLOOR = 1e-6
"""Least probability of a mode."""


class Modes(NamedTuple):
    """Filters of obstacles, one per mode; the first axis may be missing for one obstacle.

    Attributes:
        weights: probabilities of the modes (n, 3).
        states: x, y, vx, vy, turn rate (n, 3, 5).
        covariances: (n, 3, 5, 5).
    """

    weights: Array
    states: Array
    covariances: Array

    @property
    def moving(self) -> float | Array:
        """Probability that the obstacle moves ()."""
        probability: Array = 1.0 - self.weights[..., STILL]
        return probability

    def at(self, rows: int | Mask) -> "Modes":
        """Filters of one obstacle, or of those for which a mask (n,) holds."""
        return Modes(self.weights[rows], self.states[rows], self.covariances[rows])

    def followed_by(self, others: "Sequence[Modes]") -> "Modes":
        """These filters of n obstacles, then those of single ones."""
        parts = zip(self, zip(*others, strict=True), strict=True)
        return Modes(*(np.concatenate([these, np.array(part)]) for these, part in parts))


def none() -> Modes:
    """Filters of no obstacle at all."""
    return Modes(np.zeros((0, 3)), np.zeros((0, 3, SIZE)), np.zeros((0, 3, SIZE, SIZE)))


def begun(z: Array, R: Array, moving: float, p: TrackingParameters) -> Modes:
    """One obstacle seen for the first time, or again where nothing explains it.

    Args:
        z: position (2,) [m].
        R: its covariance (2, 2) [m²].
        moving: probability that it moves.
        p: how it moves if it does.
    """
    states = np.zeros((3, SIZE))
    states[:, :2] = z
    covariances = np.zeros((3, SIZE, SIZE))
    covariances[:, :2, :2] = R
    covariances[ON:, 2, 2] = covariances[ON:, 3, 3] = p.velocity_sigma**2
    covariances[ON:, 4, 4] = p.turn_rate_sigma**2
    weights = np.array([1.0 - moving, moving - FLOOR, FLOOR])
    return Modes(weights, states, covariances)


def predict(modes: Modes, dt: float, p: TrackingParameters) -> Modes:
    """Let the modes interact, then move on for `dt` [s]."""
    # Turning back twice is going on.
    turns = 0.5 * (1.0 - exp(-2.0 * p.reversal_rate * dt))
    stops, starts = 1.0 - exp(-p.stop_rate * dt), 1.0 - exp(-p.start_rate * dt)
    stops = min(stops, 1.0 - FLOOR)  # else BACK has no probability left to divide by
    turns *= 1.0 - stops
    change = np.array(
        [
            [1.0 - starts, starts, 0.0],
            [stops, 1.0 - stops - turns, turns],
            [stops, turns, 1.0 - stops - turns],
        ]
    )
    turning = p.turn_rate_sigma**2
    mixed = Modes(*imm_kernel.interact(*modes, change, dt, p.velocity_sigma**2, turning))
    imm_kernel.move_on(
        mixed.states,
        mixed.covariances,
        dt,
        p.acceleration_noise,
        p.static_diffusion,
        exp(-dt / p.turn_rate_time),
        turning,
    )
    return mixed


def nis(modes: Modes, rows: Rows, z: Array, R: Array) -> Array:
    """Normalised innovation squared of some obstacles' positions by their nearest modes (m,).

    Args:
        modes: predicted.
        rows: which obstacles (m,).
        z: position of each (m, 2) [m].
        R: its covariance (m, 2, 2) [m²].
    """
    return imm_kernel.nis(modes.states, modes.covariances, rows, z, R)


def costs(modes: Modes, z: Array, R: Array, gate: float) -> Array:
    """Minus twice the log likelihood of every position, infinite beyond the gate (n, m).

    Args:
        modes: predicted.
        z: positions (m, 2) [m].
        R: their covariances (m, 2, 2) [m²].
        gate: squared Mahalanobis distance above which no mode explains a position [1].
    """
    return imm_kernel.costs(*modes, z, R, gate)


def update(modes: Modes, rows: Rows, z: Array, R: Array, limit: float) -> None:
    """Correct the filters of some obstacles, and weigh their modes by the likelihoods, in place.

    Args:
        modes: predicted, changed.
        rows: which obstacles (m,).
        z: position of each (m, 2) [m].
        R: its covariance (m, 2, 2) [m²].
        limit: largest ratio of the modes' likelihoods, logarithm [1].
    """
    imm_kernel.update(*modes, rows, z, R, limit, FLOOR)


def places(modes: Modes, standing: Mask) -> Array:
    """Where obstacles are (n, 2) [m]; `standing` says which of them stand still (n,)."""
    return imm_kernel.places(modes.weights, modes.states, standing)


def estimates(
    modes: Modes, standing: Mask, best: Array, p: TrackingParameters
) -> tuple[Array, Array, Array, list[float]]:
    """What is believed of obstacles.

    Args:
        modes: their filters.
        standing: which of them stand still (n,).
        best: covariance of the most precise detection of each (n, 2, 2) [m²].
        p: doubt about what stands.

    Returns:
        Positions (n, 2) [m], velocities (n, 2) [m/s], covariances of both (n, 4, 4) and turn
        rates (n,) [rad/s].
    """
    *moments, turn_rates = imm_kernel.estimates(
        *modes, standing, best, p.bias_fraction**2, p.static_velocity_sigma**2
    )
    return *moments, turn_rates.tolist()


def mean(modes: Modes) -> Array:
    """Mean (5,) of one obstacle, given that it moves."""
    return imm_kernel.mean(modes.weights, modes.states)


def speed(modes: Modes) -> float:
    """Speed of one obstacle, given that it moves [m/s]."""
    return hypot(*mean(modes)[2:4].tolist())


def moments(modes: Modes) -> tuple[Array, Array]:
    """Mean (5,) and covariance (5, 5) of one obstacle, given that it moves."""
    return imm_kernel.moments(*modes)
