"""Connected regions of one label in an image, compiled."""

import numpy as np
from numba import njit
from numpy.typing import NDArray

Labels = NDArray[np.uint8]
Table = NDArray[np.int32]

ROW, START, STOP, COLOR = range(4)  # columns of a table of runs
LEFT, TOP, RIGHT, BOTTOM, AREA, LABEL, RUNS = range(7)  # columns of a table of regions

WORD = 8  # pixels that are compared at once
EACH = np.uint64(0x0101010101010101)  # a label times this is a word of it


@njit(cache=True)
def _root(parent: Table, run: int) -> int:
    """First run of the region that a run belongs to, so far as is known."""
    while parent[run] != run:
        parent[run] = parent[parent[run]]
        run = parent[run]
    return run


@njit(cache=True)
def _end(flat: Labels, words: NDArray[np.uint64], start: int, stop: int) -> int:
    """Where the run of one label that begins at `start` ends, `stop` at the latest.

    Args:
        flat: labels of an image, row by row (n,).
        words: the same, but for less than a word at the end.
        start: a pixel.
        stop: the end of its row.
    """
    label = flat[start]
    word = label * EACH
    end = start + 1
    while end < stop and flat[end] == label:
        end += 1
        while end % WORD == 0 and end + WORD <= stop and words[end // WORD] == word:
            end += WORD
    return end


@njit(cache=True)
def _runs_of(labels: Labels) -> tuple[Table, Table]:
    """Runs of one label, by row, then column (n, 4), and an earlier one each is joined to (n,)."""
    height, width = labels.shape
    flat = labels.reshape(-1)
    words = flat[: flat.size // WORD * WORD].view(np.uint64)
    runs = np.empty((height * width, 4), np.int32)
    parent = np.empty(height * width, np.int32)
    n = above = 0
    for row in range(height):
        begin = n
        end = 0
        while end < width:
            label, start = labels[row, end], end
            end = _end(flat, words, row * width + start, (row + 1) * width) - row * width
            if label == 0:
                continue
            runs[n, ROW], runs[n, START], runs[n, STOP], runs[n, COLOR] = row, start, end, label
            parent[n] = n
            # What ends before this run starts touches none that comes after it either.
            while above < begin and runs[above, STOP] < start:
                above += 1
            root = n
            for other in range(above, begin):
                if runs[other, START] > end:
                    break
                if runs[other, COLOR] == label:
                    a, b = _root(parent, other), root
                    root = min(a, b)
                    parent[max(a, b)] = root
            n += 1
        above = begin
    return runs[:n], parent[:n]


@njit(cache=True)
def _measure(runs: Table, parent: Table, min_area: Table) -> tuple[Table, Table]:
    """Regions that are large enough (n, 7), and which of them each run is in, or -1 (m,)."""
    n = len(runs)
    found = np.empty((n, 7), np.int32)
    region, place = np.empty(n, np.int32), np.empty(n, np.int32)
    count = 0
    for i in range(n):
        root = _root(parent, i)
        if root == i:
            k = count
            count += 1
            found[k, LEFT], found[k, TOP], found[k, RIGHT] = runs[i, START], runs[i, ROW], 0
            found[k, AREA], found[k, LABEL], found[k, RUNS] = 0, runs[i, COLOR], 0
            place[k] = -1
        else:
            k = region[root]
        region[i] = k
        found[k, LEFT] = min(found[k, LEFT], runs[i, START])
        found[k, RIGHT] = max(found[k, RIGHT], runs[i, STOP])
        found[k, BOTTOM] = runs[i, ROW] + 1
        found[k, AREA] += runs[i, STOP] - runs[i, START]
        found[k, RUNS] += 1
    regions = np.empty((count, 7), np.int32)
    m = 0
    for label in range(1, len(min_area) + 1):
        for k in range(count):
            if found[k, LABEL] == label and found[k, AREA] >= min_area[label - 1]:
                for column in range(7):
                    regions[m, column] = found[k, column]
                place[k] = m
                m += 1
    for i in range(n):
        region[i] = place[region[i]]
    return regions[:m], region


@njit(cache=True)
def regions_of(labels: Labels, min_area: Table) -> tuple[Table, Table, Table]:
    """Connected regions: the runs of each row, joined to those of the row above.

    Args:
        labels: label of each pixel (h, w), 0 for background.
        min_area: smallest region of label 1, 2, ... (k,) [pixel].

    Returns:
        Left, top, right, bottom, area, label and number of runs of each region (n, 7), by
        label, top, left; and their runs (m, 4) and extents, as `Blob` has them, one region
        after the other.

    Source: He, Chao and Suzuki, A run-based two-scan labeling algorithm, 2008.
    """
    all_runs, parent = _runs_of(labels)
    regions, region = _measure(all_runs, parent, min_area)
    n = len(regions)
    free = np.empty(n, np.int32)
    start = np.empty(n, np.int32)
    m = size = 0
    for k in range(n):
        free[k], start[k] = m, size
        m += regions[k, RUNS]
        size += 2 * (regions[k, RIGHT] - regions[k, LEFT] + regions[k, BOTTOM] - regions[k, TOP])
    runs = np.empty((m, 4), np.int32)
    extents = np.empty(size, np.int32)
    extents[:] = -1
    for i in range(len(all_runs)):
        k = region[i]
        if k < 0:
            continue
        for column in range(4):
            runs[free[k], column] = all_runs[i, column]
        free[k] += 1
        row, first, last = all_runs[i, ROW], all_runs[i, START], all_runs[i, STOP]
        height = regions[k, BOTTOM] - regions[k, TOP]
        width = regions[k, RIGHT] - regions[k, LEFT]
        here = start[k] + row - regions[k, TOP]
        if extents[here] < 0:
            extents[here] = first
        extents[here + height] = last
        columns = start[k] + 2 * height - regions[k, LEFT]
        for column in range(columns + first, columns + last):
            if extents[column] < 0:
                extents[column] = row
            extents[column + width] = row + 1
    return regions, runs, extents
