"""Camera at a pose: conversion of pixels to azimuth and slope in the robot frame.

A vertical line has one azimuth for every head pose, and on a horizontal plane every slope
(rise over horizontal run) means one distance. Edges of upright cylinders are therefore
measured in (azimuth, slope).
"""

from math import atan2, cos, pi, sin, sqrt
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from compilation.record import record_class
from vision.camera import CameraPose, PinholeCamera
from vision.parameters import PoseParameters

Array = NDArray[np.float64]
Rows = NDArray[np.record]

MIN_DEPTH = 1e-3  # of a direction in front of the camera
MIN_RUN = 1e-6  # minimum horizontal part of a ray
EXACT = PoseParameters(0.0, 0.0, 0.0, 0.0)


@record_class
class View:
    """Camera of one image."""

    position: Annotated[Array, 3]  # in R [m]
    rotation: Annotated[Array, 3, 3]  # R_RC, columns right, down, forward
    middle: Annotated[Array, 2]  # of the image (u, v) [pixel]
    focal: float  # focal length [pixel]
    heading: float  # in R [rad]
    ahead: Annotated[Array, 2]  # cosine and sine of the heading
    clearance: float  # height above the floor [unit of length]
    variance: Annotated[Array, 4]  # of tilt, roll, yaw [rad²] and height [unit²]
    smear: Annotated[Array, 2]  # variance of the motion blur by pan and tilt [rad²]


def view_of(
    camera: PinholeCamera,
    pose: CameraPose,
    sigma: PoseParameters = EXACT,
    shutter: float = 0.0,
    unit: float = 1.0,
) -> Rows:
    """Return the camera of one image, a record of type `View` (1,).

    Args:
        camera: intrinsics of the camera.
        pose: pose of the camera at capture.
        sigma: uncertainty of the pose.
        shutter: exposure time [s].
        unit: unit of length of the fit of cylinders [m].
    """
    (right_x, *_), (right_y, *_), _ = pose.rotation.tolist()
    # The right axis is level up to roll, so it defines the heading even if the camera
    # points straight down.
    heading = atan2(right_y, right_x) + 0.5 * pi
    variance = (
        sigma.tilt_sigma**2,
        sigma.roll_sigma**2,
        sigma.yaw_sigma**2,
        (sigma.height_sigma / unit) ** 2,
    )
    # The error of an edge is uniform over the smear.
    smear = tuple((shutter * abs(rate)) ** 2 / 12.0 for rate in (pose.pan_rate, pose.tilt_rate))
    row = (
        pose.position,
        pose.rotation,
        (0.5 * camera.width, 0.5 * camera.height),
        camera.focal,
        heading,
        (cos(heading), sin(heading)),
        float(pose.position[2]) / unit,
        variance,
        smear,
    )
    return np.array([row], View)


@compiled
def angles(view: np.record, u: float, v: float) -> tuple[float, float]:
    """Return azimuth from the heading of the camera [rad] and slope [1] of an image point."""
    R, ahead = view.rotation, view.ahead
    x, y = (u - view.middle[0]) / view.focal, (v - view.middle[1]) / view.focal
    X = R[0, 0] * x + R[0, 1] * y + R[0, 2]
    Y = R[1, 0] * x + R[1, 1] * y + R[1, 2]
    Z = R[2, 0] * x + R[2, 1] * y + R[2, 2]
    forward, left = ahead[0] * X + ahead[1] * Y, ahead[0] * Y - ahead[1] * X
    return atan2(left, forward), Z / max(sqrt(X * X + Y * Y), MIN_RUN)


@compiled
def level(view: np.record, azimuth: float) -> tuple[float, float]:
    """Return the horizontal unit vector (X, Y) of an azimuth from the heading of the camera."""
    ahead, c, s = view.ahead, cos(azimuth), sin(azimuth)
    return ahead[0] * c - ahead[1] * s, ahead[1] * c + ahead[0] * s


@compiled
def project(view: np.record, X: float, Y: float, slope: float) -> tuple[float, float, bool]:
    """Return the image point (u, v) of a direction, and whether it is in front of the camera."""
    R = view.rotation
    z = R[0, 2] * X + R[1, 2] * Y + R[2, 2] * slope
    in_front = z > MIN_DEPTH
    scale = view.focal / (z if in_front else 1.0)
    u = view.middle[0] + scale * (R[0, 0] * X + R[1, 0] * Y + R[2, 0] * slope)
    v = view.middle[1] + scale * (R[0, 1] * X + R[1, 1] * Y + R[2, 1] * slope)
    return u, v, in_front


@compiled
def resolution(view: np.record, u: float, v: float) -> tuple[float, float, float, float]:
    """Return |d azimuth / du|, |d azimuth / dv| [rad], |d slope / du|, |d slope / dv| [1]."""
    R, f = view.rotation, view.focal
    x, y = (u - view.middle[0]) / f, (v - view.middle[1]) / f
    X = R[0, 0] * x + R[0, 1] * y + R[0, 2]
    Y = R[1, 0] * x + R[1, 1] * y + R[1, 2]
    Z = R[2, 0] * x + R[2, 1] * y + R[2, 2]
    run2 = max(X * X + Y * Y, MIN_RUN * MIN_RUN)
    run = sqrt(run2)
    slope = Z / run
    return (
        abs((X * R[1, 0] - Y * R[0, 0]) / (run2 * f)),
        abs((X * R[1, 1] - Y * R[0, 1]) / (run2 * f)),
        abs((R[2, 0] / run - slope * (X * R[0, 0] + Y * R[1, 0]) / run2) / f),
        abs((R[2, 1] / run - slope * (X * R[0, 1] + Y * R[1, 1]) / run2) / f),
    )


@compiled
def upright(view: np.record, u: float, v: float) -> bool:
    """Return whether vertical lines are closer to columns than to rows at (u, v)."""
    x, y = (u - view.middle[0]) / view.focal, (v - view.middle[1]) / view.focal
    R = view.rotation
    return bool(abs(R[2, 1] - y * R[2, 2]) >= abs(R[2, 0] - x * R[2, 2]))
