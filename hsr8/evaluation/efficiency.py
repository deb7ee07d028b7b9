"""Success weighted by the ratio of the shortest to the actual path length or time."""


def spl(success: bool, shortest: float, actual: float) -> float:
    """Return success weighted by the path length (Anderson et al. 2018), from 0 to 1.

    With times in place of lengths it is success weighted by time (SPT).

    Args:
        success: whether the run succeeded.
        shortest: length of the shortest path, positive.
        actual: length of the path of the run, in the same unit.
    """
    return shortest / max(shortest, actual) if success else 0.0


def optimal_time_ratio(success: bool, shortest: float, actual: float) -> float:
    """Return success times shortest over actual time, without an upper bound.

    It is the metric of the BARN challenge without its clipping.

    Args:
        success: whether the run succeeded.
        shortest: shortest time [s].
        actual: time of the run, positive if it succeeded [s].
    """
    return shortest / actual if success else 0.0
