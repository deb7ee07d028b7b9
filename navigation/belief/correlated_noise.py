"""Honest weight of measurements whose errors repeat themselves.

Consecutive camera frames share the error of the camera's pitch, so ten frames are not
worth ten independent ones. For an error with autocorrelation a = exp(-dt/tau) the
variance of a mean shrinks (1 + a)/(1 - a) times slower than for white noise, and a
filter fed with variances larger by that factor states the right uncertainty.
"""

from math import inf, tanh


def variance_inflation(dt: float, correlation_time: float) -> float:
    """Factor (1 + a)/(1 - a) = coth(dt/(2 tau)) on the variance of a measurement.

    Args:
        dt: time since the previous measurement of the same thing, may be infinite [s].
        correlation_time: tau [s].

    Returns:
        At least 1; 1 for independent measurements.

    Raises:
        ValueError: if `dt` is not positive.
    """
    if dt <= 0.0:
        raise ValueError(f"measurements of one thing must be apart in time, not by {dt} s")
    if correlation_time <= 0.0 or dt == inf:
        return 1.0
    return 1.0 / tanh(0.5 * dt / correlation_time)
