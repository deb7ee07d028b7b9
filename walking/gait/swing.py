"""Foot references at rest, minimum swing time, and rate limit of the landing."""

from math import ceil

import numpy as np

from walking.arrays import Array
from walking.foothold import Foothold
from walking.gait.minimum_jerk import PEAK
from walking.gait.swing_foot_kernel import HEIGHT, RATE, WIDTH
from walking.parameters import CONTROL_PERIOD
from walking.planar import norm

ROUNDING = 1e-7  # rounding error, relative to the maximum change [1]


def resting(stance: tuple[Foothold, Foothold]) -> Array:
    """Return the references of two feet on the floor, see `swing_foot_kernel` (2, 10)."""
    feet = np.zeros((2, WIDTH))
    for foot, foothold in zip(feet, stance, strict=True):
        stand(foot, foothold)
    return feet


def stand(foot: Array, foothold: Foothold) -> None:
    """Set a foot reference (10,) to rest at a foothold, at its present height."""
    foot[:HEIGHT] = foothold.x, foothold.y, foothold.yaw
    foot[RATE:] = 0.0


def min_ticks(foot: Array, landing: Foothold, speed: float) -> int:
    """Return the control ticks of a swing to `landing` with a peak speed [m/s]."""
    x, y = foot[:2].tolist()
    distance = norm(landing.x - x, landing.y - y)
    return ceil(PEAK * distance / (speed * CONTROL_PERIOD))


def moved(landing: Foothold, wanted: Foothold, max_shift: float, max_turn: float) -> Foothold:
    """Move a landing towards another one by a limited change.

    Position and yaw change together, so that the foot stays clear of the other one.

    Args:
        landing: present.
        wanted: goal.
        max_shift: along x and along y [m].
        max_turn: of the yaw [rad].
    """
    dx, dy, turned = wanted.x - landing.x, wanted.y - landing.y, wanted.yaw - landing.yaw
    excess = max(abs(dx) / max_shift, abs(dy) / max_shift, abs(turned) / max_turn)
    return wanted if excess <= 1.0 + ROUNDING else landing.towards(wanted, 1.0 / excess)
