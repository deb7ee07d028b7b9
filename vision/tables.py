"""Tables of one image: blobs with their edges, and candidates of cylinders."""

from math import sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from compilation.record import record_type

Array = NDArray[np.float64]
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

SIDE = record_type(
    azimuth=float,
    sigma=float,
    points=float,
    low=float,
    high=float,
    trusted=bool,
    occluded=bool,
)
"""One side edge: azimuth from the heading of the camera, standard deviation of one point of it
[rad], number of independent points averaged; minimum and maximum slope of the visible edge [1];
whether it is an edge of the object, neither of an occluding object nor of the image, and whether it
is partly occluded by a nearer object."""

RIM = record_type(
    first=int,
    last=int,
    sigma=float,
    outer=int,
    height=float,
    half=float,
    middle=float,
)
"""Lower or upper edge of a blob, without its ends and cut parts: first and last (exclusive) of its
points and standard deviation of one slope [1]. Of the rim of a candidate also the outer label of
the points in use or `ANY`, height above the floor [unit], `NEAR` or `FAR`, and the slope of the
middle point [1]."""

BLOB = record_type(
    box=(int, 4),
    label=int,
    first_run=int,
    last_run=int,
    first_extent=int,
    cut=bool,
    azimuth=(float, 2),
    slope=(float, 2),
    sides=(SIDE, 2),
    rims=(RIM, 2),
)
"""Connected component of one colour class.

Box: left, top, right, bottom pixel, right and bottom exclusive. Label of the colour class.
First and last (exclusive) of its runs. First of its extents: first and last (exclusive)
column of each row, then first and last (exclusive) row of each column [pixel]. Whether it touches
the border of the image or the self mask. Minimum and maximum azimuth from the heading of the camera
[rad] and slope [1] of its edges. Left and right side; lower and upper rim."""

CANDIDATE = record_type(
    upper=int,
    lower=int,
    occluded=bool,
    reported=bool,
    sides=(SIDE, 2),
    rims=(RIM, MAX_RIMS),
    rim_count=int,
    height=float,
    height_sigma=float,
    prior=(float, 2),
    cylinder=(float, 3),
    covariance=(float, 3, 3),
    misfit=float,
    outlier_fraction=float,
)
"""Candidate of one cylinder, and its fit.

Upper and lower blob, the same for an obstacle. Whether it is partly occluded, and whether it is
reported. Left and right side; rims from low to high, and their number; maximum height and standard
deviation of its uniform prior, 0 if it is known [unit]; known or typical radius and its standard
deviation [unit]. Fit: azimuth of the axis from the heading of the
camera [rad], horizontal distance from the camera to the axis [m] and radius [m]; their covariance;
sum of squared normalized residuals of the edges [1]; fraction of outliers among the points of the
rims [1]."""


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
        candidate: record of type `CANDIDATE`.
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
