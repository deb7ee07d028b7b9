"""Data association: global nearest neighbour."""

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


def assign(costs: Array) -> tuple[Indices, Indices]:
    """Assign detections to tracks at minimum total cost; costs above 0 stay unassigned.

    Args:
        costs: of every pair, relative to leaving both unassigned (n, m); infinite outside the
            gate.

    Returns:
        Rows (k,) and columns (k,) of the pairs, by row.
    """
    gain = np.minimum(costs, 0.0)
    rows, columns = linear_sum_assignment(gain)
    assigned = gain[rows, columns] < 0.0
    return rows[assigned], columns[assigned]
