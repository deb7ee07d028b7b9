"""When a footstep has to be down for its landing to be enough."""

from math import exp, log


def capture_time(omega: float, time: float, off: float, ahead: float, reach: float) -> float:
    """Time by which the swing foot has to carry, where its reach does not do until `time`.

    A DCM `ahead` of the ZMP by plan and `off` the plan is `(ahead + off) e^{ωt}` from the ZMP
    after a time t, and due at `ahead e^{ω time}`: linear in e^{ωt}, so the time at which the
    difference is `reach` is closed form (Khadiv et al., IEEE Trans. Robot. 36(6), 2020).

    Args:
        omega: of the pendulum [1/s].
        time: planned, from now [s].
        off: of the DCM from the plan [m].
        ahead: of the planned DCM from the ZMP [m].
        reach: by how much the landing moves; of the sign of `off` if it helps [m].

    Returns:
        the time [s], no longer than `time`; zero where none is short enough.
    """
    growth = exp(omega * time)
    if growth * abs(off) <= (reach if off > 0.0 else -reach) or off == 0.0:
        return time
    due, distance = reach + growth * ahead, off + ahead
    if due * distance <= 0.0:
        return 0.0
    return min(time, max(0.0, log(due / distance) / omega))
