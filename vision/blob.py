"""Blobs: connected components of one colour class."""

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from compilation.value import value

Table = NDArray[np.int32]

Labels = NDArray[np.uint8]
ROW, START, STOP, COLOR = range(4)  # columns of a table of runs
LEFT, TOP, RIGHT, BOTTOM, AREA, LABEL, RUNS = range(7)  # columns of a table of regions
WORD = 8  # pixels that are compared at once
REPEAT = np.uint64(0x0101010101010101)  # a label times this is a word of that label


@value
class Blob:
    """Connected component of one colour class.

    Attributes:
        label: label of its colour class.
        box: left, top, right, bottom pixel, right and bottom exclusive.
        runs: run-length encoding: row, first and last (exclusive) column and label of each run,
            by row, then column (n, 4) [pixel].
        extents: first and last (exclusive) column of each row, then first and last (exclusive)
            row of each column, concatenated (2 (bottom - top) + 2 (right - left),) [pixel].
        touches: whether it touches the left, top, right and bottom border.
    """

    label: int
    box: tuple[int, int, int, int]
    runs: Table
    extents: Table
    touches: tuple[bool, bool, bool, bool]

    @property
    def cut(self) -> bool:
        """Whether it touches a border."""
        return any(self.touches)


def find_blobs(labels: Labels, min_area: tuple[int, ...]) -> list[Blob]:
    """Return the 8-connected components of a label image (h, w), by label, then top, then left.

    Args:
        labels: label of each pixel, 0 for background.
        min_area: minimum area of blobs of label 1, 2, ... [pixel].
    """
    height, width = labels.shape
    regions, runs, extents = regions_of(labels, np.array(min_area, np.int32))
    blobs: list[Blob] = []
    first_run = first_extent = 0
    for left, top, right, bottom, _, label, count in regions.tolist():
        last_run = first_run + count
        last_extent = first_extent + 2 * (bottom - top + right - left)
        blobs.append(
            Blob(
                label,
                (left, top, right, bottom),
                runs[first_run:last_run],
                extents[first_extent:last_extent],
                (left == 0, top == 0, right == width, bottom == height),
            )
        )
        first_run, first_extent = last_run, last_extent
    return blobs


@compiled
def _root(parent: Table, run: int) -> int:
    """Return the root of a run in the union-find forest, with path halving."""
    while parent[run] != run:
        parent[run] = parent[parent[run]]
        run = parent[run]
    return run


@compiled
def _end(flat: Labels, words: NDArray[np.uint64], start: int, stop: int) -> int:
    """Return the end of the run that begins at `start`.

    Args:
        flat: labels of an image, row by row (n,).
        words: view of `flat` by words, without an incomplete last one.
        start: first pixel of the run.
        stop: end of its row.
    """
    label = flat[start]
    word = label * REPEAT
    end = start + 1
    while end < stop and flat[end] == label:
        end += 1
        while end % WORD == 0 and end + WORD <= stop and words[end // WORD] == word:
            end += WORD
    return end


@compiled
def _runs_of(labels: Labels) -> tuple[Table, Table]:
    """Return all runs, by row, then column (n, 4), and the parent of each (n,)."""
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
            # A run above that ends before this run touches no later run either.
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


@compiled
def _measure(runs: Table, parent: Table, min_area: Table) -> tuple[Table, Table]:
    """Return the large enough regions (n, 7), and the region of each run, or -1 (m,)."""
    n = len(runs)
    table = np.empty((n, 7), np.int32)
    region, index = np.empty(n, np.int32), np.empty(n, np.int32)
    count = 0
    for i in range(n):
        root = _root(parent, i)
        if root == i:
            k = count
            count += 1
            table[k, LEFT], table[k, TOP], table[k, RIGHT] = (runs[i, START], runs[i, ROW], 0)
            table[k, AREA], table[k, LABEL], table[k, RUNS] = 0, runs[i, COLOR], 0
            index[k] = -1
        else:
            k = region[root]
        region[i] = k
        table[k, LEFT] = min(table[k, LEFT], runs[i, START])
        table[k, RIGHT] = max(table[k, RIGHT], runs[i, STOP])
        table[k, BOTTOM] = runs[i, ROW] + 1
        table[k, AREA] += runs[i, STOP] - runs[i, START]
        table[k, RUNS] += 1
    regions = np.empty((count, 7), np.int32)
    m = 0
    for label in range(1, len(min_area) + 1):
        for k in range(count):
            if table[k, LABEL] == label and table[k, AREA] >= min_area[label - 1]:
                for column in range(7):
                    regions[m, column] = table[k, column]
                index[k] = m
                m += 1
    for i in range(n):
        region[i] = index[region[i]]
    return regions[:m], region


@compiled
def regions_of(labels: Labels, min_area: Table) -> tuple[Table, Table, Table]:
    """Return the connected components of a label image: two-scan labelling of runs.

    Args:
        labels: label of each pixel (h, w), 0 for background.
        min_area: minimum area of regions of label 1, 2, ... (k,) [pixel].

    Returns:
        Left, top, right, bottom, area, label and number of runs of each region (n, 7), by
        label, top, left; their runs (m, 4) and extents as in `Blob`, concatenated.

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
