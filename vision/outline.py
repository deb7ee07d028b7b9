"""Silhouette edges of blobs in azimuth and slope, and which of them are edges of the object.

The silhouette of an upright cylinder has two vertical sides and a lower and an upper rim. Side
pixels whose outer neighbour has another colour may be edges of an occluding object and are not
used. Below a blob, another colour belongs to a nearer object, which occludes the rim; above a
blob, to a farther object, because the camera is higher than the obstacles.
"""

from collections.abc import Sequence
from math import ceil, floor, inf

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from compilation.value import value
from vision.blob import Blob
from vision.view import View, angles, level, project, resolution, upright

Array = NDArray[np.float64]

Bools = NDArray[np.bool_]
Labels = NDArray[np.uint8]
Table = NDArray[np.int32]
OUTSIDE = 255  # as in `vision.color`
LOW_FRACTION = 0.25  # lower fraction of a side that decides whether it is occluded
END_FRACTION = 0.1  # fraction of the width at each end excluded from rims
END_PIXELS = 0.8  # minimum width of that end [pixel]
INVALID = -9.0  # outside the range of azimuths [rad]
ENVELOPE = 1.1  # maximum distance of the points of a side from the outermost [pixel]
MAX_OVERHANG = 2.5  # maximum distance of a side inside the blob [pixel]
TURNS = 3.0  # an edge that crosses n pixels has a common error 1 + TURNS*n times smaller
MAX_CELLS = 128  # of the grid of an envelope in each direction
CUT = 4  # maximum number of points at the border per point of an edge; else noise
MIN_SLOPE = 1e-4  # minimum slope of a pixel [1]
OUTLIERS = 8  # one in so many points of a side may be an outlier


@value
class Side:
    """One side edge of a blob.

    Attributes:
        azimuth: azimuth from the heading of the camera [rad].
        sigma: standard deviation of one point of it [rad].
        count: number of independent points averaged.
        low, high: minimum and maximum slope of the visible edge [1].
        trusted: an edge of the object, neither of an occluding object nor of the image.
        occluded: partly occluded by a nearer object.
    """

    azimuth: float
    sigma: float
    count: float
    low: float
    high: float
    trusted: bool
    occluded: bool


@value
class Rim:
    """Lower or upper edge of a blob, without its ends and cut parts.

    Attributes:
        azimuth: azimuths of its points from the heading of the camera (n,) [rad].
        slope: slopes of its points (n,) [1].
        outer: label of the outer neighbour of each point, 0 for the background (n,).
        sigma: standard deviation of one slope [1].
    """

    azimuth: Array
    slope: Array
    outer: NDArray[np.uint8]
    sigma: float

    @property
    def occlusion_fraction(self) -> float:
        """Fraction of the edge next to another colour class."""
        return int(np.count_nonzero(self.outer)) / max(self.outer.size, 1)

    def free(self) -> "Rim":
        """Return the part next to the background."""
        return self._part(self.outer == 0) if self.occlusion_fraction else self

    def against(self, label: int) -> "Rim":
        """Return the part next to colour class `label`."""
        return self._part(self.outer == label)

    def _part(self, chosen: NDArray[np.bool_]) -> "Rim":
        return Rim(self.azimuth[chosen], self.slope[chosen], self.outer[chosen], self.sigma)


@value
class Outline:
    """Edges of one blob.

    Attributes:
        left: side of larger azimuth.
        right: side of smaller azimuth.
        bottom: rim of smaller slope.
        top: rim of larger slope.
    """

    left: Side
    right: Side
    bottom: Rim
    top: Rim


def trace(
    blobs: Sequence[Blob], padded: NDArray[np.uint8], view: View, edge_sigma: float
) -> list[Outline]:
    """Trace the silhouette edges of blobs.

    Args:
        blobs: blobs of one image.
        padded: its labels with a border of `OUTSIDE` one pixel wide (h + 2, w + 2).
        view: camera and pose.
        edge_sigma: standard deviation of one point of an edge [pixel].
    """
    if not blobs:
        return []
    sides, counts, pixels, (azimuth, slope), outer = silhouettes(
        np.array([blob.box for blob in blobs], np.int32),
        np.concatenate([blob.extents for blob in blobs]),
        padded,
        view.packed,
    )
    outlines = []
    start = 0
    for both, count, pixel in zip(sides.tolist(), counts.tolist(), pixels.tolist(), strict=True):
        left, right = (_side_of(values, edge_sigma) for values in both)
        middle = start + count[0]
        stop = middle + count[1]
        near, far = slice(start, middle), slice(middle, stop)
        bottom = Rim(azimuth[near], slope[near], outer[near], edge_sigma * pixel[0])
        top = Rim(azimuth[far], slope[far], outer[far], edge_sigma * pixel[1])
        outlines.append(Outline(left, right, bottom, top))
        start = stop
    return outlines


def _side_of(values: Sequence[float], edge_sigma: float) -> Side:
    azimuth, pixel, points, crossed, low, high, trusted, occluded = values
    count = independent(points, crossed)
    return Side(azimuth, edge_sigma * pixel, count, low, high, trusted != 0.0, occluded != 0.0)


@compiled
def _edge(
    points: Array, outer: Labels, box: Table, extents: Table, padded: Labels, view: Array, e: int
) -> tuple[float, float]:
    """Write the points of one of the four edges of a blob (n, 3) and their outer labels (n,).

    Returns:
        Change of azimuth [rad] and slope [1] per pixel in the middle of the edge.
    """
    left, top = box[0], box[1]
    azimuth_pixel = slope_pixel = 0.0
    for i in range(len(points)):
        end = extents[i]
        # The border shifts pixel (row, column) to (row + 1, column + 1).
        if e < 2:
            u, v = float(end), top + i + 0.5
            outer[i] = padded[top + i + 1, end if e == 0 else end + 1]
        else:
            u, v = left + i + 0.5, float(end)
            outer[i] = padded[end if e == 2 else end + 1, left + i + 1]
        points[i, 0], points[i, 1] = angles(view, u, v)
        # Ends of rows measure u, ends of columns v.
        points[i, 2] = u if e < 2 else v
        if i == len(points) // 2:
            au, av, su, sv = resolution(view, u, v)
            azimuth_pixel, slope_pixel = (au, su) if e < 2 else (av, sv)
    return azimuth_pixel, slope_pixel


@compiled
def _sort(values: Array) -> None:
    """Sort by insertion, in place."""
    for i in range(1, len(values)):
        value, j = values[i], i
        while j > 0 and values[j - 1] > value:
            values[j] = values[j - 1]
            j -= 1
        values[j] = value


@compiled
def _side(side: Array, points: Array, outer: Labels, pixel: float, sign: float) -> None:
    """Write one side (8,) from the points of an edge; see `silhouettes`.

    Args:
        side: output.
        points: azimuth [rad], slope [1] and image coordinate across the edge [pixel] (n, 3).
        outer: labels of their outer neighbours (n,).
        pixel: azimuth of one pixel [rad].
        sign: 1 for a left side, -1 for a right side.
    """
    n = len(points)
    bottom, top, furthest = inf, -inf, -inf
    free = cut = 0
    ranked = np.empty(n)
    for i in range(n):
        outwards, slope = sign * points[i, 0], points[i, 1]
        bottom, top, furthest = min(bottom, slope), max(top, slope), max(furthest, outwards)
        ranked[i] = outwards if outer[i] == 0 else INVALID
        free += outer[i] == 0
        cut += outer[i] == OUTSIDE
    _sort(ranked)
    # The side is the median of the free points near the outermost of them.
    outermost = ranked[n - 1 - free // OUTLIERS]
    limit, low_limit = outermost - ENVELOPE * pixel, bottom + LOW_FRACTION * (top - bottom)
    low = covered = used = 0
    bottom, top, lowest, highest = inf, -inf, inf, -inf
    for i in range(n):
        outwards, slope = sign * points[i, 0], points[i, 1]
        if slope <= low_limit:
            low += 1
            covered += outer[i] != 0 and outer[i] != OUTSIDE
        if (outwards if outer[i] == 0 else INVALID) >= limit:
            used += 1
            bottom, top = min(bottom, slope), max(top, slope)
            lowest, highest = min(lowest, points[i, 2]), max(highest, points[i, 2])
    # If the outermost points border on another colour, the object continues behind it.
    trusted = furthest <= outermost + MAX_OVERHANG * pixel and CUT * used >= cut
    median = 0.5 * (ranked[n - 1 - (used - 1) // 2] + ranked[n - 1 - used // 2])
    side[0] = sign * (median if trusted else furthest)
    side[1] = pixel
    side[2] = max(used, 1)
    side[3] = max(highest - lowest, 0.0)
    side[4] = bottom
    side[5] = top
    side[6] = trusted
    side[7] = 2 * covered > low


@compiled
def _rim(
    rims: Array, rim_outer: Labels, points: Array, outer: Labels, right: float, left: float
) -> int:
    """Write the points of a rim between two azimuths; return their number.

    The ends are excluded, because the rim may follow a side there.
    """
    count = cut = 0
    for i in range(len(points)):
        if outer[i] == OUTSIDE:
            cut += 1
        elif right < points[i, 0] < left:
            rims[0, count], rims[1, count] = points[i, 0], points[i, 1]
            rim_outer[count] = outer[i]
            count += 1
    return count if CUT * count >= cut else 0


@compiled
def silhouettes(
    boxes: Table, extents: Table, padded: Labels, view: Array
) -> tuple[Array, Table, Array, Array, Labels]:
    """Return the sides and rims of all blobs of an image.

    A blob has four edges: the two ends of its rows and of its columns. The direction of
    vertical lines in the image decides which two of them are the sides.

    Args:
        boxes: left, top, right, bottom of the blobs (n, 4) [pixel].
        extents: extents of the blobs, concatenated.
        padded: labels of the image with a border of `OUTSIDE` one pixel wide (h + 2, w + 2).
        view: packed.

    Returns:
        Left and right side of each blob (n, 2, 8): azimuth [rad], azimuth of a pixel [rad],
        number of points, number of pixels crossed, minimum and maximum slope, whether it is
        trusted, whether it is occluded. Of lower and upper rim the number of points (n, 2) and
        the slope of a pixel (n, 2); azimuth and slope (2, m) and outer label (m,) of the points
        of all rims, concatenated.
    """
    n = len(boxes)
    sides, counts, sizes = np.empty((n, 2, 8)), np.empty((n, 2), np.int32), np.empty((n, 2))
    points, outer = np.empty((len(extents), 3)), np.empty(len(extents), np.uint8)
    rims, rim_outer = np.empty((2, len(extents))), np.empty(len(extents), np.uint8)
    size = np.empty((4, 2))
    starts, middle = np.zeros(5, np.int64), np.zeros(4, np.int64)
    m = 0
    for k in range(n):
        left, top, right, bottom = boxes[k, 0], boxes[k, 1], boxes[k, 2], boxes[k, 3]
        starts[0] = starts[4]
        for e in range(4):
            a = starts[e]
            b = starts[e + 1] = a + (bottom - top if e < 2 else right - left)
            middle[e] = (a + b) // 2
            size[e, 0], size[e, 1] = _edge(
                points[a:b], outer[a:b], boxes[k], extents[a:b], padded, view, e
            )
        side, rim = (0, 2) if upright(view, 0.5 * (left + right), 0.5 * (top + bottom)) else (2, 0)
        swapped = 0 if points[middle[side], 0] >= points[middle[side + 1], 0] else 1
        for j in range(2):
            e = side + (j ^ swapped)
            a, b = starts[e], starts[e + 1]
            _side(sides[k, j], points[a:b], outer[a:b], size[e, 0], 1.0 - 2.0 * j)
        leftmost, rightmost = sides[k, 0, 0], sides[k, 1, 0]
        margin = max(END_FRACTION * (leftmost - rightmost), END_PIXELS * size[side + swapped, 0])
        swapped = 0 if points[middle[rim + 1], 1] >= points[middle[rim], 1] else 1
        for j in range(2):
            e = rim + (j ^ swapped)
            a, b = starts[e], starts[e + 1]
            counts[k, j] = _rim(
                rims[:, m:],
                rim_outer[m:],
                points[a:b],
                outer[a:b],
                rightmost + margin,
                leftmost - margin,
            )
            m += counts[k, j]
            sizes[k, j] = max(size[e, 1], MIN_SLOPE)
    return sides, counts, sizes, rims[:, :m], rim_outer[:m]


@compiled
def _label(padded: Labels, view: Array, X: float, Y: float, slope: float) -> int:
    """Return the label of the pixel in a direction, `OUTSIDE` if there is none."""
    u, v, ahead = project(view, X, Y, slope)
    if not ahead:
        return OUTSIDE
    row = int(min(max(floor(v), -1.0), len(padded) - 2.0))
    column = int(min(max(floor(u), -1.0), padded.shape[1] - 2.0))
    return int(padded[row + 1, column + 1])


@compiled
def envelopes(
    box: Table, extents: Table, runs: Table, padded: Labels, view: Array
) -> tuple[float, float, float, Array, Bools]:
    """Return lower and upper envelope of a blob on a grid of azimuth and slope.

    Cylinders are upright on this grid for every head pose.

    Args:
        box: left, top, right, bottom of the blob (4,) [pixel].
        extents: extents of the blob.
        runs: runs of the blob.
        padded: labels of the image with a border of `OUTSIDE` one pixel wide (h + 2, w + 2).
        view: packed.

    Returns:
        Right end of the grid [rad], width of its columns [rad] and slope of a pixel [1]; minimum
        and maximum slope of the blob in each column, from right to left (2, n); whether these
        are edges of an object (2, n).
    """
    left, top, right, bottom = box[0], box[1], box[2], box[3]
    mask = np.zeros((bottom - top, right - left), np.bool_)
    for i in range(len(runs)):
        for column in range(runs[i, 1], runs[i, 2]):
            mask[runs[i, 0] - top, column - left] = True
    points, outer = np.empty((len(extents), 3)), np.empty(len(extents), np.uint8)
    a = 0
    for e in range(4):
        b = a + (bottom - top if e < 2 else right - left)
        _edge(points[a:b], outer[a:b], box, extents[a:b], padded, view, e)
        a = b
    start, end, low, high = inf, -inf, inf, -inf
    for i in range(len(points)):
        start, end = min(start, points[i, 0]), max(end, points[i, 0])
        low, high = min(low, points[i, 1]), max(high, points[i, 1])
    width, height = end - start, high - low
    au, av, su, sv = resolution(view, 0.5 * (left + right), 0.5 * (top + bottom))
    size = max(su, sv)
    step = max(0.5 * size, height / MAX_CELLS)
    n = max(1, round(width / max(au, av, width / MAX_CELLS)))
    # Two more cells below and above hold the outer neighbours.
    cells = ceil(height / step) + 4
    result, usable = np.empty((2, n)), np.zeros((2, n), np.bool_)
    for i in range(n):
        X, Y = level(view, start + width / n * (i + 0.5))
        for j in range(2):
            # From below for the lower envelope, from above for the upper one.
            cell, sense = (0, 1) if j == 0 else (cells - 1, -1)
            filled = False
            for _ in range(cells):
                u, v, ahead = project(view, X, Y, low + step * (cell - 1.5))
                filled = (
                    ahead
                    and left <= u < right
                    and top <= v < bottom
                    and mask[int(v) - top, int(u) - left]
                )
                if filled:
                    break
                cell += sense
            if not filled:
                cell -= sense * cells
            result[j, i] = low + step * (cell - 1.5) - sense * 0.5 * step
            beyond = min(max(cell - sense, 0), cells - 1)
            label = _label(padded, view, X, Y, low + step * (beyond - 1.5))
            usable[j, i] = filled and (label == 0 if j == 0 else label != OUTSIDE)
    return start, width / n, size, result, usable


@compiled
def independent(count: float, crossed: float) -> float:
    """Return the number of points of an edge with independent errors.

    The quantization error is uniform over a pixel. It is common to all points of an edge
    parallel to the pixel grid and averages out along an edge that crosses pixels.

    Args:
        count: points of the edge, at least one.
        crossed: number of pixels crossed, perpendicular to the edge.
    """
    common = 1.0 / (1.0 + TURNS * crossed)
    return 1.0 / max(1.0 / count, common * common)
