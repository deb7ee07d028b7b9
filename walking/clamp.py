"""A bound on a value: the counterpart of the dead zone, which is what it takes off."""


def clamp(value: float, most: float) -> float:
    """A value kept within ±`most`.

    Where many are bounded in a control tick, the expression is written out: a call costs as much
    as all of it.
    """
    return min(most, max(-most, value))
