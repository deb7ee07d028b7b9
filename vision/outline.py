"""Silhouette edges of blobs in azimuth and slope, and which of them are edges of the object.

The silhouette of an upright cylinder has two vertical sides and a lower and an upper rim. Side
pixels whose outer neighbour has another colour may be edges of an occluding object and are not
used. Below a blob, another colour belongs to a nearer object, which occludes the rim; above a
blob, to a farther object, because the camera is higher than the obstacles.
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
        azimuth: of its points from the heading of the camera (n,) [rad].
        slope: of its points (n,) [1].
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
        blobs: of one image.
        padded: its labels with a border of `OUTSIDE` one pixel wide (h + 2, w + 2).
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
    azimuth, pixel, points, crossed, low, high, trusted, occluded = values
    count = independent(points, crossed)
    return Side(azimuth, edge_sigma * pixel, count, low, high, trusted != 0.0, occluded != 0.0)
