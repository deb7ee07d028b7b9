"""Segmentation of merged blobs: several cylinders of one colour that overlap in the image.

Seen from above, a nearer cylinder occludes the foot of a farther one but never its head. Feet are
the pieces of the lower envelope, heads those of the upper one. Each piece is a candidate; of the
foot and the head of one cylinder the less certain one is discarded after the fit.
"""

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from vision.cylinder import MIN_CLEARANCE, MIN_DISTANCE
from vision.envelope import MAX_CELLS, MIN_COLUMNS, Grid, add_envelopes, borders
from vision.tables import (
    FAR,
    FOOT,
    HALF_WIDTH,
    HEAD,
    LEFT,
    NEAR,
    RIGHT,
    Candidate,
    Points,
    add_rim,
    count_next_to,
    mean_height,
    set_obstacle,
)

Ints = NDArray[np.int64]
Labels = NDArray[np.uint8]
Rows = NDArray[np.record]
Table = NDArray[np.int32]


@compiled
def split(
    candidates: Rows,
    merged: Ints,
    blobs: Rows,
    runs: Table,
    padded: Labels,
    view: np.record,
    p: np.record,
) -> tuple[Rows, Points, Ints]:
    """Segment merged blobs.

    Args:
        candidates: records of type `Candidate`.
        merged: indices of those that are merged blobs (n,).
        blobs: records of type `Blob`, traced.
        runs: runs of all blobs.
        padded: labels of the image with a border of `OUTSIDE` one pixel wide (h + 2, w + 2).
        view: record of type `View`.
        p: parameters.

    Returns:
        Parts, records of type `Candidate`; the points of their rims; the number of parts of each
        blob (n,), 0 where the envelopes have no steps.
    """
    n = len(merged)
    size = 2 * MAX_CELLS * n
    parts = np.empty(size // MIN_COLUMNS, Candidate)
    points = np.empty(size), np.empty(size), np.empty(size, np.uint8)
    counts = np.zeros(n, np.int64)
    count = used = 0
    for k in range(n):
        index = candidates[merged[k]].lower
        grid = add_envelopes(points, used, blobs[index], runs, padded, view)
        stepped = False
        for rim in (FOOT, HEAD):
            first = used + rim * grid[0]
            head = (p.obstacle_height - HALF_WIDTH * p.height_sigma) / p.unit
            drop = view.clearance - (head if rim == HEAD else 0.0)
            if drop < MIN_CLEARANCE:
                continue
            envelope = points[1][first : first + grid[0]]
            columns = borders(envelope, p.outline_step * grid[2], p.min_gap / p.unit / drop)
            stepped = stepped or len(columns) > 2
            for i in range(len(columns) - 1):
                part = parts[count + counts[k]]
                part.upper = part.lower = index
                part.reported = False
                part.rims[0].first, part.rims[0].last = first + columns[i], first + columns[i + 1]
                if _set_sides(part, rim, blobs[index], first, grid, points, p):
                    counts[k] += _set_rim(part, rim, first, grid, points, view.clearance, p)
        if not stepped:
            counts[k] = 0
        count += counts[k]
        used += 2 * grid[0]
    return parts[:count], points, counts


@compiled
def _set_sides(
    part: np.record,
    rim: int,
    blob: np.record,
    first: int,
    grid: Grid,
    points: Points,
    p: np.record,
) -> bool:
    """Set the sides of a part from the ends of its rim; return whether one of them is visible.

    Args:
        part: record of type `Candidate`, of which the points of the rim are set.
        rim: `FOOT` or `HEAD`.
        blob: blob of the part.
        first: first point of the envelope.
        grid: columns of the envelope.
        points: points of the envelope.
        p: parameters.
    """
    azimuth, slope, outer = points
    for j in range(2):
        side, whole = part.sides[j], blob.sides[j]
        end, beyond = part.rims[0].first, part.rims[0].first - 1
        if j == LEFT:
            end, beyond = part.rims[0].last - 1, part.rims[0].last
        side.azimuth = azimuth[end] + (0.5 if j == LEFT else -0.5) * grid[1]
        side.sigma, side.points = p.side_sigma * grid[1], 1.0
        if first <= beyond < first + grid[0]:
            # Slopes are negative: a nearer rim has the smaller one.
            nearer = slope[end] < slope[beyond]
            side.trusted = outer[end] == 0 and outer[beyond] == 0 and nearer == (rim == FOOT)
        else:
            side.trusted = whole.trusted and not whole.occluded
        side.occluded = not side.trusted
    return bool(part.sides[LEFT].trusted or part.sides[RIGHT].trusted)


@compiled
def _set_rim(
    part: np.record, rim: int, first: int, grid: Grid, points: Points, h: float, p: np.record
) -> bool:
    """Set the rim of a part whose sides are set; return whether enough of it is visible.

    Args:
        part: record of type `Candidate`.
        rim: `FOOT` or `HEAD`.
        first: first point of the envelope.
        grid: columns of the envelope.
        points: points of the envelope.
        h: height of the camera [unit].
        p: parameters.
    """
    piece, sides = part.rims[0], part.sides
    # A column at a step also shows a part of the neighbouring object.
    piece.first += piece.first > first
    piece.last -= piece.last < first + grid[0]
    piece.sigma = p.side_sigma * grid[2]
    if count_next_to(piece, 0, points) < MIN_COLUMNS:
        return False
    set_obstacle(part, p)
    height = mean_height(part) * (rim == HEAD)
    add_rim(part, piece, 0, points, height, FAR if rim == HEAD else NEAR)
    if piece.middle >= 0.0:
        return False
    distance, width = (piece.height - h) / piece.middle, 2.0 * part.prior[0]
    near = distance if rim == FOOT else max(distance - width, MIN_DISTANCE)
    for j in range(2):
        sides[j].low, sides[j].high = -h / near, (part.height - h) / (near + width)
    part.occluded = not (rim == FOOT and sides[LEFT].trusted and sides[RIGHT].trusted)
    return True
