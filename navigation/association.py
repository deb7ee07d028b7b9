"""Which detection belongs to which track: global nearest neighbour.

A pair costs what it says about the innovation, minus twice its log likelihood, against
the alternative that the detection is a new obstacle. The cheapest assignment of all
pairs together is taken, so two neighbours of one colour do not swap.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

Array = NDArray[np.float64]


def assign(costs: Array) -> list[tuple[int, int]]:
    """Pair rows with columns at least total cost, leaving out whatever costs more than 0.

    Args:
        costs: cost of every pair against leaving both alone (n, m); infinite forbids.

    Returns:
        (row, column) of the pairs, by row.
    """
    if costs.size == 0:
        return []
    gain = np.minimum(costs, 0.0)
    rows, columns = linear_sum_assignment(gain)
    return [
        (row, column)
        for row, column in zip(rows.tolist(), columns.tolist(), strict=True)
        if gain[row, column] < 0.0
    ]
