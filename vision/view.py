"""Camera at a pose: conversion of pixels to azimuth and slope in the robot frame.

A vertical line has one azimuth for every head pose, and on a horizontal plane every slope
(rise over horizontal run) means one distance. Edges of upright cylinders are therefore
measured in (azimuth, slope).
"""

from math import atan2, cos, pi, sin

import numpy as np

from vision.camera import CameraPose, PinholeCamera


class View:
    """Mapping from pixels of one image to directions in the robot frame R.

    Args:
        camera: intrinsics.
        pose: of the camera at capture.
    """

    def __init__(self, camera: PinholeCamera, pose: CameraPose) -> None:
        self.pose = pose
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
