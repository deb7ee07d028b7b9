"""Segmentation of merged blobs: several cylinders of one colour that overlap in the image.

Seen from above, a nearer cylinder occludes the foot of a farther one but never its head. The
lower outline of a merged blob belongs to the nearest cylinder of each direction, the upper
outline to the farthest. The outline has a step where a cylinder ends.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vision import split_kernel
from vision.blob import Blob
from vision.cylinder import MIN_CLEARANCE, Candidate, RimCue
from vision.outline import Outline, Rim, Side
from vision.outline_kernel import envelopes
from vision.parameters import VisionParameters
from vision.split_kernel import MIN_INNER
from vision.value import value
from vision.view import View

Array = NDArray[np.float64]
Labels = NDArray[np.uint8]


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
        outline: of the blob.
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
        table, azimuth, slope = split_kernel.pieces(
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
