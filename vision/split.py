"""Segmentation of merged blobs: several cylinders of one colour that overlap in the image.

Seen from above, a nearer cylinder occludes the foot of a farther one but never its head. The
lower outline of a merged blob belongs to the nearest cylinder of each direction, the upper
outline to the farthest. The outline has a step where a cylinder ends.
"""

from collections.abc import Sequence
from dataclasses import replace
from math import floor, inf

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from compilation.value import value
from vision.blob import Blob
from vision.cylinder import MIN_CLEARANCE, Candidate, RimCue
from vision.outline import Outline, Rim, Side, envelopes
from vision.parameters import VisionParameters
from vision.view import View

Array = NDArray[np.float64]
Labels = NDArray[np.uint8]

Bools = NDArray[np.bool_]
Ints = NDArray[np.int64]
MIN_COLUMNS = 3  # of a piece of an outline
MIN_INNER = 2  # of them without the columns at its steps
NEAR_QUANTILE = 0.1  # of the distances of the points, for the nearest [1]
RIGHT, LEFT, RIGHT_TRUE, LEFT_TRUE, RUN, POINTS = range(6)  # columns of a table of pieces


@value
class _Piece:
    """Piece of the lower or upper outline that belongs to one cylinder.

    Attributes:
        right, left: azimuths of its ends [rad].
        right_true, left_true: whether these are sides of the cylinder.
        run: horizontal distance of its nearest (lower) or farthest (upper) point [m].
        azimuth, slope: usable points.
    """

    right: float
    left: float
    right_true: bool
    left_true: bool
    run: float
    azimuth: Array
    slope: Array


@value
class Part:
    """One cylinder of a merged blob.

    Attributes:
        candidate: edges.
        occluded: partly occluded by another cylinder of the blob.
    """

    candidate: Candidate
    occluded: bool


def split(
    blob: Blob, outline: Outline, padded: Labels, view: View, parameters: VisionParameters
) -> list[Part]:
    """Segment a merged blob; return its cylinders, empty if the outline has no steps.

    Args:
        blob: merged blob.
        outline: outline of the blob.
        padded: labels of the image with a border of `OUTSIDE` one pixel wide.
        view: camera and pose.
        parameters: sizes of obstacles.
    """
    grid = _Grid(blob, outline, padded, view)
    step = parameters.outline_step
    head = parameters.obstacle_height - view.height
    lower = grid.pieces(-view.height, step, nearest=True)
    upper = []
    if head < -MIN_CLEARANCE * parameters.unit:
        upper = grid.pieces(head, step, nearest=False)
    if len(lower) < 2 and len(upper) < 2:
        return []
    groups = _match(lower, upper, grid, view, parameters)
    feet = [low for low, high in groups if low is not None and high is None]
    parts = [_part(low, _over(low, high, feet), grid, view, parameters) for low, high in groups]
    return [part for part in parts if part is not None]


class _Grid:
    """Outline of a blob sampled on a grid of azimuth and slope, where cylinders are upright."""

    def __init__(self, blob: Blob, outline: Outline, padded: Labels, view: View) -> None:
        self.start, self.azimuth_step, self.pixel, self.ends, self.usable = envelopes(
            np.array(blob.box, np.int32), blob.extents, blob.runs, padded, view.packed
        )
        self.outer_right = outline.right.trusted and not outline.right.occluded
        self.outer_left = outline.left.trusted and not outline.left.occluded

    def pieces(self, drop: float, step: float, *, nearest: bool) -> list[_Piece]:
        """Return the pieces of the lower or the upper outline.

        Args:
            drop: height of the rim minus that of the camera [m].
            step: minimum step between two pieces [pixel].
            nearest: lower outline, of the nearest object of each column; else upper outline, of
                the farthest object.
        """
        row = 0 if nearest else 1
        table, azimuth, slope = pieces_of(
            self.ends[row],
            self.usable[row],
            self.start,
            self.azimuth_step,
            step * self.pixel,
            drop,
            nearest,
            self.outer_right,
            self.outer_left,
        )
        pieces = []
        first = 0
        for right, left, right_true, left_true, run, points in table.tolist():
            of_piece = slice(first, first + int(points))
            true = right_true != 0.0, left_true != 0.0
            pieces.append(_Piece(right, left, *true, run, azimuth[of_piece], slope[of_piece]))
            first = of_piece.stop
        return pieces


def _match(
    lower: Sequence[_Piece],
    upper: Sequence[_Piece],
    grid: _Grid,
    view: View,
    parameters: VisionParameters,
) -> list[tuple[_Piece | None, _Piece | None]]:
    """Return foot and head of each cylinder, None for an occluded one."""
    costs = []
    tolerance = parameters.split.side_tolerance * grid.azimuth_step
    fall = view.height - parameters.obstacle_height
    for i, low in enumerate(lower):
        for j, high in enumerate(upper):
            common = min(low.left, high.left) - max(low.right, high.right)
            shorter = min(low.left - low.right, high.left - high.right)
            if common < 0.5 * shorter:
                continue
            margin = parameters.split.radius_tolerance + grid.pixel * (
                low.run**2 / view.height + high.run**2 / fall
            )
            radius = 0.5 * (high.run - low.run)
            if not parameters.min_radius - margin < radius < parameters.max_radius + margin:
                continue
            gaps = [
                abs(a - b)
                for a, b, true in (
                    (low.left, high.left, low.left_true and high.left_true),
                    (low.right, high.right, low.right_true and high.right_true),
                )
                if true
            ]
            if any(gap > tolerance for gap in gaps):
                continue
            mean_radius, _ = parameters.radius_prior
            costs.append((abs(radius - mean_radius) / margin + sum(gaps) / tolerance, i, j))
    pairs: list[tuple[int, int]] = []
    feet, heads = set(range(len(lower))), set(range(len(upper)))
    for _, i, j in sorted(costs):
        if all(i != a and j != b for a, b in pairs):
            pairs.append((i, j))
        # A piece that could also match a matched piece is another part of the same cylinder,
        # divided by an occluding object.
        feet.discard(i)
        heads.discard(j)
    return [
        *((lower[i], upper[j]) for i, j in pairs),
        *((lower[i], None) for i in sorted(feet)),
        *((None, upper[j]) for j in sorted(heads)),
    ]


def _over(low: _Piece | None, high: _Piece | None, feet: Sequence[_Piece]) -> _Piece | None:
    """Return the part of a head above its foot, if the head also spans another foot.

    Two heads at nearly the same distance leave no step in the upper outline.
    """
    if low is None or high is None:
        return high
    if not any(
        min(high.left, foot.left) - max(high.right, foot.right) > 0.5 * (foot.left - foot.right)
        for foot in feet
    ):
        return high
    over = (high.azimuth > low.right) & (high.azimuth < low.left)
    if np.count_nonzero(over) < MIN_INNER:
        return None
    return replace(
        high,
        right=max(high.right, low.right),
        left=min(high.left, low.left),
        right_true=high.right_true and high.right >= low.right,
        left_true=high.left_true and high.left <= low.left,
        azimuth=high.azimuth[over],
        slope=high.slope[over],
    )


def _rim(piece: _Piece, sigma: float) -> Rim:
    return Rim(piece.azimuth, piece.slope, np.zeros(len(piece.slope), np.uint8), sigma)


def _part(
    low: _Piece | None, high: _Piece | None, grid: _Grid, view: View, parameters: VisionParameters
) -> Part | None:
    """Return one cylinder from foot, head or both, None if neither side is visible."""
    pieces = [p for p in (low, high) if p is not None]
    rights = [p.right for p in pieces if p.right_true]
    lefts = [p.left for p in pieces if p.left_true]
    if not rights and not lefts:
        return None
    radius = parameters.radius_prior
    head = parameters.obstacle_height - view.height
    near = low.run if low is not None else max(pieces[0].run - 2.0 * radius[0], 0.1)
    far = high.run if high is not None else near + 2.0 * radius[0]
    span = (-view.height / near, head / far)
    sides = [
        Side(
            azimuth=sum(true) / len(true) if true else outermost,
            sigma=parameters.split.side_sigma * grid.azimuth_step,
            count=1.0,
            low=span[0],
            high=span[1],
            trusted=bool(true),
            occluded=not true,
        )
        for true, outermost in (
            (lefts, max(p.left for p in pieces)),
            (rights, min(p.right for p in pieces)),
        )
    ]
    rims = []
    sigma = parameters.split.side_sigma * grid.pixel
    if low is not None:
        rims.append(RimCue(_rim(low, sigma), 0.0, near=True))
    if high is not None:
        rim = _rim(high, sigma)
        rims.append(RimCue(rim, parameters.obstacle_height, near=False))
    whole = low is not None and low.left_true and low.right_true
    left, right = sides
    height = parameters.obstacle_height
    return Part(Candidate(left, right, tuple(rims), height, *radius), occluded=not whole)


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
def pieces_of(
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
        width: width of a column [rad].
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
