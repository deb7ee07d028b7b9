"""Segmentation of merged blobs: several cylinders of one colour that overlap in the image.

Seen from above, a nearer cylinder occludes the foot of a farther one but never its head. Feet are
the pieces of the lower outline, heads those of the upper one.
"""

from math import inf

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from vision.cylinder import MIN_CLEARANCE
from vision.envelope import MAX_CELLS, MAX_PIECES, MIN_INNER, PIECE, Grid, add_pieces, envelopes
from vision.tables import (
    ANY,
    CANDIDATE,
    FAR,
    FOOT,
    HEAD,
    LEFT,
    NEAR,
    RIGHT,
    Points,
    add_rim,
    set_obstacle,
)

Array = NDArray[np.float64]
Labels = NDArray[np.uint8]
Ints = NDArray[np.int64]
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
        candidates: records of type `CANDIDATE`.
        merged: indices of those that are merged blobs (n,).
        blobs: records of type `BLOB`, traced.
        runs: runs of all blobs.
        padded: labels of the image with a border of `OUTSIDE` one pixel wide (h + 2, w + 2).
        view: record of type `VIEW`.
        p: parameters.

    Returns:
        Parts, records of type `CANDIDATE`; the points of their rims; the number of parts of each
        blob (n,), 0 where the outline has no steps.
    """
    n = len(merged)
    parts = np.empty(2 * MAX_PIECES * n, CANDIDATE)
    size = 2 * MAX_CELLS * n
    points = np.empty(size), np.empty(size), np.empty(size, np.uint8)
    counts = np.zeros(n, np.int64)
    pieces, pairs = np.zeros((2, MAX_PIECES), PIECE), np.empty((2 * MAX_PIECES, 2), np.int64)
    drop, head = -view.position[2], p.obstacle_height - view.position[2]
    count = used = 0
    for k in range(n):
        index = candidates[merged[k]].lower
        blob = blobs[index]
        grid, ends, usable = envelopes(blob, runs, padded, view)
        step, (left, right) = p.outline_step * grid[2], (blob.sides[LEFT], blob.sides[RIGHT])
        outer = left.trusted and not left.occluded, right.trusted and not right.occluded
        lower, used = add_pieces(
            pieces[FOOT], points, used, ends[0], usable[0], grid, step, drop, True, outer
        )
        upper = 0
        if head < -MIN_CLEARANCE * p.unit:
            upper, used = add_pieces(
                pieces[HEAD], points, used, ends[1], usable[1], grid, step, head, False, outer
            )
        if lower < 2 and upper < 2:
            continue
        matches = _match(pairs, pieces[FOOT, :lower], pieces[HEAD, :upper], grid, view, p)
        for i in range(matches):
            _trim(pairs[:matches], i, pieces, points[0])
            part = parts[count + counts[k]]
            part.upper = part.lower = index
            part.reported = False
            counts[k] += _set_part(part, pairs[i], pieces, points, grid, view, p)
        count += counts[k]
    return parts[:count], points, counts


@compiled
def _overlap(a: np.record, b: np.record) -> float:
    """Return the width that two pieces have in common, negative if none [rad]."""
    return float(min(a.left, b.left) - max(a.right, b.right))


@compiled
def _cost(low: np.record, high: np.record, grid: Grid, view: np.record, p: np.record) -> float:
    """Return the difference of a foot and a head, infinite if they are not of one cylinder [1]."""
    if _overlap(low, high) < 0.5 * min(low.left - low.right, high.left - high.right):
        return inf
    height = view.position[2]
    margin = p.radius_tolerance + grid[2] * (
        low.run * low.run / height + high.run * high.run / (height - p.obstacle_height)
    )
    radius = 0.5 * (high.run - low.run)
    if not p.min_radius - margin < radius < p.max_radius + margin:
        return inf
    tolerance, gaps = p.side_tolerance * grid[1], 0.0
    left, right = abs(low.left - high.left), abs(low.right - high.right)
    if low.left_true and high.left_true:
        gaps = left if left <= tolerance else inf
    if low.right_true and high.right_true:
        gaps += right if right <= tolerance else inf
    return float(abs(radius - p.radius) / margin + gaps / tolerance)


@compiled
def _match(pairs: Ints, feet: Rows, heads: Rows, grid: Grid, view: np.record, p: np.record) -> int:
    """Write foot and head of each cylinder, -1 for an occluded one; return their number."""
    costs = np.empty((len(feet), len(heads)))
    free_feet, free_heads = np.ones(len(feet), np.bool_), np.ones(len(heads), np.bool_)
    for i in range(len(feet)):
        for j in range(len(heads)):
            costs[i, j] = _cost(feet[i], heads[j], grid, view, p)
            # A piece that could also match a matched piece is another part of the same cylinder,
            # divided by an occluding object.
            if costs[i, j] < inf:
                free_feet[i] = free_heads[j] = False
    count = 0
    while costs.size:
        best = int(costs.argmin())
        i, j = best // len(heads), best % len(heads)
        if costs[i, j] == inf:
            break
        pairs[count, FOOT], pairs[count, HEAD] = i, j
        count += 1
        costs[i, :] = inf
        costs[:, j] = inf
    for i in range(len(feet)):
        if free_feet[i]:
            pairs[count, FOOT], pairs[count, HEAD] = i, -1
            count += 1
    for j in range(len(heads)):
        if free_heads[j]:
            pairs[count, FOOT], pairs[count, HEAD] = -1, j
            count += 1
    return count


@compiled
def _trim(pairs: Ints, i: int, pieces: Rows, azimuth: Array) -> None:
    """Trim the head of a pair to the part above its foot, if the head also spans another foot.

    Two heads at nearly the same distance leave no step in the upper outline. If no part is above
    the foot, the pair has no head.
    """
    if pairs[i, FOOT] < 0 or pairs[i, HEAD] < 0:
        return
    low, high = pieces[FOOT, pairs[i, FOOT]], pieces[HEAD, pairs[i, HEAD]]
    spans = False
    for j in range(i + 1, len(pairs)):
        if pairs[j, FOOT] >= 0 and pairs[j, HEAD] < 0:
            foot = pieces[FOOT, pairs[j, FOOT]]
            spans = spans or _overlap(high, foot) > 0.5 * (foot.left - foot.right)
    if not spans:
        return
    while high.first < high.last and azimuth[high.first] <= low.right:
        high.first += 1
    while high.first < high.last and azimuth[high.last - 1] >= low.left:
        high.last -= 1
    if high.last - high.first < MIN_INNER:
        pairs[i, HEAD] = -1
    high.left_true = high.left_true and high.left <= low.left
    high.right_true = high.right_true and high.right >= low.right
    high.left, high.right = min(high.left, low.left), max(high.right, low.right)


@compiled
def _set_side(side: np.record, a: tuple[float, bool], b: tuple[float, bool], sign: float) -> None:
    """Set a side to the mean of the visible ends of two pieces, else to the outermost one.

    Args:
        side: output.
        a: azimuth of the end [rad], and whether it is visible.
        b: the same of the other piece.
        sign: 1 for a left side, -1 for a right side.
    """
    side.trusted = a[1] or b[1]
    side.occluded = not side.trusted
    if a[1] == b[1]:
        outermost = sign * max(sign * a[0], sign * b[0])
        side.azimuth = (a[0] + b[0]) / 2.0 if a[1] else outermost
    else:
        side.azimuth = a[0] if a[1] else b[0]


@compiled
def _set_part(
    part: np.record,
    pair: Ints,
    pieces: Rows,
    points: Points,
    grid: Grid,
    view: np.record,
    p: np.record,
) -> bool:
    """Set a candidate from foot, head or both; return whether one of its sides is visible."""
    has_foot, has_head = pair[FOOT] >= 0, pair[HEAD] >= 0
    high = pieces[HEAD, pair[HEAD]] if has_head else pieces[FOOT, pair[FOOT]]
    low = pieces[FOOT, pair[FOOT]] if has_foot else high
    left, right = part.sides[LEFT], part.sides[RIGHT]
    _set_side(left, (low.left, low.left_true), (high.left, high.left_true), 1.0)
    _set_side(right, (low.right, low.right_true), (high.right, high.right_true), -1.0)
    if not (left.trusted or right.trusted):
        return False
    near = low.run if has_foot else max(high.run - 2.0 * p.radius, 0.1)
    far = high.run if has_head else near + 2.0 * p.radius
    for side in (left, right):
        side.sigma, side.points = p.side_sigma * grid[1], 1.0
        side.low = -view.position[2] / near
        side.high = (p.obstacle_height - view.position[2]) / far
    set_obstacle(part, p)
    low.sigma = high.sigma = p.side_sigma * grid[2]
    if has_foot:
        add_rim(part, low, ANY, points, 0.0, NEAR)
    if has_head:
        add_rim(part, high, ANY, points, part.height, FAR)
    part.occluded = not (has_foot and low.left_true and low.right_true)
    return True
