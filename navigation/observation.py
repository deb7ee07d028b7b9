"""Inputs of navigation: odometry and the detections of one camera frame."""

from collections.abc import Sequence
from dataclasses import field
from functools import partial
from math import inf, pi
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from compilation.value import value

Array = NDArray[np.float64]


class Observation(Protocol):
    """Detection of one cylinder in the robot frame R at the capture of a frame."""

    @property
    def kind(self) -> Literal["obstacle", "beacon"]:
        """Kind: obstacle or beacon."""

    @property
    def label(self) -> str:
        """Colour class of an obstacle; name of a beacon, ``top/bottom`` colours."""

    @property
    def distance(self) -> float:
        """Distance of the axis from the origin of R [m]."""

    @property
    def bearing(self) -> float:
        """Bearing of the axis, counter-clockwise from x of R [rad]."""

    @property
    def covariance(self) -> Array:
        """Covariance of (distance, bearing) (2, 2) [m², m rad, rad²]."""

    @property
    def radius(self) -> float:
        """Radius of the cylinder [m]."""

    @property
    def radius_sigma(self) -> float:
        """Standard deviation of `radius` [m]."""

    @property
    def cut(self) -> bool:
        """Whether the blob touches the border of the image or the self mask."""

    @property
    def occluded(self) -> bool:
        """Whether the cylinder is partly occluded."""

    @property
    def by_radius(self) -> Array:
        """Partial derivatives of (distance, bearing) by the radius (2,) [1, rad/m]."""


def bearing_variance(observation: Observation) -> float:
    """Return the variance of the bearing for a known distance [rad²]."""
    (range_variance, covariance), (_, variance) = observation.covariance.tolist()
    return float(variance - covariance * covariance / range_variance)


@compiled
def shadow_at(bearing: float, shadow: Array) -> float:
    """Return the distance from the camera up to which the robot's own body hides the floor [m].

    Args:
        bearing: direction in R [rad].
        shadow: this distance in equal steps of the bearing, from 0 to the left (n,) [m].
    """
    step = round(bearing * len(shadow) / (2.0 * pi))
    return float(shadow[int(step) % len(shadow)])


@value
class CameraModel:
    """Constants of a camera: field of view, and what an image must show of an obstacle.

    Attributes:
        horizontal_fov, vertical_fov: [rad]. A horizontal field of view of pi or more means a
            panoramic camera, which also sees up and down.
        yaw_sigma: standard deviation of the camera's yaw [rad]. All bearings of a frame share
            this error; their covariances include it.
        blind_above: rate of the camera above which its images show nothing [rad/s].
        top: maximum height of the obstacles, whose tops are seen from above; 0: only the foot
            counts [m].
        min_top: their minimum height: an image of that point or the foot shows every obstacle [m].
        seam: height at which the two colours of a beacon meet [m].
        shadow: distance from the camera up to which the robot's own body hides the floor, in equal
            steps of the bearing in R, from 0 to the left (n,) [m].
    """

    horizontal_fov: float
    vertical_fov: float
    yaw_sigma: float = 0.0
    blind_above: float = inf
    top: float = 0.0
    min_top: float = 0.0
    seam: float = 0.30
    shadow: Array = field(default_factory=partial(np.zeros, 1))


@value
class CameraView:
    """Pose of the camera in the robot frame R at the capture of a frame.

    Attributes:
        rotation: R_RC, columns right, down, forward (3, 3).
        position: p_RC (3,) [m].
        pan, tilt: measured direction of the optical axis in the base frame [rad].
        model: constants of the camera.
        pan_rate, tilt_rate: measured rates of the head joints [rad/s].
        blind: whether the camera turned too fast for its image to show anything.
    """

    rotation: Array
    position: Array
    pan: float
    tilt: float
    model: CameraModel
    pan_rate: float = 0.0
    tilt_rate: float = 0.0
    blind: bool = False

    @property
    def horizontal_fov(self) -> float:
        """Horizontal field of view [rad]."""
        return self.model.horizontal_fov

    @property
    def vertical_fov(self) -> float:
        """Vertical field of view [rad]."""
        return self.model.vertical_fov


@value
class Frame:
    """One camera frame as navigation receives it.

    Attributes:
        time: capture time [s].
        odometry: pose of R in the odometry frame at capture (x, y, yaw) (3,) [m, m, rad];
            yaw is unwrapped.
        motion_covariance: covariance of the odometry increment since the previous frame, a
            displacement in R of that frame and a turn (3, 3).
        view: pose of the camera.
        observations: detections.
    """

    time: float
    odometry: Array
    motion_covariance: Array
    view: CameraView
    observations: Sequence[Observation]

    def check_after(self, time: float) -> None:
        """Check that the frame was captured after `time` [s].

        Raises:
            ValueError: if it was not.
        """
        if self.time <= time:
            raise ValueError(
                f"frame: not in the order of capture, got {self.time:.3f} s after {time:.3f} s"
            )
