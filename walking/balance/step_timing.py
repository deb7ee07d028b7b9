"""Timing of the capture step."""

from math import exp, log


def capture_time(omega: float, time: float, off: float, ahead: float, reach: float) -> float:
    """Return the latest touchdown at which a landing within reach captures the body.

    A DCM `ahead` of the ZMP by plan, with error `off`, is `(ahead + off) e^{ωt}` from the ZMP
    after a time t, and planned at `ahead e^{ω time}`: linear in e^{ωt}, so the time at which the
    difference is `reach` has a closed form (Khadiv et al., IEEE Trans. Robot. 36(6), 2020).

    Args:
        omega: of the pendulum [1/s].
        time: planned touchdown, from now [s].
        off: DCM error [m].
        ahead: planned DCM minus ZMP [m].
        reach: shift of the landing, of the sign of `off` if it helps [m].

    Returns:
        the time, at most `time`; zero if no touchdown is early enough [s].
    """
    growth = exp(omega * time)
    if growth * abs(off) <= (reach if off > 0.0 else -reach) or off == 0.0:
        return time
    due, distance = reach + growth * ahead, off + ahead
    if due * distance <= 0.0:
        return 0.0
    return min(time, max(0.0, log(due / distance) / omega))
