"""Move-to-goal univector field with an arrival heading, Yoo & Kim, eq. (8)."""

from math import atan2, pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from navigation.angles import wrap, wrap_array
from navigation.decision import Task
from navigation.parameters.motion import UnivectorParameters

Array = NDArray[np.float64]


def move_to_goal(
    position: ArrayLike,
    heading: ArrayLike,
    target: Array,
    target_heading: float,
    parameters: UnivectorParameters,
    *,
    side: int = 0,
) -> Array:
    """Return the direction phi_m of the move-to-goal field (Yoo & Kim, eq. (8)).

    The signs are plus and theta_c is counted from the robot's heading: the printed field leads
    away from the destination. Beyond d_con it points at the destination.

    Args:
        position: position of the robot in W (..., 2) [m].
        heading: heading of the robot (...) [rad]; has an effect for k_alpha != 1 only.
        target: destination (2,) [m].
        target_heading: arrival heading [rad].
        parameters: gains, d_con and the form of the arrival.
        side: remembered sign of beta for |beta| near pi, 0 for none.

    Returns:
        (...) [rad], wrapped.
    """
    offset = np.asarray(target) - np.asarray(position, dtype=np.float64)
    bearing: Array = np.arctan2(offset[..., 1], offset[..., 0])
    distance: Array = np.hypot(offset[..., 0], offset[..., 1])
    if parameters.arrival == "nposture":
        return wrap_array(bearing - _posture_turn(offset, bearing, target_heading, parameters))
    beta = wrap_array(target_heading - bearing)
    if side:
        beta = np.where(
            (np.abs(beta) > parameters.side_clear) & (np.sign(beta) != side),
            beta + side * 2.0 * pi,
            beta,
        )
    if parameters.arrival == "hard":
        alpha = wrap_array(bearing - np.asarray(heading))
        near = np.asarray(heading) + parameters.k_alpha * alpha + parameters.k_beta * beta
    else:
        ramp = (parameters.d_con - distance) / (parameters.arrival_ramp * parameters.d_con)
        turn = parameters.k_beta * beta * np.clip(ramp, 0.0, 1.0)
        near = bearing + np.clip(turn, -parameters.arrival_clamp, parameters.arrival_clamp)
    return wrap_array(np.where(distance > parameters.d_con, bearing, near))


def muf(position: ArrayLike, target: Array, phi: Array) -> Array:
    """Return u_muf of eq. (8) with k_rho = 1: unit vectors (..., 2), zero at the destination.

    k_rho scales the speed, see `arrival_gain`. The third component of the printed vector is a
    heading and is not part of the field.

    Args:
        position: position of the robot in W (..., 2) [m].
        target: destination (2,) [m].
        phi: result of `move_to_goal` (...) [rad].
    """
    arrived = np.all(np.asarray(position) == target, axis=-1)
    unit: Array = np.stack([np.cos(phi), np.sin(phi)], axis=-1)
    return np.where(arrived[..., None], 0.0, unit)


def _posture_turn(
    offset: Array, bearing: Array, target_heading: float, parameters: UnivectorParameters
) -> Array:
    """Return the turn of Kim's posture field away from a point beyond the destination [rad]."""
    p = parameters
    beyond = p.posture_offset * np.array([np.cos(target_heading), np.sin(target_heading)])
    ahead = offset + beyond
    return p.posture_gain * wrap_array(np.arctan2(ahead[..., 1], ahead[..., 0]) - bearing)


class ArrivalSide:
    """Hysteresis of the side of a ramped arrival from beyond the destination.

    At |beta| = pi both sides are equal and noise would make the field chatter. Every leg of a
    mission begins without a side.
    """

    def __init__(self, parameters: UnivectorParameters) -> None:
        self._parameters = parameters
        self._side = 0
        self._leg = -1

    def update(self, position: Array, task: Task) -> int:
        """Return the sign of beta at `position` (2,) [m] for `task`, 0 for no side."""
        p = self._parameters
        if p.arrival != "ramped":
            return 0
        if task.index != self._leg:
            self._leg, self._side = task.index, 0
        dx, dy = (task.target - position).tolist()
        beta = wrap(task.heading - atan2(dy, dx))
        if abs(beta) < p.side_clear:
            self._side = 0
        elif self._side == 0 and abs(beta) > p.side_set:
            self._side = 1 if beta > 0.0 else -1
        return self._side


def arrival_gain(distance: float, is_goal: bool, parameters: UnivectorParameters) -> float:
    """Return k_rho of eq. (8), the scale of the speed: 1 at via points, less near the goal."""
    if not is_goal:
        return 1.0
    slow = parameters.slow_fraction
    return min(1.0, slow + (1.0 - slow) * distance / parameters.slow_distance)
