"""Minimum-jerk motion from rest to rest (Flash & Hogan 1985)."""

PEAK = 1.875  # peak speed over mean speed [1]


def minimum_jerk(time: float) -> float:
    """Return the fraction of the distance at a fraction of the time [1]."""
    s = min(1.0, max(0.0, time))
    return s * s * s * (10.0 + s * (6.0 * s - 15.0))
