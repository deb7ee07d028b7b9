"""Compiled part of the segmentation of merged blobs: pieces of an outline between its steps.

An envelope is the slope of an outline in each column of a grid of azimuth, from right to left.
"""

from math import floor, inf

import numpy as np
from numpy.typing import NDArray

from compilation import compiled

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Ints = NDArray[np.int64]

MIN_COLUMNS = 3  # of a piece of an outline
MIN_INNER = 2  # of them without the columns at its steps
NEAR_QUANTILE = 0.1  # of the distances of the points, for the nearest [1]

RIGHT, LEFT, RIGHT_TRUE, LEFT_TRUE, RUN, POINTS = range(6)  # columns of a table of pieces


@compiled
def quantile(ranked: Array, fraction: float) -> float:
    """Return a quantile of sorted values (n,), with linear interpolation."""
    position = fraction * (len(ranked) - 1)
    whole = floor(position)
    part = position - whole
    low, high = float(ranked[int(whole)]), float(ranked[min(int(whole) + 1, len(ranked) - 1)])
    gap = high - low
    return low + part * gap if part < 0.5 else high - (1.0 - part) * gap


@compiled
def borders(envelope: Array, min_step: float) -> Ints:
    """Return the first columns of the pieces of an envelope (n,), and n.

    Pieces of too few columns are merged with the neighbour across the smaller step.

    Args:
        envelope: (n,) [1].
        min_step: [1].
    """
    n = len(envelope)
    columns = np.empty(n + 1, np.int64)
    columns[0] = 0
    count = 1
    for i in range(1, n):
        if abs(envelope[i] - envelope[i - 1]) > min_step:
            columns[count] = i
            count += 1
    columns[count] = n
    while count > 1:
        narrow = 0
        for k in range(1, count):
            if columns[k + 1] - columns[k] < columns[narrow + 1] - columns[narrow]:
                narrow = k
        a, b = columns[narrow], columns[narrow + 1]
        if b - a >= MIN_COLUMNS:
            break
        before = abs(envelope[a] - envelope[a - 1]) if narrow > 0 else inf
        after = abs(envelope[b] - envelope[b - 1]) if b < n else inf
        for k in range(narrow if before <= after else narrow + 1, count):
            columns[k] = columns[k + 1]
        count -= 1
    return columns[: count + 1]


@compiled
def _ends(
    envelope: Array, usable: Bools, last: int, beyond: int, nearest: bool, outer: bool
) -> bool:
    """Return whether an object ends between its column `last` and the column `beyond`."""
    if beyond < 0 or beyond >= len(envelope):
        return outer
    if not (usable[last] and usable[beyond]):
        return False
    # Slopes are negative: a farther rim has the larger one.
    return bool((envelope[beyond] > envelope[last]) == nearest)


@compiled
def pieces(
    envelope: Array,
    usable: Bools,
    start: float,
    width: float,
    min_step: float,
    drop: float,
    nearest: bool,
    outer_right: bool,
    outer_left: bool,
) -> tuple[Array, Array, Array]:
    """Return the pieces of the lower or the upper outline.

    Args:
        envelope: (n,) [1].
        usable: columns where the outline is an edge of an object (n,).
        start: azimuth of the right border of the first column [rad].
        width: of a column [rad].
        min_step: minimum step between two pieces [1].
        drop: height of the rim minus that of the camera [m].
        nearest: whether the outline is of the nearest object of each column, else the farthest.
        outer_right: whether the right end of the outline is a side of an object.
        outer_left: whether the left end of the outline is a side of an object.

    Returns:
        Right and left azimuth of each piece [rad], whether these are sides of the object,
        horizontal distance of its nearest or farthest point [m] and number of its points
        (k, 6); azimuth and slope of the points of all pieces, concatenated (m,) [rad, 1].
    """
    n = len(envelope)
    edges = borders(envelope, min_step)
    table = np.empty((len(edges) - 1, 6))
    azimuth, slope, runs = np.empty(n), np.empty(n), np.empty(n)
    count = m = 0
    for p in range(len(edges) - 1):
        a, b = edges[p], edges[p + 1]
        count_usable = inner = 0
        for i in range(a, b):
            if usable[i]:
                count_usable += 1
                inner += (i > a or a == 0) and (i < b - 1 or b == n)
        if count_usable < MIN_COLUMNS or 2 * count_usable < b - a:
            continue
        first, ahead = m, True
        for i in range(a, b):
            # A column at a step also shows part of the neighbouring object.
            within = (i > a or a == 0) and (i < b - 1 or b == n)
            if not usable[i] or (inner >= MIN_INNER and not within):
                continue
            ahead = ahead and envelope[i] * drop > 0.0
            azimuth[m], slope[m] = start + width * (i + 0.5), envelope[i]
            m += 1
        if not ahead:
            m = first
            continue
        for i in range(first, m):
            runs[i] = drop / slope[i]
        table[count, RIGHT], table[count, LEFT] = start + a * width, start + b * width
        table[count, RIGHT_TRUE] = _ends(envelope, usable, a, a - 1, nearest, outer_right)
        table[count, LEFT_TRUE] = _ends(envelope, usable, b - 1, b, nearest, outer_left)
        fraction = NEAR_QUANTILE if nearest else 1.0 - NEAR_QUANTILE
        table[count, RUN] = quantile(np.sort(runs[first:m]), fraction)
        table[count, POINTS] = m - first
        count += 1
    return table[:count], azimuth[:m], slope[:m]
