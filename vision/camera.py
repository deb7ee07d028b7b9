"""Pinhole camera and its pose."""

from dataclasses import dataclass
from math import tan

import numpy as np
from numpy.typing import NDArray

from vision.value import value

Array = NDArray[np.float64]


@value
class CameraPose:
    """Pose of the camera in the robot frame R at capture.

    Attributes:
        rotation: R_RC, columns are the camera's right, down and forward axes (3, 3).
        position: p_RC (3,) [m]; z is the height above the floor.
        tilt_sigma: standard deviation of the pitch of the camera [rad].
        roll_sigma: standard deviation of the roll of the camera [rad].
        yaw_sigma: standard deviation of the yaw of the camera [rad].
        height_sigma: standard deviation of its height [m].
        pan_smear: pan of the camera during the exposure (motion blur) [rad].
        tilt_smear: tilt of the camera during the exposure [rad].
    """

    rotation: Array
    position: Array
    tilt_sigma: float = 0.0
    roll_sigma: float = 0.0
    yaw_sigma: float = 0.0
    height_sigma: float = 0.0
    pan_smear: float = 0.0
    tilt_smear: float = 0.0


@dataclass(frozen=True, slots=True)
class PinholeCamera:
    """Ideal pinhole camera with square pixels and central principal point.

    Attributes:
        width, height: size of the image [pixel].
        focal: focal length [pixel].
    """

    width: int
    height: int
    focal: float

    @classmethod
    def from_vertical_fov(cls, width: int, height: int, fov: float) -> "PinholeCamera":
        """Return the camera with a vertical field of view `fov` [rad]."""
        return cls(width, height, 0.5 * height / tan(0.5 * fov))

    @property
    def horizontal_fov(self) -> float:
        """Horizontal field of view [rad]."""
        return 2.0 * float(np.arctan(0.5 * self.width / self.focal))

    @property
    def vertical_fov(self) -> float:
        """Vertical field of view [rad]."""
        return 2.0 * float(np.arctan(0.5 * self.height / self.focal))

    def project(self, points: Array) -> Array:
        """Project points in the camera frame (..., 3) [m] to the image (..., 2) [pixel].

        Pixel (i, j) covers u from i to i + 1 and v from j to j + 1. Points behind the camera
        give NaN.
        """
        p = np.asarray(points, float)
        z = np.where(p[..., 2] > 1e-9, p[..., 2], np.nan)
        u = 0.5 * self.width + self.focal * p[..., 0] / z
        v = 0.5 * self.height + self.focal * p[..., 1] / z
        return np.stack([u, v], axis=-1)
