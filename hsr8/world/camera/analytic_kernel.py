"""Projection of cylinders into the image of the analytic camera, compiled.

An eye is a packed camera: position (3) [m], rotation row by row with right, down and forward axes
as columns (9), width, height and focal length of the image [pixel], and whether the camera is
panoramic.
"""

from math import asin, atan2, inf, pi, sqrt

import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from navigation.angles import wrapped

Array = NDArray[np.float64]
Box = tuple[float, float, float, float, bool]

MIN_DEPTH = 0.05  # of a visible point in front of the camera [m]
MIN_VISIBLE = 2.0  # width and height of a visible cylinder inside the border [pixel]
NO_BOX = (0.0, 0.0, 0.0, 0.0, False)
DISTANCE, HIDDEN, LEFT, TOP, RIGHT, BOTTOM, CUT = range(7)  # columns of a view


@compiled
def _panorama_box(x: float, y: float, radius: float, height: float, eye: Array) -> Box:
    """Return the box in a panorama around the forward axis; it contains every direction."""
    distance = sqrt(x * x + y * y)
    half = asin(min(1.0, radius / distance))
    left = wrapped(atan2(y, x) - atan2(eye[8], eye[5]))
    column = eye[12] * (0.5 - left / (2.0 * pi))
    reach = eye[12] * half / (2.0 * pi)
    top = eye[13] * (0.5 - atan2(height - eye[2], distance) / pi)
    bottom = eye[13] * (0.5 - atan2(-eye[2], distance) / pi)
    return column - reach, top, column + reach, bottom, False


@compiled
def _image_box(x: float, y: float, radius: float, height: float, eye: Array) -> Box:
    """Return the box in a pinhole image and whether it is cut; `NO_BOX` if outside."""
    left, top, right, bottom = inf, inf, -inf, -inf
    ratio = radius / sqrt(x * x + y * y)
    for side in (-ratio, ratio):
        X, Y = x - side * y, y + side * x
        for level in (0.0, 0.5, 1.0):
            Z = level * height - eye[2]
            depth = X * eye[5] + Y * eye[8] + Z * eye[11]
            if depth < MIN_DEPTH:
                return NO_BOX
            u = 0.5 * eye[12] + eye[14] * (X * eye[3] + Y * eye[6] + Z * eye[9]) / depth
            v = 0.5 * eye[13] + eye[14] * (X * eye[4] + Y * eye[7] + Z * eye[10]) / depth
            left, right = min(left, u), max(right, u)
            top, bottom = min(top, v), max(bottom, v)
    if (
        right < MIN_VISIBLE
        or left > eye[12] - MIN_VISIBLE
        or bottom < MIN_VISIBLE
        or top > eye[13] - MIN_VISIBLE
    ):
        return NO_BOX
    return left, top, right, bottom, left < 0.0 or top < 0.0 or right > eye[12] or bottom > eye[13]


@compiled
def project(x: float, y: float, radius: float, height: float, beacon: bool, eye: Array) -> Box:
    """Return left, top, right and bottom of a cylinder in the image [pixel], and whether it is cut.

    All are 0 if the cylinder is outside the image.

    Args:
        x: of the axis from the camera [m].
        y: of the axis from the camera [m].
        radius: [m].
        height: [m].
        beacon: whether the cylinder is a beacon, recognised only with both colours in the image.
        eye: packed camera.
    """
    if eye[15] != 0.0:
        left, top, right, bottom, cut = _panorama_box(x, y, radius, height, eye)
    else:
        left, top, right, bottom, cut = _image_box(x, y, radius, height, eye)
        if beacon and (top < 0.0 or bottom > eye[13]):
            return NO_BOX
        if right == 0.0:
            return NO_BOX
    left, top = float(int(max(left, 0.0))), float(int(max(top, 0.0)))
    return left, top, min(eye[12], int(right) + 1.0), min(eye[13], int(bottom) + 1.0), cut


@compiled
def project_all(positions: Array, sizes: Array, beacon: NDArray[np.bool_], eye: Array) -> Array:
    """Return the view of every cylinder, from near to far.

    Args:
        positions: axes of the cylinders in W, sorted by distance from the camera (n, 2) [m].
        sizes: radii and heights (n, 2) [m].
        beacon: whether each cylinder is a beacon (n,).
        eye: packed camera.

    Returns:
        Distance from the camera [m], maximum fraction of the width that one nearer cylinder
        hides, and the box of each (n, 7).
    """
    n = len(positions)
    views, azimuth, half = np.empty((n, 7)), np.empty(n), np.empty(n)
    for i in range(n):
        x, y = positions[i, 0] - eye[0], positions[i, 1] - eye[1]
        distance, radius = sqrt(x * x + y * y), sizes[i, 0]
        views[i] = 0.0
        views[i, DISTANCE] = distance
        half[i] = 0.0
        if distance <= radius:
            continue  # the camera is inside it
        azimuth[i], half[i] = atan2(y, x), asin(radius / distance)
        for j in range(i):
            if half[j] == 0.0:
                continue
            offset = wrapped(azimuth[j] - azimuth[i])
            low, high = max(-half[i], offset - half[j]), min(half[i], offset + half[j])
            views[i, HIDDEN] = max(views[i, HIDDEN], (high - low) / (2.0 * half[i]))
        left, top, right, bottom, cut = project(x, y, radius, sizes[i, 1], beacon[i], eye)
        views[i, LEFT], views[i, TOP], views[i, RIGHT], views[i, BOTTOM] = left, top, right, bottom
        views[i, CUT] = cut
    return views
