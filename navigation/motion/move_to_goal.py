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
    target: Array,
    target_heading: float,
    parameters: UnivectorParameters,
    *,
    side: int = 0,
) -> Array:
    """Return the direction phi_m of the move-to-goal field (Yoo & Kim, eq. (8)).

    Within d_con the field bends towards the arrival heading, the more the nearer; the printed
    field bends at once at d_con, where it chatters.

    Args:
        position: position of the robot in W (..., 2) [m].
        target: destination (2,) [m].
        target_heading: arrival heading [rad].
        parameters: gains and d_con.
        side: remembered sign of beta for |beta| near pi, 0 for none.

    Returns:
        (...) [rad], wrapped.
    """
    p = parameters
    offset = np.asarray(target) - np.asarray(position, dtype=np.float64)
    bearing: Array = np.arctan2(offset[..., 1], offset[..., 0])
    distance: Array = np.hypot(offset[..., 0], offset[..., 1])
    beta = wrap_array(target_heading - bearing)
    if side:
        turned = (np.abs(beta) > p.side_clear) & (np.sign(beta) != side)
        beta = np.where(turned, beta + side * 2.0 * pi, beta)
    ramp = np.clip((p.d_con - distance) / (p.arrival_ramp * p.d_con), 0.0, 1.0)
    bend = np.clip(p.k_beta * beta * ramp, -p.arrival_clamp, p.arrival_clamp)
    return wrap_array(bearing + bend)


def arrival_side(position: Array, task: Task, side: int, parameters: UnivectorParameters) -> int:
    """Return the sign of beta that an arrival from beyond the destination keeps, 0 for none.

    At |beta| = pi both sides are equal and noise would make the field chatter.

    Args:
        position: position of the robot in W (2,) [m].
        task: task of the mission.
        side: present side; 0 at the start of a leg.
        parameters: hysteresis.
    """
    dx, dy = (task.target - position).tolist()
    beta = wrap(task.heading - atan2(dy, dx))
    if abs(beta) < parameters.side_clear:
        return 0
    if side == 0 and abs(beta) > parameters.side_set:
        return 1 if beta > 0.0 else -1
    return side


def arrival_gain(distance: float, is_goal: bool, parameters: UnivectorParameters) -> float:
    """Return k_rho of eq. (8), the scale of the speed: 1 at via points, less near the goal."""
    if not is_goal:
        return 1.0
    slow = parameters.slow_fraction
    return min(1.0, slow + (1.0 - slow) * distance / parameters.slow_distance)
