"""Outlines: the edges of blobs as azimuths and slopes, and which of them can be trusted.

The sides of an upright cylinder are two vertical lines; its lower and upper edge are
rims. A side pixel whose outer neighbour has another colour may be the edge of whatever
hides the cylinder; it is not used. Below a blob, another colour always belongs to a
nearer thing, which hides the true rim; above it, to a farther one, which does not,
because the camera stands higher than the obstacles.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf
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
ENVELOPE = 1.1  # side pixels within so much of the outermost lie on the side [pixel]
MAX_OVERHANG = 2.5  # a side does not lie farther inside what is seen than this [pixel]
OUTLIERS = 8  # one pixel in so many may stick out of a side


@dataclass(frozen=True, slots=True)
class Side:
    """One side edge of a blob.

    Attributes:
        azimuth: from the heading of the camera [rad].
        sigma: its standard deviation [rad].
        low, high: slopes between which the edge is seen [1].
        trusted: it is an edge of the thing and not of what hides it or of the image.
        hidden: a nearer thing covers part of it.
    """

    azimuth: float
    sigma: float
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


@dataclass(frozen=True, slots=True)
class _Edge:
    """One of the four edges of a blob: its points and the labels beyond them."""

    azimuth: Array
    slope: Array
    outer: NDArray[np.uint8]
    azimuth_sigma: float
    slope_sigma: float


def trace(
    blobs: Sequence[Blob], padded: NDArray[np.uint8], view: View, edge_sigma: float
) -> list[Outline]:
    """Outlines of `blobs`.

    Args:
        blobs: of one image.
        padded: its labels with a frame of `OUTSIDE` one pixel wide (h + 2, w + 2).
        view: camera and pose.
        edge_sigma: standard deviation of an edge [pixel].
    """
    if not blobs:
        return []
    u_parts: list[NDArray[Any]] = []
    v_parts: list[NDArray[Any]] = []
    row_parts: list[Index] = []
    column_parts: list[Index] = []
    uprights: list[bool] = []
    sizes = []
    for blob in blobs:
        left, top, right, bottom = blob.box
        columns = np.arange(left, right)
        rows = np.arange(top, bottom)
        first, last = blob.row_extents()
        high, low = blob.column_extents()
        u_parts += [first, last, columns + 0.5, columns + 0.5]
        v_parts += [rows + 0.5, rows + 0.5, high, low]
        row_parts += [rows, rows, high - 1, low]
        column_parts += [first - 1, last, columns, columns]
        sizes += [len(rows), len(rows), len(columns), len(columns)]
        uprights.append(view.upright(0.5 * (left + right), 0.5 * (top + bottom)))
    u, v = np.concatenate(u_parts), np.concatenate(v_parts)
    # The frame shifts pixel (row, column) to (row + 1, column + 1).
    outer = padded[np.concatenate(row_parts) + 1, np.concatenate(column_parts) + 1]
    azimuth, slope = view.angles(u, v)
    stops = np.cumsum(sizes)
    middle = stops - (np.asarray(sizes) + 1) // 2
    per_pixel = [(edge_sigma * a).tolist() for a in view.resolution(u[middle], v[middle])]
    stop = stops.tolist()

    outlines = []
    for k, upright in enumerate(uprights):
        edges = []
        for j in range(4 * k, 4 * k + 4):
            part = slice(stop[j] - sizes[j], stop[j])
            # An edge of rows is known along u, an edge of columns along v.
            vertical = j - 4 * k < 2
            edges.append(
                _Edge(
                    azimuth[part],
                    slope[part],
                    outer[part],
                    per_pixel[0 if vertical else 1][j],
                    per_pixel[2 if vertical else 3][j],
                )
            )
        sides, rims = (edges[:2], edges[2:]) if upright else (edges[2:], edges[:2])
        sides.sort(key=lambda e: float(e.azimuth[len(e.azimuth) // 2]))
        rims.sort(key=lambda e: float(e.slope[len(e.slope) // 2]))
        ends = (_side(sides[1], +1.0, edge_sigma), _side(sides[0], -1.0, edge_sigma))
        outlines.append(
            Outline(
                *ends,
                bottom=_rim(rims[0], *ends, edge_sigma),
                top=_rim(rims[1], *ends, edge_sigma),
            )
        )
    return outlines


def _side(edge: _Edge, sign: float, edge_sigma: float) -> Side:
    """Side towards greater (sign +1) or smaller (-1) azimuth."""
    azimuths = (sign * edge.azimuth).tolist()
    slopes = edge.slope.tolist()
    outer = edge.outer.tolist()
    free = sorted((a, s) for a, s, o in zip(azimuths, slopes, outer, strict=True) if o == 0)
    bottom, top = min(slopes), max(slopes)
    lowest = bottom + LOW_SHARE * (top - bottom)
    low = [o for s, o in zip(slopes, outer, strict=True) if s <= lowest]
    hidden = 2 * sum(o not in (0, OUTSIDE) for o in low) > len(low)
    pixel = edge.azimuth_sigma / edge_sigma
    furthest = max(azimuths)
    outermost = free[-1 - len(free) // OUTLIERS][0] if free else -inf
    if furthest > outermost + MAX_OVERHANG * pixel:
        # Where it reaches furthest, the thing goes on behind something or off the image.
        return Side(sign * furthest, edge.azimuth_sigma, bottom, top, False, hidden)
    limit = outermost - ENVELOPE * pixel
    chosen = [pair for pair in free if pair[0] >= limit]
    n = len(chosen)
    azimuth = 0.5 * (chosen[(n - 1) // 2][0] + chosen[n // 2][0])
    span = [s for _, s in chosen]
    return Side(sign * azimuth, edge.azimuth_sigma, min(span), max(span), True, hidden)


def _rim(edge: _Edge, left: Side, right: Side, edge_sigma: float) -> Rim:
    """Points of an edge; close to the ends it may run along a side: they are left out."""
    pixel = left.sigma / edge_sigma
    margin = max(END_SHARE * (left.azimuth - right.azimuth), END_PIXELS * pixel)
    inner = (
        (edge.azimuth > right.azimuth + margin)
        & (edge.azimuth < left.azimuth - margin)
        & (edge.outer != OUTSIDE)
    )
    return Rim(edge.azimuth[inner], edge.slope[inner], edge.outer[inner], edge.slope_sigma)
