"""Envelopes of merged blobs in azimuth and slope, and their steps.

The lower envelope of a merged blob belongs to the nearest cylinder of each direction, the upper one
to the farthest. An envelope has a step where a cylinder ends. Cylinders are upright in azimuth and
slope for every head pose; in the image they lean, and the nearer one may hide the step.
"""

from math import ceil, floor, inf

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from vision.tables import FOOT, OUTSIDE, Points
from vision.view import level, project, resolution

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Labels = NDArray[np.uint8]
Table = NDArray[np.int32]
Grid = tuple[int, float, float]
"""Number of columns of an envelope, their width [rad], and slope of a pixel [1]."""

MAX_CELLS = 128  # of the grid of an envelope in each direction
MIN_COLUMNS = 3  # of a piece of an envelope


@compiled
def add_envelopes(
    points: Points, first: int, blob: np.record, runs: Table, padded: Labels, view: np.record
) -> Grid:
    """Write the lower, then the upper envelope of a blob, both from right to left.

    Args:
        points: output; the label is 0 where the envelope is an edge of an object, else `OUTSIDE`.
        first: index of the first point.
        blob: record of type `Blob`, traced.
        runs: runs of all blobs.
        padded: labels of the image with a border of `OUTSIDE` one pixel wide (h + 2, w + 2).
        view: record of type `View`.
    """
    left, top, right, bottom = blob.box
    mask = np.zeros((bottom - top, right - left), np.bool_)
    for i in range(blob.first_run, blob.last_run):
        mask[runs[i, 0] - top, runs[i, 1] - left : runs[i, 2] - left] = True
    width, height = blob.azimuth[1] - blob.azimuth[0], blob.slope[1] - blob.slope[0]
    au, av, su, sv = resolution(view, 0.5 * (left + right), 0.5 * (top + bottom))
    n = max(1, round(width / max(au, av, width / MAX_CELLS)))
    step = max(0.5 * max(su, sv), height / MAX_CELLS)
    azimuth, slope, outer = points
    for j in range(2):
        # From below for the lower envelope, from above for the upper one.
        rise = step if j == FOOT else -step
        for i in range(n):
            k = first + j * n + i
            azimuth[k] = blob.azimuth[0] + width / n * (i + 0.5)
            X, Y = level(view, azimuth[k])
            # Two cells outside the blob hold the outer neighbour.
            slope[k] = blob.slope[j] - 2.5 * rise
            filled, label = False, OUTSIDE
            for _ in range(ceil(height / step) + 4):
                slope[k] += rise
                u, v, ahead = project(view, X, Y, slope[k])
                filled = (
                    ahead
                    and left <= u < right
                    and top <= v < bottom
                    and mask[int(v) - top, int(u) - left]
                )
                if filled:
                    break
                label = _label(padded, u, v) if ahead else OUTSIDE
            slope[k] -= 0.5 * rise
            edge = filled and (label == 0 if j == FOOT else label != OUTSIDE)
            outer[k] = 0 if edge else OUTSIDE
    return n, width / n, max(su, sv)


@compiled
def _label(padded: Labels, u: float, v: float) -> int:
    """Return the label of the pixel at an image point, `OUTSIDE` if there is none."""
    row = int(min(max(floor(v), -1.0), len(padded) - 2.0))
    column = int(min(max(floor(u), -1.0), padded.shape[1] - 2.0))
    return int(padded[row + 1, column + 1])


@compiled
def borders(envelope: Array, min_step: float, min_gap: float) -> Ints:
    """Return the first columns of the pieces of an envelope (n,), and the number of columns.

    Pieces of too few columns are merged with the neighbour across the smaller step.

    Args:
        envelope: slopes of a rim, from right to left (n,) [1].
        min_step: minimum step between two pieces [1].
        min_gap: minimum change of distance at a step, relative to the height difference of camera
            and rim [1]; of a close cylinder the rim itself is steep at its ends.
    """
    n = len(envelope)
    columns = np.empty(n + 1, np.int64)
    columns[0] = 0
    count = 1
    for i in range(1, n):
        step = max(min_step, min_gap * envelope[i] * envelope[i - 1])
        if abs(envelope[i] - envelope[i - 1]) > step:
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
