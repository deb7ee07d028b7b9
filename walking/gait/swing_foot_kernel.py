"""References of both feet in the plan frame, on the floor or on their way, compiled.

A row for the left and one for the right foot: x, y [m], yaw [rad], height above the floor [m];
the rates of the first three; their accelerations (2, 10).
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Vector = tuple[float, float, float]

HEIGHT, RATE, ACCELERATION, WIDTH = 3, 4, 7, 10  # columns after x, y, yaw; and how many there are


@njit(cache=True)
def advance(
    feet: Array,
    decay: float,
    swing: int,
    landing: Vector,
    ticks_left: int,
    lift: tuple[float, float],
    period: float,
) -> None:
    """Move the feet one tick.

    Args:
        feet: references, brought up to date (2, 10).
        decay: per tick, of the height at which a foot was stopped [1].
        swing: index of the foot that swings, -1 for none.
        landing: where it is about to land, x, y [m], yaw [rad].
        ticks_left: until it lands [1].
        lift: height at mid-swing [m], and progress of the swing after this tick [1].
        period: of control [s].
    """
    feet[0, HEIGHT] *= decay
    feet[1, HEIGHT] *= decay
    if swing < 0:
        return
    for axis in range(3):
        _towards(feet[swing], axis, landing[axis], ticks_left, period)
    feet[swing, HEIGHT] = lift[0] * lift_profile(lift[1])


@njit(cache=True)
def lift_profile(phase: float) -> float:
    """Height of the swing foot as a share of the lift, at rest at both ends [1]."""
    bump = 4.0 * phase * (1.0 - phase)
    return bump * bump * bump


@njit(cache=True)
def _towards(foot: Array, axis: int, target: float, ticks_left: int, period: float) -> None:
    """Move one coordinate to a target with rest at arrival, replanned every tick.

    Flash & Hogan, J. Neurosci. 1985: the quintic from the present position, velocity and
    acceleration; following it for one tick and replanning is the same motion while the
    target stays.
    """
    if ticks_left <= 1:
        foot[axis], foot[RATE + axis], foot[ACCELERATION + axis] = target, 0.0, 0.0
        return
    time = ticks_left * period
    e = target - foot[axis]
    v, a = foot[RATE + axis] * time, foot[ACCELERATION + axis] * time * time
    c3 = 10.0 * e - 6.0 * v - 1.5 * a
    c4 = -15.0 * e + 8.0 * v + 1.5 * a
    c5 = 6.0 * e - 3.0 * v - 0.5 * a
    s = 1.0 / ticks_left
    foot[axis] += s * (v + s * (0.5 * a + s * (c3 + s * (c4 + s * c5))))
    foot[RATE + axis] = (v + s * (a + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)))) / time
    foot[ACCELERATION + axis] = (a + s * (6.0 * c3 + s * (12.0 * c4 + s * 20.0 * c5))) / (
        time * time
    )
