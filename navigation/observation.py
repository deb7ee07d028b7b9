"""What reaches navigation: odometry and what one camera frame showed."""

from dataclasses import field
from functools import partial
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from navigation.value import value

Array = NDArray[np.float64]


@value
class Observation:
    """One cylinder located in the robot frame R at the capture of a frame.

    Attributes:
        kind: obstacle or beacon.
        label: colour class of an obstacle; name of a beacon, ``top/bottom`` colours.
        distance: from the origin of R to the axis [m].
        bearing: counter-clockwise from x of R [rad].
        covariance: of (distance, bearing) (2, 2).
        radius: [m].
        radius_sigma: standard deviation of `radius` [m].
        cut: the blob touches the border of the image or the robot's own body.
        occluded: something hides part of it.
        by_radius: by how much distance and bearing would be greater were the radius known to be
            greater (2,) [1, rad/m].
    """

    kind: Literal["obstacle", "beacon"]
    label: str
    distance: float
    bearing: float
    covariance: Array
    radius: float
    radius_sigma: float
    cut: bool = False
    occluded: bool = False
    by_radius: Array = field(default_factory=partial(np.zeros, 2))


@value
class CameraView:
    """Where the camera looked in the robot frame R when the frame was taken.

    Attributes:
        rotation: R_RC, columns right, down, forward (3, 3).
        position: p_RC (3,) [m].
        pan, tilt: measured head angles [rad].
        horizontal_fov, vertical_fov: [rad].
        yaw_sigma: standard deviation of its direction about the vertical, an error that all
            bearings of the frame have in common and contain in their covariance [rad].
    """

    rotation: Array
    position: Array
    pan: float
    tilt: float
    horizontal_fov: float
    vertical_fov: float
    yaw_sigma: float = 0.0


@value
class Frame:
    """One camera frame as navigation sees it.

    Attributes:
        time: capture time [s].
        odometry: pose of R in the odometry frame at capture (x, y, yaw) (3,) [m, m, rad];
            yaw is unwrapped.
        motion_covariance: of the error of the odometry since the frame before, a displacement
            in R as it was then and a turn (3, 3).
        view: where the camera looked.
        observations: what it recognised.
    """

    time: float
    odometry: Array
    motion_covariance: Array
    view: CameraView
    observations: tuple[Observation, ...]

    def check_after(self, time: float) -> None:
        """Make sure that it was captured after `time` [s].

        Raises:
            ValueError: if it was not.
        """
        if self.time <= time:
            raise ValueError(
                f"frames must come in the order of their capture: {self.time:.3f} s came after "
                f"{time:.3f} s"
            )
