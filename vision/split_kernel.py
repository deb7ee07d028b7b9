"""Pieces of the outline of a blob between the steps in it, compiled.

An envelope is the slope of an outline in each column of a grid of azimuth, from right to left.
"""

from math import floor, inf

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Ints = NDArray[np.int64]

MIN_COLUMNS = 3  # a piece of an outline needs so many columns
MIN_INNER = 2  # of them must be left when those at its steps are not used
NEAR_SHARE = 0.1  # quantile of the points' distances taken for the nearest [1]

RIGHT, LEFT, RIGHT_TRUE, LEFT_TRUE, RUN, POINTS = range(6)  # columns of a table of pieces


@njit(cache=True)
def quantile(ranked: Array, share: float) -> float:
    """Value below which such a share of `ranked` (n,) lies, between two of them if need be."""
    place = share * (len(ranked) - 1)
    whole = floor(place)
    part = place - whole
    low, high = float(ranked[int(whole)]), float(ranked[min(int(whole) + 1, len(ranked) - 1)])
    gap = high - low
    return low + part * gap if part < 0.5 else high - (1.0 - part) * gap


@njit(cache=True)
def borders(envelope: Array, least: float) -> Ints:
    """First columns of the pieces of an envelope (n,), and n.

    Pieces of too few columns are joined to the neighbour across the smaller step.

    Args:
        envelope: (n,) [1].
        least: what is more than this is a step [1].
    """
    n = len(envelope)
    found = np.empty(n + 1, np.int64)
    found[0] = 0
    count = 1
    for i in range(1, n):
        if abs(envelope[i] - envelope[i - 1]) > least:
            found[count] = i
            count += 1
    found[count] = n
    while count > 1:
        narrow = 0
        for k in range(1, count):
            if found[k + 1] - found[k] < found[narrow + 1] - found[narrow]:
                narrow = k
        a, b = found[narrow], found[narrow + 1]
        if b - a >= MIN_COLUMNS:
            break
        before = abs(envelope[a] - envelope[a - 1]) if narrow > 0 else inf
        after = abs(envelope[b] - envelope[b - 1]) if b < n else inf
        for k in range(narrow if before <= after else narrow + 1, count):
            found[k] = found[k + 1]
        count -= 1
    return found[: count + 1]


@njit(cache=True)
def _ends(
    envelope: Array, usable: Bools, last: int, beyond: int, nearest: bool, outer: bool
) -> bool:
    """Whether a thing ends between its column `last` and the column `beyond`."""
    if beyond < 0 or beyond >= len(envelope):
        return outer
    if not (usable[last] and usable[beyond]):
        return False
    # Slopes are negative: a farther rim has the greater one.
    return bool((envelope[beyond] > envelope[last]) == nearest)


@njit(cache=True)
def pieces(
    envelope: Array,
    usable: Bools,
    start: float,
    width: float,
    least: float,
    drop: float,
    nearest: bool,
    outer_right: bool,
    outer_left: bool,
) -> tuple[Array, Array, Array]:
    """Pieces of the lower or the upper outline.

    Args:
        envelope: (n,) [1].
        usable: columns where the outline is the edge of a thing (n,).
        start: azimuth at which the first column begins [rad].
        width: of a column [rad].
        least: what is more than this parts two pieces [1].
        drop: height of the rim minus that of the camera [m].
        nearest: the outline shows the nearest thing of each column, not the farthest.
        outer_right: the right end of the outline is that of a thing.
        outer_left: its left end is.

    Returns:
        Right and left azimuth of each piece [rad], whether the thing ends there, horizontal
        distance of its nearest or farthest point [m] and number of its points (k, 6); azimuth
        and slope of the points of all pieces, one after the other (m,) [rad, 1].
    """
    n = len(envelope)
    edges = borders(envelope, least)
    table = np.empty((len(edges) - 1, 6))
    azimuth, slope, runs = np.empty(n), np.empty(n), np.empty(n)
    count = m = 0
    for p in range(len(edges) - 1):
        a, b = edges[p], edges[p + 1]
        chosen = inner = 0
        for i in range(a, b):
            if usable[i]:
                chosen += 1
                inner += (i > a or a == 0) and (i < b - 1 or b == n)
        if chosen < MIN_COLUMNS or 2 * chosen < b - a:
            continue
        first, ahead = m, True
        for i in range(a, b):
            # The column at a step shows part of what stands beside it.
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
        share = NEAR_SHARE if nearest else 1.0 - NEAR_SHARE
        table[count, RUN] = quantile(np.sort(runs[first:m]), share)
        table[count, POINTS] = m - first
        count += 1
    return table[:count], azimuth[:m], slope[:m]
