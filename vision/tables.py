"""Tables of one image: blobs with their edges, and candidates of cylinders."""

from math import sqrt
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from compilation.record import Records, record_class

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Labels = NDArray[np.uint8]
Points = tuple[Array, Array, Labels]
"""Points of rims: azimuth from the heading of the camera (n,) [rad], slope (n,) [1] and label of
the outer neighbour, 0 for the background (n,)."""

OUTSIDE = 255  # label of pixels outside the image or in the self mask
ANY = OUTSIDE  # outer label of a rim next to any colour; rims exclude the border of the image
LEFT, RIGHT = range(2)  # sides
FOOT, HEAD = range(2)  # rims of a blob
NEAR, FAR = 1.0, -1.0  # half of the circle of a rim
MAX_RIMS = 3  # a beacon shows three
HALF_WIDTH = sqrt(3.0)  # of a uniform distribution [standard deviations]


@record_class
class Side:
    """One side edge of a blob."""

    azimuth: float  # from the heading of the camera [rad]
    sigma: float  # standard deviation of one point of it [rad]
    points: float  # number of independent points averaged
    low: float  # minimum slope of the visible edge [1]
    high: float  # maximum slope of the visible edge [1]
    trusted: bool  # an edge of the object, neither of an occluding object nor of the image
    occluded: bool  # partly occluded by a nearer object


@record_class
class Rim:
    """Lower or upper edge of a blob or candidate, without its ends and cut parts."""

    first: int  # of its points
    last: int  # of its points, exclusive
    sigma: float  # standard deviation of one slope [1]
    outer: int  # of a candidate: outer label of the points in use, or `ANY`
    height: float  # of a candidate: above the floor [unit]
    half: float  # of a candidate: `NEAR` or `FAR`
    middle: float  # of a candidate: slope of the middle point [1]


@record_class
class Blob:
    """Connected component of one colour class."""

    box: Annotated[Ints, 4]  # left, top, right, bottom, right and bottom exclusive [pixel]
    label: int  # of the colour class
    first_run: int
    last_run: int  # exclusive
    # First of its extents: first and last (exclusive) column of each row, then first and last
    # (exclusive) row of each column [pixel].
    first_extent: int
    cut: bool  # whether it touches the border of the image or the self mask
    azimuth: Annotated[Array, 2]  # minimum and maximum, from the heading of the camera [rad]
    slope: Annotated[Array, 2]  # minimum and maximum of its edges [1]
    sides: Annotated[Records[Side], 2]  # left and right
    rims: Annotated[Records[Rim], 2]  # lower and upper


@record_class
class Candidate:
    """Candidate of one cylinder, and its fit."""

    upper: int  # blob
    lower: int  # blob, `upper` for an obstacle
    occluded: bool  # partly
    reported: bool
    sides: Annotated[Records[Side], 2]  # left and right
    rims: Annotated[Records[Rim], MAX_RIMS]  # from low to high
    rim_count: int
    height: float  # maximum [unit]
    height_sigma: float  # standard deviation of its uniform prior, 0 if it is known [unit]
    prior: Annotated[Array, 2]  # known or typical radius and its standard deviation [unit]
    # Fit: azimuth of the axis from the heading of the camera [rad], horizontal distance from the
    # camera to the axis [m] and radius [m]; their covariance.
    cylinder: Annotated[Array, 3]
    covariance: Annotated[Array, 3, 3]
    misfit: float  # sum of squared normalized residuals of the edges [1]
    outlier_fraction: float  # of the points of the rims [1]


@compiled
def copy_side(side: np.record, other: np.record) -> None:
    """Copy a side field by field; records that are assigned compile slowly."""
    side.azimuth, side.sigma, side.points = other.azimuth, other.sigma, other.points
    side.low, side.high = other.low, other.high
    side.trusted, side.occluded = other.trusted, other.occluded


@compiled
def set_obstacle(candidate: np.record, p: np.record) -> None:
    """Set height and typical radius of a candidate without rims to those of an obstacle."""
    candidate.height = p.obstacle_height / p.unit
    candidate.height_sigma = p.height_sigma / p.unit
    candidate.prior[0], candidate.prior[1] = p.radius / p.unit, p.radius_sigma / p.unit
    candidate.rim_count = 0


@compiled
def mean_height(candidate: np.record) -> float:
    """Return the mean of the prior of a candidate's height [unit]."""
    return float(candidate.height - HALF_WIDTH * candidate.height_sigma)


@compiled
def count_next_to(rim: np.record, label: int, points: Points) -> int:
    """Return the number of points of a rim next to a label, `ANY` for all."""
    if label == ANY:
        return int(rim.last - rim.first)
    count = 0
    for i in range(rim.first, rim.last):
        count += points[2][i] == label
    return count


@compiled
def add_rim(
    candidate: np.record, rim: np.record, label: int, points: Points, height: float, half: float
) -> None:
    """Add a rim of a blob to a candidate, unless it has no points next to a label.

    Args:
        candidate: record of type `Candidate`.
        rim: rim of a blob.
        label: outer label of the points to use, `ANY` for all.
        points: points of the rims.
        height: height above the floor [unit].
        half: `NEAR` or `FAR`.
    """
    rest = count_next_to(rim, label, points) // 2
    added = candidate.rims[candidate.rim_count]
    for i in range(rim.first, rim.last):
        if label != ANY and points[2][i] != label:
            continue
        if rest == 0:
            added.middle = points[1][i]
            added.first, added.last, added.sigma = rim.first, rim.last, rim.sigma
            added.outer, added.height, added.half = label, height, half
            candidate.rim_count += 1
            break
        rest -= 1
