"""How sure a share that was counted is."""

from math import sqrt

Z = 1.959963984540054  # of a two-sided interval of 95 %


def wilson(successes: int, n: int) -> tuple[float, float]:
    """95 % score interval of a share (Wilson 1927).

    Args:
        successes: counted, from 0 to n.
        n: of so many.

    Returns:
        Its lower and upper end, within 0 and 1.
    """
    if n == 0:
        return 0.0, 1.0
    p, z2 = successes / n, Z * Z
    centre = (p + z2 / (2 * n)) / (1 + z2 / n)
    half = Z * sqrt(p * (1 - p) / n + z2 / (4 * n * n)) / (1 + z2 / n)
    return (centre - half if successes else 0.0), (centre + half if successes < n else 1.0)
