"""Outlines: the edges of blobs as azimuths and slopes, and which of them can be trusted.

The sides of an upright cylinder are two vertical lines; its lower and upper edge are
rims. A side pixel whose outer neighbour has another colour may be the edge of whatever
hides the cylinder; it is not used. Below a blob, another colour always belongs to a
nearer thing, which hides the true rim; above it, to a farther one, which does not,
because the camera stands higher than the obstacles.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vision.blob import Blob
from vision.colour import OUTSIDE
from vision.view import View

Array = NDArray[np.float64]

LOW_SHARE = 0.25  # share of a side, from below, that tells whether a nearer thing hides it
ENVELOPE = 1.1  # side pixels within so much of the outermost lie on the side [pixel]
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
    """Lower or upper edge of a blob, where it can be trusted.

    Attributes:
        azimuth: of its points from the heading of the camera (n,) [rad].
        slope: of its points (n,) [1].
        sigma: standard deviation of one slope [1].
        covered: share of the edge next to another colour class.
        neighbour: commonest label among those neighbours, 0 if none.
    """

    azimuth: Array
    slope: Array
    sigma: float
    covered: float
    neighbour: int


@dataclass(frozen=True, slots=True)
class Outline:
    """Edges of one blob.

    Attributes:
        left, right: sides of greater and smaller azimuth.
        bottom, top: rims of smaller and greater slope.
        seam: the points of `bottom` next to another colour class; where two
            colours of a beacon meet, this is the true edge.
    """

    left: Side
    right: Side
    bottom: Rim
    top: Rim
    seam: Rim


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
    chunks: list[tuple[NDArray[np.float64], ...]] = []
    across: list[bool] = []
    sizes = []
    for blob in blobs:
        left, top, right, bottom = blob.box
        columns = np.arange(left, right)
        rows = np.arange(top, bottom)
        first, last = blob.row_extents()
        high, low = blob.column_extents()
        chunks.append((first, rows + 0.5, rows, first - 1))
        chunks.append((last, rows + 0.5, rows, last))
        chunks.append((columns + 0.5, high, high - 1, columns))
        chunks.append((columns + 0.5, low, low, columns))
        sizes += [len(rows), len(rows), len(columns), len(columns)]
        across.append(view.upright(0.5 * (left + right), 0.5 * (top + bottom)))
    u, v, outer_row, outer_column = (
        np.concatenate([chunk[i] for chunk in chunks]) for i in range(4)
    )
    outer = padded[outer_row.astype(np.intp) + 1, outer_column.astype(np.intp) + 1]
    azimuth, slope = view.angles(u, v)
    ends = np.cumsum(sizes)
    middle = ends - (np.asarray(sizes) + 1) // 2
    per_pixel = [(edge_sigma * a).tolist() for a in view.resolution(u[middle], v[middle])]
    ends_list = ends.tolist()

    outlines = []
    for k, upright in enumerate(across):
        edges = []
        for j in range(4 * k, 4 * k + 4):
            part = slice(ends_list[j] - sizes[j], ends_list[j])
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
        outlines.append(
            Outline(
                left=_side(sides[1], +1.0, edge_sigma),
                right=_side(sides[0], -1.0, edge_sigma),
                bottom=_rim(rims[0], rims[0].outer == 0),
                top=_rim(rims[1], rims[1].outer != OUTSIDE),
                seam=_rim(rims[0], (rims[0].outer != 0) & (rims[0].outer != OUTSIDE)),
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
    if not free:
        return Side(sign * max(azimuths), edge.azimuth_sigma, bottom, top, False, hidden)
    outermost = free[-1 - len(free) // OUTLIERS][0]
    limit = outermost - ENVELOPE * edge.azimuth_sigma / edge_sigma
    chosen = [pair for pair in free if pair[0] >= limit]
    n = len(chosen)
    azimuth = 0.5 * (chosen[(n - 1) // 2][0] + chosen[n // 2][0])
    span = [s for _, s in chosen]
    return Side(sign * azimuth, edge.azimuth_sigma, min(span), max(span), True, hidden)


def _rim(edge: _Edge, usable: NDArray[np.bool_]) -> Rim:
    """Points of an edge where `usable`."""
    others = edge.outer[(edge.outer != 0) & (edge.outer != OUTSIDE)]
    return Rim(
        edge.azimuth[usable],
        edge.slope[usable],
        edge.slope_sigma,
        len(others) / len(edge.outer),
        int(np.bincount(others).argmax()) if len(others) else 0,
    )
