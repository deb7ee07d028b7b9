"""Blobs of one colour that are several cylinders, told apart by steps in their outline.

From above, a nearer cylinder hides the foot of a farther one of the same colour but
never its head: the lower outline of the common blob belongs to the nearest cylinder of
each direction and the upper outline to the farthest. Where one ends, the outline steps.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from vision.blob import Blob
from vision.cylinder import Candidate, RimCue
from vision.cylinder_kernel import MIN_CLEARANCE
from vision.outline import Outline, Rim, Side
from vision.outline_kernel import envelopes
from vision.parameters import VisionParameters
from vision.value import value
from vision.view import View

Array = NDArray[np.float64]
Labels = NDArray[np.uint8]

MIN_COLUMNS = 3  # a piece of an outline needs so many columns
MIN_INNER = 2  # of them must be left when those at its steps are not used
EXTRA_RADIUS = 0.04  # a cylinder may seem thicker or thinner by so much when matched [m]
SIDE_SIGMA = 1.0  # standard deviation of an end of a piece [column]
SIDE_MATCH = 2.5  # columns by which the sides of matching pieces may differ


@value
class _Piece:
    """Part of the lower or upper outline that shows one cylinder.

    Attributes:
        right, left: azimuths of its ends [rad].
        right_true, left_true: whether the cylinder ends there.
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
    """One cylinder of a split blob.

    Attributes:
        candidate: its edges.
        occluded: another cylinder of the blob hides part of it.
    """

    candidate: Candidate
    occluded: bool


def split(
    blob: Blob,
    outline: Outline,
    padded: Labels,
    *,
    view: View,
    parameters: VisionParameters,
    radius: tuple[float, float],
) -> list[Part]:
    """Cylinders of a blob that one cylinder does not explain; empty if none are told apart.

    Args:
        blob: to split.
        outline: of the blob.
        padded: labels of the image with a frame of `OUTSIDE` one pixel wide.
        view: camera and pose.
        parameters: sizes of obstacles.
        radius: typical radius and its standard deviation [m].
    """
    grid = _Grid(blob, outline, padded, view)
    step = parameters.step
    head = parameters.obstacle_height - view.height
    lower = grid.pieces(grid.low, grid.low_usable, -view.height, step, nearest=True)
    upper = []
    if head < -MIN_CLEARANCE:
        upper = grid.pieces(grid.high, grid.high_usable, head, step, nearest=False)
    if len(lower) < 2 and len(upper) < 2:
        return []
    groups = _match(
        lower,
        upper,
        view=view,
        pixel=grid.pixel,
        tolerance=SIDE_MATCH * grid.azimuth_step,
        parameters=parameters,
    )
    feet = [low for low, high in groups if low is not None and high is None]
    parts = [
        _part(low, _over(low, high, feet), grid, view=view, parameters=parameters, radius=radius)
        for low, high in groups
    ]
    return [part for part in parts if part is not None]


class _Grid:
    """The blob sampled on a grid of azimuth and slope, where cylinders stand upright."""

    def __init__(self, blob: Blob, outline: Outline, padded: Labels, view: View) -> None:
        self.start, self.azimuth_step, self.pixel, ends, usable = envelopes(
            np.array(blob.box, np.int32), blob.extents, blob.runs, padded, view.packed
        )
        self.low, self.high = ends.tolist()
        self.low_usable, self.high_usable = usable.tolist()
        self.outer_right = outline.right.trusted and not outline.right.hidden
        self.outer_left = outline.left.trusted and not outline.left.hidden

    def pieces(
        self, envelope: list[float], usable: list[bool], drop: float, step: float, nearest: bool
    ) -> list[_Piece]:
        """Pieces of the lower or the upper outline.

        Args:
            envelope: slope of the outline in each column (n,).
            usable: columns where the outline is the edge of a thing (n,).
            drop: height of the rim minus that of the camera [m].
            step: that parts two pieces [pixel].
            nearest: the outline shows the nearest thing of each column, not the farthest.
        """
        n = len(envelope)
        jumps = [abs(b - a) for a, b in pairwise(envelope)]
        steps = [i for i, jump in enumerate(jumps, start=1) if jump > step * self.pixel]
        starts = _merge_narrow([0, *steps], jumps, n)
        pieces = []
        for a, b in pairwise([*starts, n]):
            chosen = [i for i in range(a, b) if usable[i]]
            if len(chosen) < MIN_COLUMNS or 2 * len(chosen) < b - a:
                continue
            # The column at a step shows part of what stands beside it.
            inner = [i for i in chosen if (i > a or a == 0) and (i < b - 1 or b == n)]
            chosen = inner if len(inner) >= MIN_INNER else chosen
            slopes = [envelope[i] for i in chosen]
            if min(slope * drop for slope in slopes) <= 0.0:
                continue
            pieces.append(
                _Piece(
                    right=self.start + a * self.azimuth_step,
                    left=self.start + b * self.azimuth_step,
                    right_true=self._ends(
                        envelope, usable, a, a - 1, nearest=nearest, outer=self.outer_right
                    ),
                    left_true=self._ends(
                        envelope, usable, b - 1, b, nearest=nearest, outer=self.outer_left
                    ),
                    run=_quantile([drop / slope for slope in slopes], 0.1 if nearest else 0.9),
                    azimuth=self.start + self.azimuth_step * (np.array(chosen) + 0.5),
                    slope=np.array(slopes),
                )
            )
        return pieces

    @staticmethod
    def _ends(
        envelope: list[float],
        usable: list[bool],
        last: int,
        beyond: int,
        *,
        nearest: bool,
        outer: bool,
    ) -> bool:
        """Whether a thing ends between its column `last` and the column `beyond`."""
        if beyond < 0 or beyond >= len(envelope):
            return outer
        if not (usable[last] and usable[beyond]):
            return False
        # Slopes are negative: a farther rim has the greater one.
        return (envelope[beyond] > envelope[last]) == nearest


def _quantile(values: list[float], share: float) -> float:
    """Value below which such a share of `values` lies, between two of them if need be."""
    ranked = sorted(values)
    whole, part = divmod(share * (len(ranked) - 1), 1.0)
    low, high = ranked[int(whole)], ranked[min(int(whole) + 1, len(ranked) - 1)]
    gap = high - low
    return low + part * gap if part < 0.5 else high - (1.0 - part) * gap


def _merge_narrow(starts: list[int], jumps: list[float], n: int) -> list[int]:
    """Join pieces of too few columns to the neighbour across the smaller step."""
    starts = list(starts)
    while len(starts) > 1:
        ends = [*starts[1:], n]
        widths = [b - a for a, b in zip(starts, ends, strict=True)]
        k = min(range(len(widths)), key=lambda i: (widths[i], i))
        if widths[k] >= MIN_COLUMNS:
            break
        before = jumps[starts[k] - 1] if k > 0 else float("inf")
        after = jumps[ends[k] - 1] if k + 1 < len(starts) else float("inf")
        del starts[k if before <= after else k + 1]
    return starts


def _match(
    lower: Sequence[_Piece],
    upper: Sequence[_Piece],
    *,
    view: View,
    pixel: float,
    tolerance: float,
    parameters: VisionParameters,
) -> list[tuple[_Piece | None, _Piece | None]]:
    """Foot and head of each cylinder, None for the one that is not seen."""
    costs = []
    fall = view.height - parameters.obstacle_height
    for i, low in enumerate(lower):
        for j, high in enumerate(upper):
            common = min(low.left, high.left) - max(low.right, high.right)
            shorter = min(low.left - low.right, high.left - high.right)
            if common < 0.5 * shorter:
                continue
            slack = EXTRA_RADIUS + pixel * (low.run**2 / view.height + high.run**2 / fall)
            radius = 0.5 * (high.run - low.run)
            if not parameters.min_radius - slack < radius < parameters.max_radius + slack:
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
            middle = 0.5 * (parameters.min_radius + parameters.max_radius)
            costs.append((abs(radius - middle) / slack + sum(gaps) / tolerance, i, j))
    pairs: list[tuple[int, int]] = []
    feet, heads = set(range(len(lower))), set(range(len(upper)))
    for _, i, j in sorted(costs):
        if all(i != a and j != b for a, b in pairs):
            pairs.append((i, j))
        # A piece that could pair with one already paired is another part of that thing,
        # seen on the other side of what divides it.
        feet.discard(i)
        heads.discard(j)
    return [
        *((lower[i], upper[j]) for i, j in pairs),
        *((lower[i], None) for i in sorted(feet)),
        *((None, upper[j]) for j in sorted(heads)),
    ]


def _over(low: _Piece | None, high: _Piece | None, feet: Sequence[_Piece]) -> _Piece | None:
    """What of an upper piece stands over its own foot, if it also covers another's.

    Two heads nearly as far as each other leave no step in the upper outline.
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
    low: _Piece | None,
    high: _Piece | None,
    grid: _Grid,
    *,
    view: View,
    parameters: VisionParameters,
    radius: tuple[float, float],
) -> Part | None:
    """One cylinder from its foot, its head or both; None if neither side is seen."""
    pieces = [p for p in (low, high) if p is not None]
    rights = [p.right for p in pieces if p.right_true]
    lefts = [p.left for p in pieces if p.left_true]
    if not rights and not lefts:
        return None
    head = parameters.obstacle_height - view.height
    near = low.run if low is not None else max(pieces[0].run - 2.0 * radius[0], 0.1)
    far = high.run if high is not None else near + 2.0 * radius[0]
    span = (-view.height / near, head / far)
    sides = [
        Side(
            azimuth=sum(true) / len(true) if true else outermost,
            sigma=SIDE_SIGMA * grid.azimuth_step,
            count=1.0,
            low=span[0],
            high=span[1],
            trusted=bool(true),
            hidden=not true,
        )
        for true, outermost in (
            (lefts, max(p.left for p in pieces)),
            (rights, min(p.right for p in pieces)),
        )
    ]
    rims = []
    sigma = SIDE_SIGMA * grid.pixel
    if low is not None:
        rims.append(RimCue(_rim(low, sigma), 0.0, near=True))
    if high is not None:
        rim = _rim(high, sigma)
        rims.append(RimCue(rim, parameters.obstacle_height, near=False))
    whole = low is not None and low.left_true and low.right_true
    left, right = sides
    height = parameters.obstacle_height
    return Part(Candidate(left, right, tuple(rims), height, *radius), occluded=not whole)
