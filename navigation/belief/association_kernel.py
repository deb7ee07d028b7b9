"""Compiled part of the data association: overlapping tracks."""

import numpy as np
from numpy.typing import NDArray

from compilation import compiled

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


@compiled
def overlapping(centres: Array, radii: Array) -> Indices:
    """Return the pairs i < j of overlapping discs (k, 2), by i, then j.

    Args:
        centres: (n, 2) [m].
        radii: (n,) [m].
    """
    n, count = len(radii), 0
    pairs = np.empty((n * (n - 1) // 2, 2), np.int64)
    for i in range(n):
        for j in range(i + 1, n):
            dx, dy = centres[i, 0] - centres[j, 0], centres[i, 1] - centres[j, 1]
            reach = radii[i] + radii[j]
            if dx * dx + dy * dy < reach * reach:
                pairs[count, 0], pairs[count, 1] = i, j
                count += 1
    return pairs[:count]
