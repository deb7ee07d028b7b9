"""The robot's own body in the image: what it hides is no edge of what is behind it.

Looking sideways and down, the head sees the robot's own arms. They have no colour, so the
foot of an obstacle behind an arm would seem to end there, and the obstacle to stand
farther away than it does. Pixels that may show the body are therefore treated like what
lies beyond the border of the image.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from vision.camera import CameraPose, PinholeCamera
from vision.self_mask_kernel import outline

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class BodyPart:
    """Convex hull of spheres, fixed in the robot frame R, that contains a limb.

    Attributes:
        centres: of the spheres (n, 3) [m].
        radii: of the spheres (n,) [m], with room for how the limb moves.
    """

    centres: Array
    radii: Array

    def outline(self, camera: PinholeCamera, pose: CameraPose) -> Array:
        """Points of the image whose convex hull contains the part (n, 2) [pixel].

        There are none if the part is behind the camera, beside the image or around the camera.
        """
        middle = np.array([0.5 * camera.width, 0.5 * camera.height, camera.focal])
        position, rotation = map(np.ascontiguousarray, (pose.position, pose.rotation))
        return outline(self.centres, self.radii, position, rotation, middle)


def hide(
    parts: Sequence[BodyPart],
    labels: NDArray[np.uint8],
    *,
    camera: PinholeCamera,
    pose: CameraPose,
    label: int,
) -> bool:
    """Give the background that may be the robot's own body another label, in place.

    Args:
        parts: of the body.
        labels: of the image (h, w).
        camera: intrinsics.
        pose: of the camera.
        label: what the body becomes.

    Returns:
        Whether the body may be in the image.
    """
    outlines = [points for part in parts if len(points := part.outline(camera, pose))]
    if not outlines:
        return False
    hulls = [cv2.convexHull(np.rint(points).astype(np.int32)) for points in outlines]
    left, top, width, height = cv2.boundingRect(np.concatenate(hulls))
    corner = np.array([max(left, 0), max(top, 0)], np.int32)
    seen = labels[corner[1] : top + height, corner[0] : left + width]
    if not seen.size:
        return False
    hidden = np.zeros(seen.shape, np.uint8)
    for hull in hulls:
        cv2.fillConvexPoly(hidden, hull - corner, 1)
    hidden *= seen == 0
    seen += label * hidden
    return True
