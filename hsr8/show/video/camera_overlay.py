"""Overlay of a camera image: detections and the commanded gaze."""

from collections.abc import Sequence
from itertools import product
from math import cos, sin
from types import SimpleNamespace

import cv2
import numpy as np
from numpy.typing import NDArray

from hsr8.recording import palette
from hsr8.show.image import Color, Image, draw_text, font_size, text_width
from vision.camera import PinholeCamera

Array = NDArray[np.float64]
Rectangle = tuple[float, float, float, float]  # left, top, right, bottom [pixel]

SUBPIXEL = 3  # bits of a pixel that OpenCV draws with
WINDOW = 0.36  # half side of the gaze window, a fraction of the field of view
CORNER = 0.30  # length of the drawn corners, a fraction of the sides
MIN_COSINE = 0.1  # of a drawn direction to the optical axis
TAG = (24, 26, 30)


class CameraOverlay:
    """Overlay of the images of one camera.

    Args:
        camera: intrinsics of the camera of vision.
        size: width and height of the drawn images, which show the same height [pixel].
    """

    def __init__(self, camera: PinholeCamera, size: tuple[int, int]) -> None:
        self._camera, self._size = camera, size
        self._scale = size[1] / camera.height
        self._focal = self._scale * camera.focal
        self._half_fov = 0.5 * np.array([camera.horizontal_fov, camera.vertical_fov])
        self._letters = font_size(size[1] / 26)

    def draw(self, image: Image, frame: SimpleNamespace) -> None:
        """Draw the detections and the gaze of a frame over `image` (height, width, 3)."""
        near_first = sorted(frame.detections, key=lambda blob: blob.distance)
        for blob in reversed(near_first):
            self._draw_box(image, blob)
        tags: list[Rectangle] = []
        for number, blob in enumerate(near_first):
            self._draw_tag(image, blob, tags, near_first[:number])
        self._draw_window(image, frame.head, frame.gaze)

    def _box(self, blob: SimpleNamespace) -> Rectangle:
        """Return the box of a detection in the drawn image [pixel]."""
        left, top, right, bottom = blob.box
        edge = 0.5 * (self._size[0] - self._scale * self._camera.width)
        u, v = self._scale * left + edge, self._scale * right + edge
        return u, self._scale * top, v, self._scale * bottom

    def _draw_box(self, image: Image, blob: SimpleNamespace) -> None:
        left, top, right, bottom = self._box(blob)
        corners = np.array([(left, top), (right, top), (right, bottom), (left, bottom)])
        _lines(image, corners, _light(palette.of_label(blob.label)), closed=True)

    def _draw_tag(
        self,
        image: Image,
        blob: SimpleNamespace,
        tags: list[Rectangle],
        nearer: Sequence[SimpleNamespace],
    ) -> None:
        """Draw the distance above the box, or below it, if the space is free."""
        left, top, right, bottom = map(round, self._box(blob))
        boxes = [self._box(other) for other in nearer]
        text, letters = f"{blob.distance:.2f} m", self._letters
        length = text_width(text, letters)
        last = max(2, self._size[0] - length - 4)
        rows = ((top - 4, tags), (bottom + letters + 3, [*tags, *boxes]))
        for (row, taken), start in product(rows, (left, right - length)):
            column = min(max(start, 2), last)
            tag = column - 2, row - letters, column + length + 2, row + 3
            inside = tag[1] >= 0 and tag[3] <= self._size[1]
            if inside and not any(_overlap(tag, other) for other in taken):
                tags.append(tag)
                image[tag[1] : tag[3], max(0, tag[0]) : tag[2]] = TAG
                draw_text(image, (column, row), text, _light(palette.of_label(blob.label)), letters)
                return

    def _draw_window(self, image: Image, gaze: Sequence[float], look: Sequence[float]) -> None:
        """Draw the corners and the centre of a window around the commanded direction."""
        across, up = (2.0 * WINDOW * self._half_fov).tolist()
        for x in (-1.0, 1.0):
            for y in (-1.0, 1.0):
                bend = [(x * (1.0 - CORNER), y), (x, y), (x, y * (1.0 - CORNER))]
                points = [
                    self._pixel(gaze, look[0] - across * a, look[1] + up * b) for a, b in bend
                ]
                _lines(image, points, palette.VIEW)
        middle = self._pixel(gaze, *look)
        if middle is not None:
            arm = 0.02 * self._size[1]
            for step in (np.array([arm, 0.0]), np.array([0.0, arm])):
                _lines(image, [middle - step, middle + step], palette.VIEW)

    def _pixel(self, gaze: Sequence[float], pan: float, tilt: float) -> Array | None:
        """Return the pixel of a direction (2,), None behind the camera."""
        turn = pan - gaze[0]
        ahead, left = cos(tilt) * cos(turn), cos(tilt) * sin(turn)
        forward = cos(gaze[1]) * ahead + sin(gaze[1]) * sin(tilt)
        up = cos(gaze[1]) * sin(tilt) - sin(gaze[1]) * ahead
        if forward < MIN_COSINE:
            return None
        middle = 0.5 * np.array(self._size, float)
        pixel: Array = middle - self._focal / forward * np.array([left, up])
        return pixel


def _lines(
    image: Image,
    points: Array | Sequence[Array | None],
    color: Color,
    *,
    closed: bool = False,
) -> None:
    if any(point is None for point in points):
        return
    pixels = np.round(np.array(points) * (1 << SUBPIXEL)).astype(np.int32)
    # A dark edge separates the lines from a background of the same colour.
    width = max(1, round(image.shape[0] / 240))
    for shade, thickness in ((TAG, width + 2), (color, width)):
        cv2.polylines(image, [pixels], closed, shade, thickness, cv2.LINE_AA, SUBPIXEL)


def _overlap(a: Rectangle, b: Rectangle) -> bool:
    """Return whether two rectangles overlap."""
    return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]


def _light(color: Color) -> Color:
    """Return a lighter colour for a dark background."""
    return tuple((channel + 255) // 2 for channel in color)
