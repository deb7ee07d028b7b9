"""Covariance inflation of measurements with time-correlated errors.

Consecutive camera frames share the error of the camera's pitch. For an error with
autocorrelation a = exp(-dt/tau) the variance of a mean decays (1 + a)/(1 - a) times slower
than for white noise; a filter whose measurement variances are inflated by this factor
remains consistent.
"""

from math import inf, tanh


def variance_inflation(dt: float, correlation_time: float) -> float:
    """Return the inflation (1 + a)/(1 - a) = coth(dt/(2 tau)) of a measurement's variance, >= 1.

    Args:
        dt: time since the previous measurement of the same object, > 0, may be infinite [s].
        correlation_time: tau [s].
    """
    if correlation_time <= 0.0 or dt == inf:
        return 1.0
    return 1.0 / tanh(0.5 * dt / correlation_time)
