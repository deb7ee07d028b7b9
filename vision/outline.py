"""Silhouette edges of blobs in azimuth and slope, and which of them are edges of the object.

The silhouette of an upright cylinder has two vertical sides and a lower and an upper rim. Side
pixels whose outer neighbour has another colour may be edges of an occluding object and are not
used. Below a blob, another colour belongs to a nearer object, which occludes the rim; above a
blob, to a farther object, because the camera is higher than the obstacles.
"""

from math import inf

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from vision.tables import LEFT, OUTSIDE, RIGHT, Points
from vision.view import angles, resolution, upright

Array = NDArray[np.float64]
Labels = NDArray[np.uint8]
Rows = NDArray[np.record]
Table = NDArray[np.int32]

LOW_FRACTION = 0.25  # lower fraction of a side that decides whether it is occluded
END_FRACTION = 0.1  # fraction of the width at each end excluded from rims
END_PIXELS = 0.8  # minimum width of that end [pixel]
INVALID = -9.0  # outside the range of azimuths [rad]
ENVELOPE = 1.1  # maximum distance of the points of a side from the outermost [pixel]
MAX_OVERHANG = 2.5  # maximum distance of a side inside the blob [pixel]
TURNS = 3.0  # an edge that crosses n pixels has a common error 1 + TURNS*n times smaller
CUT = 4  # maximum number of points at the border per point of an edge; else noise
MIN_SLOPE = 1e-4  # minimum slope of a pixel [1]
OUTLIERS = 8  # one in so many points of a side may be an outlier


@compiled
def _edge(
    points: Array,
    outer: Labels,
    blob: np.record,
    extents: Table,
    padded: Labels,
    view: np.record,
    e: int,
) -> tuple[float, float]:
    """Write the points of one of the four edges of a blob (n, 3) and their outer labels (n,).

    Returns:
        Change of azimuth [rad] and slope [1] per pixel in the middle of the edge.
    """
    left, top = blob.box[0], blob.box[1]
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
def _set_side(
    side: np.record, points: Array, outer: Labels, pixel: float, sign: float, edge_sigma: float
) -> None:
    """Set one side from the points of an edge.

    Args:
        side: output.
        points: azimuth [rad], slope [1] and image coordinate across the edge [pixel] (n, 3).
        outer: labels of their outer neighbours (n,).
        pixel: azimuth of one pixel [rad].
        sign: 1 for a left side, -1 for a right side.
        edge_sigma: standard deviation of one point of an edge [pixel].
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
    ranked.sort()
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
    side.trusted = furthest <= outermost + MAX_OVERHANG * pixel and CUT * used >= cut
    side.occluded = 2 * covered > low
    median = 0.5 * (ranked[n - 1 - (used - 1) // 2] + ranked[n - 1 - used // 2])
    side.azimuth = sign * (median if side.trusted else furthest)
    side.sigma = edge_sigma * pixel
    side.points = independent(float(max(used, 1)), max(highest - lowest, 0.0))
    side.low, side.high = bottom, top


@compiled
def _add_points(
    rims: Points, count: int, points: Array, outer: Labels, right: float, left: float
) -> int:
    """Write the points of a rim between two azimuths after `count` others; return the new count.

    The ends are excluded, because the rim may follow a side there.
    """
    azimuth, slope, rim_outer = rims
    n, cut = count, 0
    for i in range(len(points)):
        if outer[i] == OUTSIDE:
            cut += 1
        elif right < points[i, 0] < left:
            azimuth[n], slope[n], rim_outer[n] = points[i, 0], points[i, 1], outer[i]
            n += 1
    return n if CUT * (n - count) >= cut else count


@compiled
def trace(
    blobs: Rows, extents: Table, padded: Labels, view: np.record, edge_sigma: float
) -> Points:
    """Set the sides and rims of all blobs of an image; return the points of all rims.

    A blob has four edges: the two ends of its rows and of its columns. The direction of
    vertical lines in the image decides which two of them are the sides.

    Args:
        blobs: records of type `Blob` (n,).
        extents: extents of the blobs.
        padded: labels of the image with a border of `OUTSIDE` one pixel wide (h + 2, w + 2).
        view: record of type `View`.
        edge_sigma: standard deviation of one point of an edge [pixel].
    """
    points, outer = np.empty((len(extents), 3)), np.empty(len(extents), np.uint8)
    rims = np.empty(len(extents)), np.empty(len(extents)), np.empty(len(extents), np.uint8)
    size = np.empty((4, 2))
    starts, middle = np.zeros(5, np.int64), np.zeros(4, np.int64)
    m = 0
    for k in range(len(blobs)):
        blob, sides = blobs[k], blobs[k].sides
        left, top, right, bottom = blob.box
        starts[0] = blob.first_extent
        for e in range(4):
            a = starts[e]
            b = starts[e + 1] = a + (bottom - top if e < 2 else right - left)
            middle[e] = (a + b) // 2
            size[e, 0], size[e, 1] = _edge(
                points[a:b], outer[a:b], blob, extents[a:b], padded, view, e
            )
        edges = points[starts[0] : starts[4]]
        blob.azimuth[0], blob.azimuth[1] = edges[:, 0].min(), edges[:, 0].max()
        blob.slope[0], blob.slope[1] = edges[:, 1].min(), edges[:, 1].max()
        side, rim = (0, 2) if upright(view, 0.5 * (left + right), 0.5 * (top + bottom)) else (2, 0)
        swapped = 0 if points[middle[side], 0] >= points[middle[side + 1], 0] else 1
        for j in range(2):
            e = side + (j ^ swapped)
            a, b = starts[e], starts[e + 1]
            _set_side(sides[j], points[a:b], outer[a:b], size[e, 0], 1.0 - 2.0 * j, edge_sigma)
        leftmost, rightmost = sides[LEFT].azimuth, sides[RIGHT].azimuth
        margin = max(END_FRACTION * (leftmost - rightmost), END_PIXELS * size[side + swapped, 0])
        swapped = 0 if points[middle[rim + 1], 1] >= points[middle[rim], 1] else 1
        for j in range(2):
            e = rim + (j ^ swapped)
            a, b = starts[e], starts[e + 1]
            blob.rims[j].first = m
            m = _add_points(rims, m, points[a:b], outer[a:b], rightmost + margin, leftmost - margin)
            blob.rims[j].last = m
            blob.rims[j].sigma = edge_sigma * max(size[e, 1], MIN_SLOPE)
    return rims[0][:m], rims[1][:m], rims[2][:m]


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
