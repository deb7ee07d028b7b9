"""Which detection belongs to which track.

The cost of a pair is -2 log of its likelihood against that of a new obstacle; only negative
costs are paired (global nearest neighbour).
"""

import numpy as np
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
