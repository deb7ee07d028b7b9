"""The robot's own body in the image: what it hides is no edge of what is behind it.

Looking sideways and down, the head sees the robot's own arms. They have no colour, so the
foot of an obstacle behind an arm would seem to end there, and the obstacle to stand
farther away than it does. Pixels that may show the body are therefore treated like what
lies beyond the border of the image.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, hypot, pi, sqrt

import cv2
import numpy as np
from numpy.typing import NDArray

from vision.camera import CameraPose, PinholeCamera

Array = NDArray[np.float64]

RIM_POINTS = 12
LEAST_DEPTH = 0.004  # what is nearer to the plane of the camera is drawn at this depth [m]
FAR = 4096.0  # image points farther out are drawn here [pixel]

_ANGLES = 2.0 * np.pi * np.arange(RIM_POINTS) / RIM_POINTS
_SWELL = 1.0 / cos(pi / RIM_POINTS)  # the polygon contains the circle
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

    def beside(self, camera: PinholeCamera, pose: CameraPose) -> bool:
        """Whether the polygon of `outline` surely lies beside the image, all on one side of it."""
        across, down = 0.5 * camera.width / camera.focal, 0.5 * camera.height / camera.focal
        slopes = (across, across, down, down)
        sides = [0, 1, 2, 3]
        points = ((self.centres - pose.position) @ pose.rotation).tolist()
        for (x, y, z), r in zip(points, self.radii.tolist(), strict=True):
            distance2 = x * x + y * y + z * z
            if z <= -r or distance2 <= r * r:
                continue
            # All points of the polygon lie in this ball, or nearer to the plane of the camera.
            shrink = 1.0 - r * r / distance2
            ball = _SWELL * r * sqrt(shrink)
            beyond = (x, -x, y, -y)
            sides = [
                k
                for k in sides
                if shrink * (beyond[k] - slopes[k] * z) > ball * hypot(1.0, slopes[k])
                and shrink * beyond[k] - ball > LEAST_DEPTH * slopes[k]
            ]
        return bool(sides)

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
        x, y, z = (p / distance[:, None]).T
        level = np.maximum(np.hypot(z, x), 1e-9)
        u, w = z / level, -x / level
        across = np.stack([u, np.zeros(len(p)), w], axis=1)
        other = np.stack([y * w, z * u - x * w, -y * u], axis=1)
        shrink = np.sqrt(1.0 - (r / distance) ** 2)
        radius = (r * shrink)[:, None, None]
        circle = (p * (shrink**2)[:, None])[:, None] + radius * (
            _COS[:, None] * across[:, None] + _SIN[:, None] * other[:, None]
        )
        points = circle.reshape(-1, 3)
        np.maximum(points[:, 2], LEAST_DEPTH, out=points[:, 2])
        return np.minimum(np.maximum(camera.project(points), -FAR), FAR)


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
    boxes = []
    for part in parts:
        outline = None if part.beside(camera, pose) else part.outline(camera, pose)
        if outline is None:
            continue
        (left, top), (right, bottom) = outline.min(axis=0).tolist(), outline.max(axis=0).tolist()
        if right < 0 or bottom < 0 or left > camera.width or top > camera.height:
            continue
        if hidden is None:
            hidden = np.zeros(labels.shape, np.uint8)
        hull = cv2.convexHull(np.round(outline).astype(np.int32))
        cv2.fillConvexPoly(hidden, hull, 1)
        boxes.append((max(0, round(left)), max(0, round(top)), round(right) + 1, round(bottom) + 1))
    if hidden is None:
        return None
    lefts, tops, rights, bottoms = zip(*boxes, strict=True)
    box = slice(min(tops), max(bottoms)), slice(min(lefts), max(rights))
    here, seen = hidden[box], labels[box]
    here[seen != 0] = 0
    seen += label * here
    return hidden.view(np.bool_)
