"""Which detection belongs to which track, and which tracks are one: nearest neighbours.

A pair costs what it says about the innovation, minus twice its log likelihood, against
the alternative that the detection is a new obstacle. The cheapest assignment of all
pairs together is taken, so two neighbours of one colour do not swap.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


def assign(costs: Array) -> tuple[Indices, Indices]:
    """Pair rows with columns at least total cost, leaving out whatever costs more than 0.

    Args:
        costs: cost of every pair against leaving both alone (n, m); infinite forbids.

    Returns:
        Rows (k,) and columns (k,) of the pairs, by row.
    """
    gain = np.minimum(costs, 0.0)
    rows, columns = linear_sum_assignment(gain)
    worth = gain[rows, columns] < 0.0
    return rows[worth], columns[worth]


@njit(cache=True)
def overlapping(centres: Array, radii: Array) -> Indices:
    """Pairs i < j of discs that overlap (k, 2), by i, then j.

    Args:
        centres: (n, 2) [m].
        radii: (n,) [m].
    """
    n, count = len(radii), 0
    pairs = np.empty((n * (n - 1) // 2, 2), np.int64)
    for i in range(n):
        for j in range(i + 1, n):
            dx, dy = centres[i, 0] - centres[j, 0], centres[i, 1] - centres[j, 1]
            if dx * dx + dy * dy < (radii[i] + radii[j]) ** 2:
                pairs[count, 0], pairs[count, 1] = i, j
                count += 1
    return pairs[:count]
