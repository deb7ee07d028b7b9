"""A camera at a pose: pixels become azimuths and slopes in the robot frame.

Seen from the camera, a vertical line has one azimuth whatever the head does, and a
horizontal plane gives every slope (rise over horizontal run) one distance. Edges of
upright cylinders are therefore measured in (azimuth, slope) and not in pixels.
"""

from math import atan2, cos, pi, sin

import numpy as np
from numpy.typing import NDArray

from vision.camera import CameraPose, PinholeCamera

Array = NDArray[np.float64]

MIN_RUN = 1e-6  # horizontal part of a ray below which its slope is cut off


class View:
    """Maps pixels of one image to directions in the robot frame R.

    Args:
        camera: intrinsics.
        pose: of the camera at capture.
    """

    def __init__(self, camera: PinholeCamera, pose: CameraPose) -> None:
        self.camera = camera
        self.pose = pose
        x, y, z = pose.position.tolist()
        self.x: float = x
        self.y: float = y
        self.height: float = z
        self._R: list[list[float]] = pose.rotation.tolist()
        # The right axis is level but for roll, so it gives the heading even when the
        # camera looks straight down.
        self.heading = atan2(self._R[1][0], self._R[0][0]) + 0.5 * pi
        self.packed = np.array(
            [
                0.5 * camera.width,
                0.5 * camera.height,
                camera.focal,
                *self._R[0],
                *self._R[1],
                *self._R[2],
                cos(self.heading),
                sin(self.heading),
            ]
        )

    def angles(self, u: Array, v: Array) -> tuple[Array, Array]:
        """Azimuth from the heading of the camera [rad] and slope [1] of image points."""
        X, Y, Z = self._directions(u, v)
        forward, left = self._level(X, Y)
        run = np.maximum(np.hypot(X, Y), MIN_RUN)
        return np.arctan2(left, forward), Z / run

    def pixels(self, azimuth: Array, slope: Array) -> tuple[Array, Array, NDArray[np.bool_]]:
        """Image point (u, v) of directions, and whether it lies before the camera."""
        absolute = azimuth + self.heading
        X, Y = np.cos(absolute), np.sin(absolute)
        x, y, z = (
            X * a + Y * b + slope * c
            for a, b, c in zip(self._R[0], self._R[1], self._R[2], strict=True)
        )
        ahead = z > 1e-3
        depth = np.where(ahead, z, 1.0)
        f = self.camera.focal
        return (
            0.5 * self.camera.width + f * x / depth,
            0.5 * self.camera.height + f * y / depth,
            ahead,
        )

    def upright(self, u: float, v: float) -> bool:
        """Whether vertical lines run rather along columns than along rows at (u, v)."""
        up_x, up_y, up_z = self._R[2]
        x = (u - 0.5 * self.camera.width) / self.camera.focal
        y = (v - 0.5 * self.camera.height) / self.camera.focal
        return bool(abs(up_y - y * up_z) >= abs(up_x - x * up_z))

    def resolution(self, u: Array, v: Array) -> tuple[Array, Array, Array, Array]:
        """How much azimuth [rad] and slope [1] change per pixel.

        Returns:
            Magnitudes of d azimuth / du, d azimuth / dv, d slope / du, d slope / dv.
        """
        f = self.camera.focal
        R = self._R
        X, Y, Z = self._directions(u, v)
        run2 = np.maximum(X * X + Y * Y, MIN_RUN**2)
        run = np.sqrt(run2)
        slope = Z / run
        columns = []
        for j in (0, 1):
            azimuth = (X * R[1][j] - Y * R[0][j]) / (run2 * f)
            rise = (R[2][j] / run - slope * (X * R[0][j] + Y * R[1][j]) / run2) / f
            columns.append((np.abs(azimuth), np.abs(rise)))
        return columns[0][0], columns[1][0], columns[0][1], columns[1][1]

    def _directions(self, u: Array, v: Array) -> tuple[Array, Array, Array]:
        """Components of the rays through (u, v) in R."""
        x = (u - 0.5 * self.camera.width) / self.camera.focal
        y = (v - 0.5 * self.camera.height) / self.camera.focal
        a, b, c = self._R
        return (
            a[0] * x + a[1] * y + a[2],
            b[0] * x + b[1] * y + b[2],
            c[0] * x + c[1] * y + c[2],
        )

    def _level(self, X: Array, Y: Array) -> tuple[Array, Array]:
        """Components along the heading of the camera and to its left."""
        c, s = np.cos(self.heading), np.sin(self.heading)
        return c * X + s * Y, c * Y - s * X
