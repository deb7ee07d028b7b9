"""Camera at a pose: conversion of pixels to azimuth and slope in the robot frame.

A vertical line has one azimuth for every head pose, and on a horizontal plane every slope
(rise over horizontal run) means one distance. Edges of upright cylinders are therefore
measured in (azimuth, slope).

A packed view is an array: half width, half height and focal length of the camera [pixel], the nine
elements of R_RC row by row, and the cosine and the sine of its heading.
"""

from math import atan2, cos, pi, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from vision.camera import CameraPose, PinholeCamera
from vision.parameters import PoseParameters

Array = NDArray[np.float64]

MIN_DEPTH = 1e-3  # of a direction in front of the camera
MIN_RUN = 1e-6  # minimum horizontal part of a ray
EXACT = PoseParameters(0.0, 0.0, 0.0, 0.0)


class View:
    """Mapping from pixels of one image to directions in the robot frame R.

    Args:
        camera: intrinsics of the camera.
        pose: pose of the camera at capture.
        sigma: uncertainty of the pose.
        shutter: exposure time [s].

    Attributes:
        x, y, height: position of the camera in R [m].
        heading: direction of the camera in R [rad].
        errors: standard deviations of tilt, roll and yaw [rad] and of height [m], pan and tilt
            during the exposure [rad].
        packed: see the module.
    """

    def __init__(
        self,
        camera: PinholeCamera,
        pose: CameraPose,
        sigma: PoseParameters = EXACT,
        shutter: float = 0.0,
    ) -> None:
        self.errors = (
            sigma.tilt_sigma,
            sigma.roll_sigma,
            sigma.yaw_sigma,
            sigma.height_sigma,
            shutter * abs(pose.pan_rate),
            shutter * abs(pose.tilt_rate),
        )
        x, y, z = pose.position.tolist()
        self.x: float = x
        self.y: float = y
        self.height: float = z
        R: list[list[float]] = pose.rotation.tolist()
        # The right axis is level up to roll, so it defines the heading even if the camera
        # points straight down.
        self.heading = atan2(R[1][0], R[0][0]) + 0.5 * pi
        self.packed = np.array(
            [
                0.5 * camera.width,
                0.5 * camera.height,
                camera.focal,
                *R[0],
                *R[1],
                *R[2],
                cos(self.heading),
                sin(self.heading),
            ]
        )


@compiled
def angles(view: Array, u: float, v: float) -> tuple[float, float]:
    """Return azimuth from the heading of the camera [rad] and slope [1] of an image point."""
    x, y = (u - view[0]) / view[2], (v - view[1]) / view[2]
    X = view[3] * x + view[4] * y + view[5]
    Y = view[6] * x + view[7] * y + view[8]
    Z = view[9] * x + view[10] * y + view[11]
    forward, left = view[12] * X + view[13] * Y, view[12] * Y - view[13] * X
    return atan2(left, forward), Z / max(sqrt(X * X + Y * Y), MIN_RUN)


@compiled
def level(view: Array, azimuth: float) -> tuple[float, float]:
    """Return the horizontal unit vector (X, Y) of an azimuth from the heading of the camera."""
    c, s = cos(azimuth), sin(azimuth)
    return view[12] * c - view[13] * s, view[13] * c + view[12] * s


@compiled
def project(view: Array, X: float, Y: float, slope: float) -> tuple[float, float, bool]:
    """Return the image point (u, v) of a direction, and whether it is in front of the camera."""
    z = view[5] * X + view[8] * Y + view[11] * slope
    ahead = z > MIN_DEPTH
    scale = view[2] / (z if ahead else 1.0)
    u = view[0] + scale * (view[3] * X + view[6] * Y + view[9] * slope)
    v = view[1] + scale * (view[4] * X + view[7] * Y + view[10] * slope)
    return u, v, ahead


@compiled
def resolution(view: Array, u: float, v: float) -> tuple[float, float, float, float]:
    """Return |d azimuth / du|, |d azimuth / dv| [rad], |d slope / du|, |d slope / dv| [1]."""
    x, y, f = (u - view[0]) / view[2], (v - view[1]) / view[2], view[2]
    X = view[3] * x + view[4] * y + view[5]
    Y = view[6] * x + view[7] * y + view[8]
    Z = view[9] * x + view[10] * y + view[11]
    run2 = max(X * X + Y * Y, MIN_RUN * MIN_RUN)
    run = sqrt(run2)
    slope = Z / run
    return (
        abs((X * view[6] - Y * view[3]) / (run2 * f)),
        abs((X * view[7] - Y * view[4]) / (run2 * f)),
        abs((view[9] / run - slope * (X * view[3] + Y * view[6]) / run2) / f),
        abs((view[10] / run - slope * (X * view[4] + Y * view[7]) / run2) / f),
    )


@compiled
def upright(view: Array, u: float, v: float) -> bool:
    """Return whether vertical lines are closer to columns than to rows at (u, v)."""
    x, y = (u - view[0]) / view[2], (v - view[1]) / view[2]
    return bool(abs(view[10] - y * view[11]) >= abs(view[9] - x * view[11]))
