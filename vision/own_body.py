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

Array = NDArray[np.float64]

RIM_POINTS = 12
LEAST_DEPTH = 0.004  # what is nearer to the plane of the camera is drawn at this depth [m]
FAR = 4096.0  # image points farther out are drawn here [pixel]

_ANGLES = 2.0 * np.pi * np.arange(RIM_POINTS) / RIM_POINTS
_SWELL = 1.0 / np.cos(np.pi / RIM_POINTS)  # the polygon contains the circle
_COS, _SIN = _SWELL * np.cos(_ANGLES), _SWELL * np.sin(_ANGLES)


@dataclass(frozen=True, slots=True)
class BodyPart:
    """Convex hull of spheres, fixed in the robot frame R, that contains a limb.

    Attributes:
        centres: of the spheres (n, 3) [m].
        radii: of the spheres (n,) [m], with room for how the limb moves.
    """

    centres: Array
    radii: Array

    def outline(self, camera: PinholeCamera, pose: CameraPose) -> Array | None:
        """Convex polygon in the image that contains the part (k, 2) [pixel].

        None if the part is behind the camera, or the camera within it.
        """
        p = (self.centres - pose.position) @ pose.rotation
        ahead = p[:, 2] > -self.radii
        distance = np.sqrt(np.sum(p * p, axis=1))
        if not ahead.any() or (distance <= self.radii).any():
            return None
        p, r, distance = p[ahead], self.radii[ahead], distance[ahead]
        # The circle in which the camera's rays touch a sphere.
        axis = p / distance[:, None]
        across = np.stack([axis[:, 2], np.zeros(len(p)), -axis[:, 0]], axis=1)
        across /= np.maximum(np.hypot(across[:, 0], across[:, 2]), 1e-9)[:, None]
        other = np.cross(axis, across)
        shrink = np.sqrt(1.0 - (r / distance) ** 2)
        radius = (r * shrink)[:, None, None]
        circle = (p * (shrink**2)[:, None])[:, None] + radius * (
            _COS[:, None] * across[:, None] + _SIN[:, None] * other[:, None]
        )
        points = circle.reshape(-1, 3)
        points[:, 2] = np.maximum(points[:, 2], LEAST_DEPTH)
        return np.clip(camera.project(points), -FAR, FAR)


def hide(
    parts: Sequence[BodyPart],
    labels: NDArray[np.uint8],
    *,
    camera: PinholeCamera,
    pose: CameraPose,
    label: int,
) -> NDArray[np.bool_] | None:
    """Give the background that may be the robot's own body another label, in place.

    Args:
        parts: of the body.
        labels: of the image (h, w).
        camera: intrinsics.
        pose: of the camera.
        label: what the body becomes.

    Returns:
        Which pixels it became (h, w); None if there are none.
    """
    hidden: NDArray[np.uint8] | None = None
    for part in parts:
        outline = part.outline(camera, pose)
        if outline is None:
            continue
        (left, top), (right, bottom) = outline.min(axis=0), outline.max(axis=0)
        if right < 0 or bottom < 0 or left > camera.width or top > camera.height:
            continue
        if hidden is None:
            hidden = np.zeros(labels.shape, np.uint8)
        hull = cv2.convexHull(np.round(outline).astype(np.int32))
        cv2.fillConvexPoly(hidden, hull, 1)
    if hidden is None:
        return None
    hidden[labels != 0] = 0
    mask: NDArray[np.bool_] = hidden.view(np.bool_)
    labels[mask] = label
    return mask
