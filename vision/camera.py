"""Pinhole camera and its pose."""

from dataclasses import dataclass
from math import tan
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class CameraPose(Protocol):
    """Pose of the camera in the robot frame R at capture, and the rates of the head."""

    @property
    def rotation(self) -> Array:
        """R_RC, columns are the camera's right, down and forward axes (3, 3)."""

    @property
    def position(self) -> Array:
        """Position p_RC (3,) [m]; z is the height above the floor."""

    @property
    def pan_rate(self) -> float:
        """Measured pan rate [rad/s]."""

    @property
    def tilt_rate(self) -> float:
        """Measured tilt rate [rad/s]."""


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
