"""Detection of a cylinder: the output of vision."""

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from compilation.value import value

Array = NDArray[np.float64]


@value
class Detection:
    """One cylinder detected in an image, in the robot frame R at capture.

    Attributes:
        kind: obstacle or beacon.
        label: colour class of an obstacle; ``top/bottom`` colour classes of a beacon.
        bearing: direction of the axis, counter-clockwise from x of R [rad].
        distance: horizontal distance of the axis from the origin of R [m].
        covariance: covariance of (distance, bearing) (2, 2) [m², m rad, rad²].
        radius: radius of the cylinder [m].
        radius_sigma: its standard deviation [m].
        by_radius: partial derivatives of (distance, bearing) with respect to the radius (2,)
            [1, rad/m].
        cut: the blob touches the border of the image or the self mask.
        occluded: the cylinder is partly occluded.
        box: left, top, right, bottom pixel of the blob, right and bottom exclusive.
    """

    kind: Literal["obstacle", "beacon"]
    label: str
    bearing: float
    distance: float
    covariance: Array
    radius: float
    radius_sigma: float
    by_radius: Array
    cut: bool
    occluded: bool
    box: tuple[int, int, int, int]
