"""Outlines: the edges of blobs as azimuths and slopes, and which of them can be trusted.

The sides of an upright cylinder are two vertical lines; its lower and upper edge are
rims. A side pixel whose outer neighbour has another colour may be the edge of whatever
hides the cylinder; it is not used. Below a blob, another colour always belongs to a
nearer thing, which hides the true rim; above it, to a farther one, which does not,
because the camera stands higher than the obstacles.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vision.blob import Blob, Index
from vision.colour import OUTSIDE
from vision.view import View

Array = NDArray[np.float64]

LOW_SHARE = 0.25  # share of a side, from below, that tells whether a nearer thing hides it
END_SHARE = 0.1  # share of the width near each side that is left out of rims
END_PIXELS = 0.8  # and at least so much of it [pixel]
NOWHERE = -9.0  # an azimuth that no point has [rad]
ENVELOPE = 1.1  # side pixels within so much of the outermost lie on the side [pixel]
MAX_OVERHANG = 2.5  # a side does not lie farther inside what is seen than this [pixel]
CUT = 4  # an edge has at least one point for so many at the border; fewer are noise there
TURNS = 3.0  # an edge that crosses a pixel errs so many times less, and one time less
OUTLIERS = 8  # one pixel in so many may stick out of a side


@dataclass(frozen=True, slots=True)
class Side:
    """One side edge of a blob.

    Attributes:
        azimuth: from the heading of the camera [rad].
        sigma: standard deviation of one point of it [rad].
        count: of points with errors of their own that it was averaged over.
        low, high: slopes between which the edge is seen [1].
        trusted: it is an edge of the thing and not of what hides it or of the image.
        hidden: a nearer thing covers part of it.
    """

    azimuth: float
    sigma: float
    count: float
    low: float
    high: float
    trusted: bool
    hidden: bool


@dataclass(frozen=True, slots=True)
class Rim:
    """Lower or upper edge of a blob, without its ends and what the border cuts.

    Attributes:
        azimuth: of its points from the heading of the camera (n,) [rad].
        slope: of its points (n,) [1].
        outer: label beyond each point, 0 for the background (n,).
        sigma: standard deviation of one slope [1].
    """

    azimuth: Array
    slope: Array
    outer: NDArray[np.uint8]
    sigma: float

    @property
    def covered(self) -> float:
        """Share of the edge next to another colour class."""
        return int(np.count_nonzero(self.outer)) / max(self.outer.size, 1)

    def free(self) -> "Rim":
        """The part next to the background."""
        return self._part(self.outer == 0) if self.outer.any() else self

    def against(self, label: int) -> "Rim":
        """The part next to things of colour class `label`."""
        return self._part(self.outer == label)

    def _part(self, chosen: NDArray[np.bool_]) -> "Rim":
        return Rim(self.azimuth[chosen], self.slope[chosen], self.outer[chosen], self.sigma)


@dataclass(frozen=True, slots=True)
class Outline:
    """Edges of one blob.

    Attributes:
        left: side of greater azimuth.
        right: side of smaller azimuth.
        bottom: rim of smaller slopes.
        top: rim of greater slopes.
    """

    left: Side
    right: Side
    bottom: Rim
    top: Rim


def trace(
    blobs: Sequence[Blob], padded: NDArray[np.uint8], view: View, edge_sigma: float
) -> list[Outline]:
    """Outlines of `blobs`.

    Args:
        blobs: of one image.
        padded: its labels with a frame of `OUTSIDE` one pixel wide (h + 2, w + 2).
        view: camera and pose.
        edge_sigma: standard deviation of one point of an edge [pixel].
    """
    if not blobs:
        return []
    edges = _Edges(blobs, padded, view)
    sides = edges.sides(edge_sigma)
    rims = edges.rims(sides, edge_sigma)
    return [
        Outline(sides[edges.left[k]], sides[edges.right[k]], rims[edges.bottom[k]], rims[top])
        for k, top in enumerate(edges.top)
    ]


def independent(count: NDArray[np.intp], crossed: Array) -> Array:
    """How many of an edge's points have errors of their own.

    A pixel tells only that the edge passes through it, with an error that is uniform over
    the pixel. An edge that runs along the pixels passes through all of them at the same
    place and errs everywhere alike; one that crosses from pixel to pixel errs by turns.

    Args:
        count: points of each edge (n,).
        crossed: how many pixels it crosses, at right angles to itself (n,).
    """
    alike = 1.0 / (1.0 + TURNS * crossed)
    result: Array = 1.0 / np.maximum(1.0 / count, alike * alike)
    return result


class _Edges:
    """The edges of all blobs of an image, four a blob, one after the other.

    Two are the ends of the rows and two the ends of the columns of the blob; which of
    them are sides and which are rims depends on how vertical lines run there.

    Attributes:
        left: the edge of each blob that is its left side (n,).
        right: its right side.
        bottom: its lower rim.
        top: its upper rim.
    """

    def __init__(self, blobs: Sequence[Blob], padded: NDArray[np.uint8], view: View) -> None:
        u_parts: list[NDArray[Any]] = []
        v_parts: list[NDArray[Any]] = []
        row_parts: list[Index] = []
        column_parts: list[Index] = []
        sizes: list[int] = []
        uprights: list[bool] = []
        pixels = np.arange(max(padded.shape))
        middles = pixels + 0.5
        for blob in blobs:
            left, top, right, bottom = blob.box
            columns, rows = pixels[left:right], pixels[top:bottom]
            u_middle, v_middle = middles[left:right], middles[top:bottom]
            first, last = blob.row_extents()
            high, low = blob.column_extents()
            u_parts += (first, last, u_middle, u_middle)
            v_parts += (v_middle, v_middle, high, low)
            row_parts += (rows, rows, high - 1, low)
            column_parts += (first - 1, last, columns, columns)
            sizes += (len(rows), len(rows), len(columns), len(columns))
            uprights.append(view.upright(0.5 * (left + right), 0.5 * (top + bottom)))
        u, v = np.concatenate(u_parts), np.concatenate(v_parts)
        # The frame shifts pixel (row, column) to (row + 1, column + 1).
        self.outer = padded[np.concatenate(row_parts) + 1, np.concatenate(column_parts) + 1]
        self.azimuth, self.slope = view.angles(u, v)
        size = np.array(sizes)
        self.stops = np.cumsum(size)
        self.starts = self.stops - size
        self.edge = np.repeat(np.arange(len(sizes)), size)
        self.inside = self.outer != OUTSIDE
        self.cut = self._count(~self.inside)
        self.across = np.where(self.edge % 4 < 2, u, v)
        middle = self.starts + size // 2
        au, av, su, sv = view.resolution(u[middle], v[middle])
        # Ends of rows are known along u, ends of columns along v.
        along_u = np.arange(len(sizes)) % 4 < 2
        self.azimuth_pixel = np.where(along_u, au, av)
        self.slope_pixel = np.where(along_u, su, sv)
        self._assign(uprights, self.azimuth[middle].tolist(), self.slope[middle].tolist())

    def _assign(self, uprights: list[bool], azimuth: list[float], slope: list[float]) -> None:
        """Tell sides and rims apart by the azimuth and the slope of their middles."""
        self.left: list[int] = []
        self.right: list[int] = []
        self.bottom: list[int] = []
        self.top: list[int] = []
        for k, upright in enumerate(uprights):
            side, rim = (4 * k, 4 * k + 2) if upright else (4 * k + 2, 4 * k)
            leftwards = azimuth[side] >= azimuth[side + 1]
            self.left.append(side if leftwards else side + 1)
            self.right.append(side + 1 if leftwards else side)
            upwards = slope[rim + 1] >= slope[rim]
            self.bottom.append(rim if upwards else rim + 1)
            self.top.append(rim + 1 if upwards else rim)

    def sides(self, edge_sigma: float) -> list[Side]:
        """Every edge taken for a side; only those of `left` and `right` mean anything."""
        edge, starts, last = self.edge, self.starts, self.stops - 1
        sign = np.ones(len(starts))
        sign[self.right] = -1.0
        outwards = self.azimuth * sign[edge]
        free = self.outer == 0
        bottom = np.minimum.reduceat(self.slope, starts)
        top = np.maximum.reduceat(self.slope, starts)
        low = self.slope <= (bottom + LOW_SHARE * (top - bottom))[edge]
        covered = low & ~free & self.inside
        hidden = 2 * self._count(covered) > self._count(low)
        # The side is the median of the free points near the outermost of them.
        candidate = np.where(free, outwards, NOWHERE)
        ranked = candidate[np.lexsort((candidate, edge))]
        outermost = ranked[last - self._count(free) // OUTLIERS]
        # Where a thing reaches furthest next to something else, it goes on behind it.
        furthest = np.maximum.reduceat(outwards, starts)
        trusted = furthest <= outermost + MAX_OVERHANG * self.azimuth_pixel
        chosen = candidate >= (outermost - ENVELOPE * self.azimuth_pixel)[edge]
        n = self._count(chosen)
        trusted &= CUT * n >= self.cut
        median = 0.5 * (ranked[last - (n - 1) // 2] + ranked[last - n // 2])
        azimuth = sign * np.where(trusted, median, furthest)
        bottom = np.minimum.reduceat(np.where(chosen, self.slope, np.inf), starts)
        top = np.maximum.reduceat(np.where(chosen, self.slope, -np.inf), starts)
        sigma = edge_sigma * self.azimuth_pixel
        lowest = np.minimum.reduceat(np.where(chosen, self.across, np.inf), starts)
        highest = np.maximum.reduceat(np.where(chosen, self.across, -np.inf), starts)
        count = independent(np.maximum(n, 1), np.maximum(highest - lowest, 0.0))
        columns = (azimuth, sigma, count, bottom, top, trusted, hidden)
        return [Side(*row) for row in zip(*(c.tolist() for c in columns), strict=True)]

    def rims(self, sides: Sequence[Side], edge_sigma: float) -> list[Rim]:
        """Every edge taken for a rim, without the ends, where it may run along a side."""
        left = np.array([sides[i].azimuth for i in self.left])
        right = np.array([sides[i].azimuth for i in self.right])
        pixel = self.azimuth_pixel[self.left]
        margin = np.maximum(END_SHARE * (left - right), END_PIXELS * pixel)
        blob = self.edge // 4
        inner = (
            (self.azimuth > (right + margin)[blob])
            & (self.azimuth < (left - margin)[blob])
            & self.inside
        )
        inner &= (CUT * self._count(inner) >= self.cut)[self.edge]
        stops = np.cumsum(self._count(inner)).tolist()
        azimuth, slope, outer = self.azimuth[inner], self.slope[inner], self.outer[inner]
        sigma = (edge_sigma * self.slope_pixel).tolist()
        return [
            Rim(azimuth[a:b], slope[a:b], outer[a:b], sigma[i])
            for i, (a, b) in enumerate(zip([0, *stops[:-1]], stops, strict=True))
        ]

    def _count(self, points: NDArray[np.bool_]) -> NDArray[np.intp]:
        """Number of `points` of each edge."""
        return np.bincount(self.edge[points], minlength=len(self.starts))
