"""Where cylinders lie in the image of a camera without pixels, compiled.

An eye is a packed array here: position of the camera (3) [m], its rotation row by row, columns are
its right, down and forward axes (9), width, height and focal length of its image [pixel], and
whether it sees all around.
"""

from math import asin, atan2, floor, hypot, inf, pi

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Box = tuple[float, float, float, float, bool]

NEAREST = 0.05  # nothing nearer to the plane of the camera is seen [m]
LEAST = 2.0  # nor what shows less than so much at the border [pixel]
NO_BOX = (0.0, 0.0, 0.0, 0.0, False)
DISTANCE, HIDDEN, LEFT, TOP, RIGHT, BOTTOM, CUT = range(7)  # columns of a look


@njit(cache=True)
def _wrapped(angle: float) -> float:
    """The same direction within half a turn of 0 [rad]."""
    return angle - 2.0 * pi * floor(angle / (2.0 * pi) + 0.5)


@njit(cache=True)
def _panorama_box(x: float, y: float, radius: float, height: float, eye: Array) -> Box:
    """Box in a panorama about the camera's forward; nothing is out of it."""
    distance = hypot(x, y)
    half = asin(min(1.0, radius / distance))
    left = _wrapped(atan2(y, x) - atan2(eye[8], eye[5]))
    column = eye[12] * (0.5 - left / (2.0 * pi))
    reach = eye[12] * half / (2.0 * pi)
    top = eye[13] * (0.5 - atan2(height - eye[2], distance) / pi)
    bottom = eye[13] * (0.5 - atan2(-eye[2], distance) / pi)
    return column - reach, top, column + reach, bottom, False


@njit(cache=True)
def _image_box(x: float, y: float, radius: float, height: float, eye: Array) -> Box:
    """Box in the image of a pinhole camera, and whether its border cuts it; `NO_BOX` if outside."""
    left, top, right, bottom = inf, inf, -inf, -inf
    share = radius / hypot(x, y)
    for side in (-share, share):
        X, Y = x - side * y, y + side * x
        for level in (0.0, 0.5, 1.0):
            Z = level * height - eye[2]
            depth = X * eye[5] + Y * eye[8] + Z * eye[11]
            if depth < NEAREST:
                return NO_BOX
            u = 0.5 * eye[12] + eye[14] * (X * eye[3] + Y * eye[6] + Z * eye[9]) / depth
            v = 0.5 * eye[13] + eye[14] * (X * eye[4] + Y * eye[7] + Z * eye[10]) / depth
            left, right = min(left, u), max(right, u)
            top, bottom = min(top, v), max(bottom, v)
    if right < LEAST or left > eye[12] - LEAST or bottom < LEAST or top > eye[13] - LEAST:
        return NO_BOX
    return left, top, right, bottom, left < 0.0 or top < 0.0 or right > eye[12] or bottom > eye[13]


@njit(cache=True)
def box(x: float, y: float, radius: float, height: float, beacon: bool, eye: Array) -> Box:
    """Left, top, right and bottom of a cylinder in the image [pixel], and whether it is cut.

    All are 0 if it is out of the image.

    Args:
        x: of its axis from the camera [m].
        y: of its axis from the camera [m].
        radius: [m].
        height: [m].
        beacon: whether it is a beacon; its two colours name it only when both are seen.
        eye: packed.
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


@njit(cache=True)
def look(places: Array, sizes: Array, beacon: NDArray[np.bool_], eye: Array) -> Array:
    """How every cylinder is seen, from near to far.

    Args:
        places: of the axes of the cylinders in W, sorted by distance from the camera (n, 2) [m].
        sizes: their radii and heights (n, 2) [m].
        beacon: whether they are beacons (n,).
        eye: packed.

    Returns:
        Distance from the camera [m], largest share of its width that one nearer cylinder hides,
        and `box` of each (n, 7).
    """
    n = len(places)
    seen, azimuth, half = np.empty((n, 7)), np.empty(n), np.empty(n)
    for i in range(n):
        x, y = places[i, 0] - eye[0], places[i, 1] - eye[1]
        distance, radius = hypot(x, y), sizes[i, 0]
        seen[i] = 0.0
        seen[i, DISTANCE] = distance
        half[i] = 0.0
        if distance <= radius:
            continue  # the camera is in it
        azimuth[i], half[i] = atan2(y, x), asin(radius / distance)
        for j in range(i):
            if half[j] == 0.0:
                continue
            offset = _wrapped(azimuth[j] - azimuth[i])
            low, high = max(-half[i], offset - half[j]), min(half[i], offset + half[j])
            seen[i, HIDDEN] = max(seen[i, HIDDEN], (high - low) / (2.0 * half[i]))
        left, top, right, bottom, cut = box(x, y, radius, sizes[i, 1], beacon[i], eye)
        seen[i, LEFT], seen[i, TOP], seen[i, RIGHT], seen[i, BOTTOM] = left, top, right, bottom
        seen[i, CUT] = cut
    return seen
