"""A camera at a pose: pixels become azimuths and slopes in the robot frame.

Seen from the camera, a vertical line has one azimuth whatever the head does, and a
horizontal plane gives every slope (rise over horizontal run) one distance. Edges of
upright cylinders are therefore measured in (azimuth, slope) and not in pixels.
"""

from math import atan2, cos, pi, sin

import numpy as np

from vision.camera import CameraPose, PinholeCamera


class View:
    """Maps pixels of one image to directions in the robot frame R.

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
        # The right axis is level but for roll, so it gives the heading even when the
        # camera looks straight down.
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
