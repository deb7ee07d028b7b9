"""Interacting multiple model (IMM) filters of obstacles (Blom & Bar-Shalom).

An obstacle is static, moves with constant speed and turn rate, or has reversed. Every mode has
an extended Kalman filter of (x, y, vx, vy, turn rate) and a probability. Reversing negates
velocity and turn rate, so that the obstacle returns on its path. FORWARD and REVERSED are each
other's reversal; after a reversal the other mode takes over without a mode switch. All tracks
are stacked: n obstacles, 3 modes.
"""

from collections.abc import Sequence
from math import exp
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navigation.belief import imm_kernel
from navigation.belief.imm_kernel import FLOOR, FORWARD, SIZE, STATIC, Mask
from navigation.parameters.belief import TrackingParameters

Array = NDArray[np.float64]


class Modes(NamedTuple):
    """Filters of obstacles, one per mode; of a single obstacle without the first axis.

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
        probability: Array = 1.0 - self.weights[..., STATIC]
        return probability

    def at(self, rows: int | Mask) -> "Modes":
        """Return the filters of one obstacle, or of those selected by a mask (n,)."""
        return Modes(self.weights[rows], self.states[rows], self.covariances[rows])

    def append(self, others: "Sequence[Modes]") -> "Modes":
        """Return these filters of n obstacles followed by those of single ones."""
        parts = zip(self, zip(*others, strict=True), strict=True)
        return Modes(*(np.concatenate([these, np.array(part)]) for these, part in parts))


def empty() -> Modes:
    """Return the filters of zero obstacles."""
    return Modes(np.zeros((0, 3)), np.zeros((0, 3, SIZE)), np.zeros((0, 3, SIZE, SIZE)))


def initial(z: Array, R: Array, moving: float, p: TrackingParameters) -> Modes:
    """Return the filters of one obstacle after its first detection.

    Args:
        z: position (2,) [m].
        R: its covariance (2, 2) [m²].
        moving: probability that it moves.
        p: motion models.
    """
    states = np.zeros((3, SIZE))
    states[:, :2] = z
    covariances = np.zeros((3, SIZE, SIZE))
    covariances[:, :2, :2] = R
    covariances[FORWARD:, 2, 2] = covariances[FORWARD:, 3, 3] = p.velocity_sigma**2
    covariances[FORWARD:, 4, 4] = p.turn_rate_sigma**2
    weights = np.array([1.0 - moving, moving - FLOOR, FLOOR])
    return Modes(weights, states, covariances)


def predict(modes: Modes, dt: float, p: TrackingParameters) -> Modes:
    """Mix the modes, then predict every filter by `dt` [s]."""
    # An even number of reversals cancels.
    reversal = 0.5 * (1.0 - exp(-2.0 * p.reversal_rate * dt))
    stop, start = 1.0 - exp(-p.stop_rate * dt), 1.0 - exp(-p.start_rate * dt)
    stop = min(stop, 1.0 - FLOOR)  # REVERSED must keep a probability to divide by
    reversal *= 1.0 - stop
    transition = np.array(
        [
            [1.0 - start, start, 0.0],
            [stop, 1.0 - stop - reversal, reversal],
            [stop, reversal, 1.0 - stop - reversal],
        ]
    )
    turn_variance = p.turn_rate_sigma**2
    mixed = Modes(*imm_kernel.mix(*modes, transition, dt, p.velocity_sigma**2, turn_variance))
    imm_kernel.predict(
        mixed.states,
        mixed.covariances,
        dt,
        p.acceleration_noise,
        p.static_diffusion,
        exp(-dt / p.turn_rate_time),
        turn_variance,
    )
    return mixed
