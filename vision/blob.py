"""Blobs: connected components of one colour class."""

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from vision.tables import Blob

Table = NDArray[np.int32]

Labels = NDArray[np.uint8]
Rows = NDArray[np.record]
Regions = tuple[Rows, Table]
ROW, START, STOP, COLOR = range(4)  # columns of a table of runs
LEFT, TOP, RIGHT, BOTTOM, AREA, LABEL, RUNS = range(7)  # columns of a table of regions


@compiled
def _root(parent: Table, run: int) -> int:
    """Return the root of a run in the union-find forest, with path halving."""
    while parent[run] != run:
        parent[run] = parent[parent[run]]
        run = parent[run]
    return run


@compiled
def _runs_of(labels: Labels) -> tuple[Table, Table]:
    """Return all runs, by row, then column (n, 4), and the parent of each (n,)."""
    height, width = labels.shape
    runs = np.empty((height * width, 4), np.int32)
    parent = np.empty(height * width, np.int32)
    n = above = 0
    for row in range(height):
        begin = n
        end = 0
        while end < width:
            label, start = labels[row, end], end
            end += 1
            while end < width and labels[row, end] == label:
                end += 1
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
def _measure(runs: Table, parent: Table, min_area: Table, shape: tuple[int, int]) -> Regions:
    """Return the large enough regions as blobs (n,), and the region of each run, or -1 (m,)."""
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
    blobs = np.zeros(count, Blob)
    m = first_run = first_extent = 0
    for label in range(1, len(min_area) + 1):
        for k in range(count):
            if table[k, LABEL] != label or table[k, AREA] < min_area[label - 1]:
                continue
            blob = blobs[m]
            left, top, right, bottom = table[k, 0], table[k, 1], table[k, 2], table[k, 3]
            blob.box[0], blob.box[1], blob.box[2], blob.box[3] = left, top, right, bottom
            blob.label, blob.first_extent = label, first_extent
            blob.first_run = blob.last_run = first_run
            blob.cut = left == 0 or top == 0 or right == shape[1] or bottom == shape[0]
            first_run += table[k, RUNS]
            first_extent += 2 * (right - left + bottom - top)
            index[k] = m
            m += 1
    for i in range(n):
        region[i] = index[region[i]]
    return blobs[:m], region


@compiled
def find_blobs(labels: Labels, min_area: Table) -> tuple[Rows, Table, Table]:
    """Return the 8-connected components of a label image: two-scan labelling of runs.

    Args:
        labels: label of each pixel (h, w), 0 for background.
        min_area: minimum area of blobs of label 1, 2, ... (k,) [pixel].

    Returns:
        Blobs by label, top, left, records of type `Blob` (n,); the runs of all: row, first and
        last (exclusive) column and label, by row, then column for each blob (m, 4) [pixel]; the
        extents of all [pixel].

    Source: He, Chao and Suzuki, A run-based two-scan labeling algorithm, 2008.
    """
    all_runs, parent = _runs_of(labels)
    blobs, region = _measure(all_runs, parent, min_area, labels.shape)
    size = run_count = 0
    for k in range(len(blobs)):
        left, top, right, bottom = blobs[k].box
        size += 2 * (right - left + bottom - top)
    for i in range(len(all_runs)):
        run_count += region[i] >= 0
    runs = np.empty((run_count, 4), np.int32)
    extents = np.empty(size, np.int32)
    extents[:] = -1
    for i in range(len(all_runs)):
        if region[i] < 0:
            continue
        blob = blobs[region[i]]
        left, top, right, bottom = blob.box
        for column in range(4):
            runs[blob.last_run, column] = all_runs[i, column]
        blob.last_run += 1
        row, first, last = all_runs[i, ROW], all_runs[i, START], all_runs[i, STOP]
        height, width = bottom - top, right - left
        here = blob.first_extent + row - top
        if extents[here] < 0:
            extents[here] = first
        extents[here + height] = last
        columns = blob.first_extent + 2 * height - left
        for column in range(columns + first, columns + last):
            if extents[column] < 0:
                extents[column] = row
            extents[column + width] = row + 1
    return blobs, runs, extents
