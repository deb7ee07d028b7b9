"""Envelopes of merged blobs in azimuth and slope, and the pieces between their steps.

The lower outline of a merged blob belongs to the nearest cylinder of each direction, the upper
outline to the farthest. The outline has a step where a cylinder ends.
"""

from math import ceil, floor, inf

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from compilation.record import record_type
from vision.tables import LEFT, OUTSIDE, RIGHT, Points
from vision.view import level, project, resolution

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Ints = NDArray[np.int64]
Labels = NDArray[np.uint8]
Rows = NDArray[np.record]
Table = NDArray[np.int32]
Grid = tuple[float, float, float]
"""Right end [rad] and width of a column [rad] of the grid of an envelope, slope of a pixel [1]."""

MAX_CELLS = 128  # of the grid of an envelope in each direction
MIN_COLUMNS = 3  # of a piece of an outline
MAX_PIECES = MAX_CELLS // MIN_COLUMNS
MIN_INNER = 2  # of them without the columns at its steps
NEAR_QUANTILE = 0.1  # of the distances of the points, for the nearest [1]

PIECE = record_type(
    left=float,
    right=float,
    left_true=bool,
    right_true=bool,
    run=float,
    first=int,
    last=int,
    sigma=float,
)
"""Piece of the lower or upper outline that belongs to one cylinder.

Azimuths of its ends [rad], whether these are sides of the cylinder, horizontal distance of its
nearest (lower outline) or farthest (upper outline) point [m], first and last (exclusive) of its
points, from right to left, and standard deviation of one slope [1].
"""


@compiled
def _label(padded: Labels, view: np.record, X: float, Y: float, slope: float) -> int:
    """Return the label of the pixel in a direction, `OUTSIDE` if there is none."""
    u, v, ahead = project(view, X, Y, slope)
    if not ahead:
        return OUTSIDE
    row = int(min(max(floor(v), -1.0), len(padded) - 2.0))
    column = int(min(max(floor(u), -1.0), padded.shape[1] - 2.0))
    return int(padded[row + 1, column + 1])


@compiled
def envelopes(
    blob: np.record, runs: Table, padded: Labels, view: np.record
) -> tuple[Grid, Array, Bools]:
    """Return lower and upper envelope of a blob on a grid of azimuth and slope.

    Cylinders are upright on this grid for every head pose.

    Args:
        blob: record of type `BLOB`, traced.
        runs: runs of all blobs.
        padded: labels of the image with a border of `OUTSIDE` one pixel wide (h + 2, w + 2).
        view: record of type `VIEW`.

    Returns:
        Grid; minimum and maximum slope of the blob in each column, from right to left (2, n);
        whether these are edges of an object (2, n).
    """
    left, top, right, bottom = blob.box
    mask = np.zeros((bottom - top, right - left), np.bool_)
    for i in range(blob.first_run, blob.last_run):
        for column in range(runs[i, 1], runs[i, 2]):
            mask[runs[i, 0] - top, column - left] = True
    start, low = blob.azimuth[0], blob.slope[0]
    width, height = blob.azimuth[1] - start, blob.slope[1] - low
    au, av, su, sv = resolution(view, 0.5 * (left + right), 0.5 * (top + bottom))
    size = max(su, sv)
    step = max(0.5 * size, height / MAX_CELLS)
    n = max(1, round(width / max(au, av, width / MAX_CELLS)))
    # Two more cells below and above hold the outer neighbours.
    cells = ceil(height / step) + 4
    result, usable = np.empty((2, n)), np.zeros((2, n), np.bool_)
    for i in range(n):
        X, Y = level(view, start + width / n * (i + 0.5))
        for j in range(2):
            # From below for the lower envelope, from above for the upper one.
            cell, sense = (0, 1) if j == 0 else (cells - 1, -1)
            filled = False
            for _ in range(cells):
                u, v, ahead = project(view, X, Y, low + step * (cell - 1.5))
                filled = (
                    ahead
                    and left <= u < right
                    and top <= v < bottom
                    and mask[int(v) - top, int(u) - left]
                )
                if filled:
                    break
                cell += sense
            if not filled:
                cell -= sense * cells
            result[j, i] = low + step * (cell - 1.5) - sense * 0.5 * step
            beyond = min(max(cell - sense, 0), cells - 1)
            label = _label(padded, view, X, Y, low + step * (beyond - 1.5))
            usable[j, i] = filled and (label == 0 if j == 0 else label != OUTSIDE)
    return (start, width / n, size), result, usable


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
def add_pieces(
    pieces: Rows,
    points: Points,
    used: int,
    envelope: Array,
    usable: Bools,
    grid: Grid,
    min_step: float,
    drop: float,
    nearest: bool,
    outer: tuple[bool, bool],
) -> tuple[int, int]:
    """Write the pieces of the lower or the upper outline; return their number and the points used.

    Args:
        pieces: records of type `PIECE`, output.
        points: points of all pieces, output.
        used: number of points before the call.
        envelope: (n,) [1].
        usable: columns where the outline is an edge of an object (n,).
        grid: columns of the envelope.
        min_step: minimum step between two pieces [1].
        drop: height of the rim minus that of the camera [m].
        nearest: whether the outline is of the nearest object of each column, else the farthest.
        outer: whether the left and the right end of the outline are sides of an object.
    """
    start, width, _ = grid
    azimuth, slope, outer_label = points
    n = len(envelope)
    edges = borders(envelope, min_step)
    runs = np.empty(n)
    count, m = 0, used
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
            azimuth[m], slope[m], outer_label[m] = start + width * (i + 0.5), envelope[i], 0
            m += 1
        if not ahead:
            m = first
            continue
        for i in range(first, m):
            runs[i - first] = drop / slope[i]
        piece = pieces[count]
        piece.right, piece.left = start + a * width, start + b * width
        piece.left_true = _ends(envelope, usable, b - 1, b, nearest, outer[LEFT])
        piece.right_true = _ends(envelope, usable, a, a - 1, nearest, outer[RIGHT])
        fraction = NEAR_QUANTILE if nearest else 1.0 - NEAR_QUANTILE
        piece.run = quantile(np.sort(runs[: m - first]), fraction)
        piece.first, piece.last = first, m
        count += 1
    return count, m
