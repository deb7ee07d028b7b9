"""Self mask: pixels in which the robot sees its own body.

The arms are visible when the head points to the side and down. They have no colour class, so the
foot of an obstacle behind an arm would seem to end there and the obstacle would be located too
far away. Pixels of the self mask are treated as outside the image.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, inf, pi, sin, sqrt

import cv2
import numpy as np
from numpy.typing import NDArray

from compilation import compiled

Array = NDArray[np.float64]
Rows = NDArray[np.record]

RIM_POINTS = 12
MIN_DEPTH = 0.004  # points closer to the plane of the camera are clipped to this depth [m]
FAR = 4096.0  # limit of the image coordinates [pixel]
SWELL = 1.0 / cos(pi / RIM_POINTS)  # circumscribed polygon / circle


@dataclass(frozen=True, slots=True)
class BodyPart:
    """Bounding volume of a limb: the convex hull of spheres fixed in the robot frame R.

    Attributes:
        centres: centres of the spheres (n, 3) [m].
        radii: radii of the spheres (n,) [m], including the motion of the limb.
    """

    centres: Array
    radii: Array


def apply_self_mask(
    parts: Sequence[BodyPart], labels: NDArray[np.uint8], view: Rows, label: int
) -> bool:
    """Set the label of the background that may be the robot's body, in place.

    Args:
        parts: parts of the body.
        labels: labels of the image (h, w).
        view: camera of the image, a record of type `View` (1,).
        label: label of the self mask.

    Returns:
        Whether the body may be in the image.
    """
    outlines = (silhouette(part.centres, part.radii, view) for part in parts)
    hulls = [cv2.convexHull(np.rint(p).astype(np.int32)) for p in outlines if len(p)]
    if not hulls:
        return False
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


@compiled
def silhouette(centres: Array, radii: Array, views: Rows) -> Array:
    """Return points whose convex hull contains the image of spheres (12 n, 2) [pixel].

    Every sphere gives a polygon around its silhouette circle. Spheres behind the camera give no
    points. There are no points at all if the camera is inside a sphere, or if all points are
    outside the image on one side.

    Args:
        centres: centres of the spheres (n, 3) [m].
        radii: radii of the spheres (n,) [m].
        views: camera of the image, a record of type `View` (1,).
    """
    position, rotation = views[0].position, views[0].rotation
    middle, focal = views[0].middle, views[0].focal
    points = np.empty((RIM_POINTS * len(centres), 2))
    n = 0
    low_u, high_u, low_v, high_v = inf, -inf, inf, -inf
    p = np.empty(3)
    for i in range(len(centres)):
        r = radii[i]
        for j in range(3):
            p[j] = 0.0
            for k in range(3):
                p[j] += (centres[i, k] - position[k]) * rotation[k, j]
        distance = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2])
        if distance <= r:
            return points[:0]
        if p[2] <= -r:
            continue
        shrink = 1.0 - (r / distance) * (r / distance)
        radius = SWELL * r * sqrt(shrink)
        # Two axes perpendicular to the direction of the sphere, (x, y, z).
        x, y, z = p[0] / distance, p[1] / distance, p[2] / distance
        level = max(sqrt(z * z + x * x), 1e-9)
        u, w = z / level, -x / level
        for k in range(RIM_POINTS):
            angle = 2.0 * pi * k / RIM_POINTS
            c, s = radius * cos(angle), radius * sin(angle)
            X = p[0] * shrink + c * u + s * y * w
            Y = p[1] * shrink + s * (z * u - x * w)
            Z = max(p[2] * shrink + c * w - s * y * u, MIN_DEPTH)
            u_image = min(max(middle[0] + focal * X / Z, -FAR), FAR)
            v_image = min(max(middle[1] + focal * Y / Z, -FAR), FAR)
            points[n, 0], points[n, 1] = u_image, v_image
            low_u, high_u = min(low_u, u_image), max(high_u, u_image)
            low_v, high_v = min(low_v, v_image), max(high_v, v_image)
            n += 1
    outside = high_u < 0.0 or high_v < 0.0 or low_u > 2.0 * middle[0] or low_v > 2.0 * middle[1]
    return points[:0] if outside else points[:n]
