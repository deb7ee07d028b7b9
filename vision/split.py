"""Blobs of one colour that are several cylinders, told apart by steps in their outline.

From above, a nearer cylinder hides the foot of a farther one of the same colour but
never its head: the lower outline of the common blob belongs to the nearest cylinder of
each direction and the upper outline to the farthest. Where one ends, the outline steps.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vision.blob import Blob
from vision.colour import OUTSIDE
from vision.cylinder import Candidate, RimCue
from vision.outline import Outline, Rim, Side
from vision.parameters import VisionParameters
from vision.view import View

Array = NDArray[np.float64]
Labels = NDArray[np.uint8]

MAX_CELLS = 256  # of the grid in each direction
MIN_COLUMNS = 3  # a piece of an outline needs so many columns
EXTRA_RADIUS = 0.04  # a cylinder may seem thicker or thinner by so much when matched [m]
SIDE_MATCH = 2.5  # columns by which the sides of matching pieces may differ


@dataclass(frozen=True, slots=True)
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


@dataclass(frozen=True, slots=True)
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
    view: View,
    parameters: VisionParameters,
    radius: float,
    radius_sigma: float,
) -> list[Part]:
    """Cylinders of a blob that one cylinder does not explain; empty if none are told apart.

    Args:
        blob: to split.
        outline: of the blob.
        padded: labels of the image with a frame of `OUTSIDE` one pixel wide.
        view: camera and pose.
        parameters: sizes of obstacles.
        radius, radius_sigma: typical radius and its standard deviation [m].
    """
    grid = _Grid(blob, outline, padded, view)
    floor = -view.height
    head = parameters.obstacle_height - view.height
    step = parameters.step
    lower = grid.pieces(grid.low, grid.low_usable, grid.below, floor, step, nearer_is=-1.0)
    upper = grid.pieces(grid.high, grid.high_usable, grid.above, head, step, nearer_is=-1.0)
    if head > -0.05:
        upper = []
    if len(lower) < 2 and len(upper) < 2:
        return []
    tolerance = SIDE_MATCH * grid.azimuth_step
    pairs = _match(lower, upper, parameters, tolerance)
    used_lower = {i for i, _ in pairs}
    used_upper = {j for _, j in pairs}
    groups: list[tuple[_Piece | None, _Piece | None]] = [(lower[i], upper[j]) for i, j in pairs]
    groups += [(p, None) for i, p in enumerate(lower) if i not in used_lower]
    groups += [(None, p) for j, p in enumerate(upper) if j not in used_upper]
    parts = []
    for low, high in groups:
        part = _part(low, high, grid, parameters, radius, radius_sigma)
        if part is not None:
            parts.append(part)
    return parts if len(parts) > 1 else []
