"""Polar coordinates of landmarks, as exact detections give them."""

from collections.abc import Sequence
from math import atan2, hypot

from navigation.angles import wrap


def range_bearing(pose: Sequence[float], landmark: tuple[float, float]) -> tuple[float, float]:
    """Range [m] and bearing in R [rad] of a landmark in W [m] from x, y, heading of R in W."""
    dx, dy = landmark[0] - pose[0], landmark[1] - pose[1]
    return hypot(dx, dy), wrap(atan2(dy, dx) - pose[2])
