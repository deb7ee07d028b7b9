"""Swing of a foot: where its reference rests, how long its way takes, how fast a landing moves."""

from math import ceil, hypot

import numpy as np
from numpy.typing import NDArray

from walking.foothold import Foothold
from walking.gait.minimum_jerk import PEAK
from walking.gait.swing_foot_kernel import HEIGHT, RATE, WIDTH
from walking.parameters import CONTROL_PERIOD

Array = NDArray[np.float64]

ROUNDING = 1e-7  # of a landing that another one is one move away from, of the move [1]


def resting(stance: tuple[Foothold, Foothold]) -> Array:
    """References of two feet on the floor, see `walking.gait.swing_foot_kernel` (2, 10)."""
    feet = np.zeros((2, WIDTH))
    for foot, foothold in zip(feet, stance, strict=True):
        stand(foot, foothold)
    return feet


def stand(foot: Array, foothold: Foothold) -> None:
    """Have a reference (10,) rest on a foothold, at the height it has."""
    foot[:HEIGHT] = foothold.x, foothold.y, foothold.yaw
    foot[RATE:] = 0.0


def least_ticks(foot: Array, landing: Foothold, speed: float) -> int:
    """Control ticks of a swing from rest to `landing` that peaks at `speed` [m/s].

    Args:
        foot: its reference (10,).
        landing: where it goes.
        speed: the peak.
    """
    x, y = foot[:2].tolist()
    way = hypot(landing.x - x, landing.y - y)
    return ceil(PEAK * way / (speed * CONTROL_PERIOD))


def moved(landing: Foothold, wanted: Foothold, most: float, turn: float) -> Foothold:
    """A landing moved towards another one.

    By no more than `most` along x and y [m], and by no more than `turn` [rad]; place and
    direction change together, so that the foot stays clear of the other one.
    """
    dx, dy, turned = wanted.x - landing.x, wanted.y - landing.y, wanted.yaw - landing.yaw
    largest = max(abs(dx) / most, abs(dy) / most, abs(turned) / turn)
    if largest <= 1.0 + ROUNDING:
        return wanted
    share = 1.0 / largest
    return Foothold(
        left=wanted.left,
        x=landing.x + share * dx,
        y=landing.y + share * dy,
        yaw=landing.yaw + share * turned,
    )
