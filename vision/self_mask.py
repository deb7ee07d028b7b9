"""Self mask: pixels in which the robot sees its own body.

The arms are visible when the head points to the side and down. They have no colour class, so the
foot of an obstacle behind an arm would seem to end there and the obstacle would be located too
far away. Pixels of the self mask are treated as outside the image.
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
    """Bounding volume of a limb: the convex hull of spheres fixed in the robot frame R.

    Attributes:
        centres: of the spheres (n, 3) [m].
        radii: of the spheres (n,) [m], including the motion of the limb.
    """

    centres: Array
    radii: Array

    def outline(self, camera: PinholeCamera, pose: CameraPose) -> Array:
        """Return image points whose convex hull contains the part (n, 2) [pixel].

        Empty if the part is behind the camera, outside the image or around the camera.
        """
        middle = np.array([0.5 * camera.width, 0.5 * camera.height, camera.focal])
        position, rotation = map(np.ascontiguousarray, (pose.position, pose.rotation))
        return outline(self.centres, self.radii, position, rotation, middle)


def apply_self_mask(
    parts: Sequence[BodyPart],
    labels: NDArray[np.uint8],
    *,
    camera: PinholeCamera,
    pose: CameraPose,
    label: int,
) -> bool:
    """Set the label of the background that may be the robot's body, in place.

    Args:
        parts: of the body.
        labels: of the image (h, w).
        camera: intrinsics.
        pose: of the camera.
        label: of the self mask.

    Returns:
        Whether the body may be in the image.
    """
    outlines = [points for part in parts if len(points := part.outline(camera, pose))]
    if not outlines:
        return False
    hulls = [cv2.convexHull(np.rint(points).astype(np.int32)) for points in outlines]
    left, top, width, height = cv2.boundingRect(np.concatenate(hulls))
    corner = np.array([max(left, 0), max(top, 0)], np.int32)
    window = labels[corner[1] : top + height, corner[0] : left + width]
    if not window.size:
        return False
    mask = np.zeros(window.shape, np.uint8)
    for hull in hulls:
        cv2.fillConvexPoly(mask, hull - corner, 1)
    mask *= window == 0
    window += label * mask
    return True
