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

from navigation import track_filter
from navigation.belief_parameters import TrackingParameters
from navigation.track_filter import Innovation

Array = NDArray[np.float64]

STILL, ON, BACK = range(3)
FLOOR = 1e-6
"""Least probability of a mode."""
# What a change from mode i to mode j does to (x, y, vx, vy).
_STOP, _KEEP, _TURN = (1.0, 1.0, 0.0, 0.0), (1.0, 1.0, 1.0, 1.0), (1.0, 1.0, -1.0, -1.0)
_CHANGE = np.array([[_STOP, _STOP, _STOP], [_STOP, _KEEP, _TURN], [_STOP, _TURN, _KEEP]])


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
    turns *= 1.0 - stops
    change = np.array(
        [
            [1.0 - starts, starts, 0.0],
            [stops, 1.0 - stops - turns, turns],
            [stops, turns, 1.0 - stops - turns],
        ]
    )
    joint = modes.weights[:, :, None] * change
    weights = joint.sum(axis=1)
    share = (joint / weights[:, None, :])[..., None]
    from_states = modes.states[:, :, None] * _CHANGE
    # It turned at any time since: on average half way, so that it now is where it was.
    forth = dt * modes.states[:, ON:, 2:]
    from_states[:, (ON, BACK), (BACK, ON), :2] += forth
    states = (share * from_states).sum(axis=1)
    spread = from_states - states[:, None]
    from_covariances = modes.covariances[:, :, None] * _CHANGE[..., None] * _CHANGE[..., None, :]
    from_covariances = from_covariances + spread[..., None] * spread[..., None, :]
    from_covariances[:, (ON, BACK), (BACK, ON), :2, :2] += (
        forth[..., None] * forth[..., None, :] / 3.0
    )
    for axis in (2, 3):
        from_covariances[:, STILL, ON, axis, axis] += p.velocity_sigma**2
    covariances = (share[..., None] * from_covariances).sum(axis=1)
    covariances[:, STILL, :2, :2] += p.static_diffusion * dt * np.eye(2)
    n = len(weights)
    moved, grown = track_filter.predict_moving(
        states[:, ON:].reshape(2 * n, 4),
        covariances[:, ON:].reshape(2 * n, 4, 4),
        dt,
        p.acceleration_noise,
    )
    states[:, ON:] = moved.reshape(n, 2, 4)
    covariances[:, ON:] = grown.reshape(n, 2, 4, 4)
    return Modes(weights, states, covariances)


def innovation(modes: Modes, z: Array, R: Array) -> Innovation:
    """Innovations of every mode, fields (n, 3, ...), for positions z (n, 2) or (1, 2)."""
    return track_filter.innovation(
        modes.states[..., :2], modes.covariances[..., :2, :2], z[:, None], R[:, None]
    )


def update(modes: Modes, R: Array, seen: Innovation, limit: float) -> Modes:
    """Correct the filters, and weigh the modes by their likelihoods.

    Args:
        modes: predicted.
        R: covariances of the positions measured (n, 2, 2) [m²].
        seen: their innovations with the same `R`.
        limit: largest ratio of the modes' likelihoods, logarithm [1].
    """
    n = len(modes.weights)
    states, covariances = track_filter.update(
        modes.states.reshape(3 * n, 4),
        modes.covariances.reshape(3 * n, 4, 4),
        np.repeat(R, 3, axis=0),
        Innovation(
            seen.residual.reshape(3 * n, 2),
            seen.inverse.reshape(3 * n, 2, 2),
            seen.distance.reshape(3 * n),
            seen.log_det.reshape(3 * n),
        ),
    )
    gain = seen.log_likelihood - seen.log_likelihood.max(axis=1, keepdims=True)
    weights = modes.weights * np.exp(np.maximum(gain, -limit))
    weights = np.maximum(weights / weights.sum(axis=1, keepdims=True), FLOOR)
    return Modes(
        weights / weights.sum(axis=1, keepdims=True),
        states.reshape(n, 3, 4),
        covariances.reshape(n, 3, 4, 4),
    )


def mean(modes: Modes) -> Array:
    """Mean (4,) of one obstacle, given that it moves."""
    on, back = modes.weights[ON:].tolist()
    mixed: Array = (on * modes.states[ON] + back * modes.states[BACK]) / (on + back)
    return mixed


def moments(modes: Modes) -> tuple[Array, Array]:
    """Mean (4,) and covariance (4, 4) of one obstacle, given that it moves."""
    on, back = modes.weights[ON:].tolist()
    on, back = on / (on + back), back / (on + back)
    mean: Array = on * modes.states[ON] + back * modes.states[BACK]
    apart = modes.states[ON] - modes.states[BACK]
    covariance: Array = on * modes.covariances[ON] + back * modes.covariances[BACK]
    covariance += (on * back) * (apart[:, None] * apart)
    return mean, covariance
