"""Outlines: the edges of blobs as azimuths and slopes, and which of them can be trusted.

The sides of an upright cylinder are two vertical lines; its lower and upper edge are
rims. A side pixel whose outer neighbour has another colour may be the edge of whatever
hides the cylinder; it is not used. Below a blob, another colour always belongs to a
nearer thing, which hides the true rim; above it, to a farther one, which does not,
because the camera stands higher than the obstacles.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from vision import outline_kernel
from vision.blob import Blob
from vision.cylinder_kernel import independent
from vision.value import value
from vision.view import View

Array = NDArray[np.float64]


@value
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


@value
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
        return self._part(self.outer == 0) if self.covered else self

    def against(self, label: int) -> "Rim":
        """The part next to things of colour class `label`."""
        return self._part(self.outer == label)

    def _part(self, chosen: NDArray[np.bool_]) -> "Rim":
        return Rim(self.azimuth[chosen], self.slope[chosen], self.outer[chosen], self.sigma)


@value
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
    sides, counts, pixels, (azimuth, slope), outer = outline_kernel.trace(
        np.array([blob.box for blob in blobs], np.int32),
        np.concatenate([blob.extents for blob in blobs]),
        padded,
        view.packed,
    )
    outlines = []
    start = 0
    for both, count, pixel in zip(sides.tolist(), counts.tolist(), pixels.tolist(), strict=True):
        left, right = (_side(values, edge_sigma) for values in both)
        middle = start + count[0]
        stop = middle + count[1]
        near, far = slice(start, middle), slice(middle, stop)
        bottom = Rim(azimuth[near], slope[near], outer[near], edge_sigma * pixel[0])
        top = Rim(azimuth[far], slope[far], outer[far], edge_sigma * pixel[1])
        outlines.append(Outline(left, right, bottom, top))
        start = stop
    return outlines


def _side(values: Sequence[float], edge_sigma: float) -> Side:
    azimuth, pixel, points, crossed, low, high, trusted, hidden = values
    own = independent(points, crossed)
    return Side(azimuth, edge_sigma * pixel, own, low, high, trusted != 0.0, hidden != 0.0)
