"""A field seen from above: points and lengths in metres become pixels."""

from collections.abc import Sequence
from copy import copy
from math import degrees
from typing import Self

import cv2
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Image = NDArray[np.uint8]
Color = tuple[int, ...]
Point = Sequence[float] | Array
Points = Sequence[Point] | Array

MARGIN = 0.55  # shown around the field, where the beacons stand [m]
SUBPIXEL = 4  # bits of a pixel that OpenCV draws with
UNIT = 1 << SUBPIXEL
FAR = 1e5  # a lane may lead far out of the picture, but OpenCV takes 32-bit numbers [pixel]
BEACON, TOP = 0.09, 0.05  # drawn radii of a beacon and of its upper half [m]


class Canvas:
    """A picture of the floor, x of W to the right and y up, the origin in the middle.

    Args:
        field_size: extent of the field along x and y; it fits, with a margin around [m].
        size: width and height [pixel].
        paper: colour of the ground.

    Attributes:
        image: the picture (height, width, 3), RGB.
    """

    def __init__(self, field_size: Point, size: tuple[int, int], paper: Color) -> None:
        width, depth = framed(field_size).tolist()
        self._scale: float = min(size[0] / width, size[1] / depth)
        self._half = 0.5 * np.array(field_size, dtype=float)
        self._middle = (0.5 * size[0], 0.5 * size[1])
        self.image: Image = np.full((size[1], size[0], 3), paper, dtype=np.uint8)

    def copy(self) -> Self:
        """The same picture on paper of its own."""
        other = copy(self)
        other.image = self.image.copy()
        return other

    def field(self, floor: Color, rim: Color, width: int) -> None:
        """The field with its rim, `width` [pixel] wide."""
        corners = self._half * np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
        self.area(corners, floor)
        self.outline(corners, rim, width)

    def beacon(self, at: Point, top: Color, bottom: Color) -> None:
        """A beacon as it is seen from above: its top on its bottom."""
        self.disc(at, BEACON, bottom)
        self.disc(at, TOP, top)

    def disc(self, at: Point, radius: float, color: Color) -> None:
        """A filled circle; `radius` in [m]."""
        self._circle(at, radius, color, -1)

    def ring(self, at: Point, radius: float, color: Color, width: int = 1) -> None:
        """A circle, `width` [pixel] wide; `radius` in [m]."""
        self._circle(at, radius, color, width)

    def line(self, points: Points, color: Color, width: int = 1) -> None:
        """Strokes from point to point, `width` [pixel] wide."""
        cv2.polylines(
            self.image, [self._pixels(points)], False, color, width, cv2.LINE_AA, SUBPIXEL
        )

    def outline(self, points: Points, color: Color, width: int = 1) -> None:
        """Strokes from point to point and back to the first, `width` [pixel] wide."""
        cv2.polylines(self.image, [self._pixels(points)], True, color, width, cv2.LINE_AA, SUBPIXEL)

    def area(self, points: Points, color: Color, opacity: float = 1.0) -> None:
        """A filled polygon; what is below shines through where `opacity` is less than 1."""
        drawn = self.image.copy() if opacity < 1.0 else self.image
        cv2.fillPoly(drawn, [self._pixels(points)], color, cv2.LINE_AA, SUBPIXEL)
        if opacity < 1.0:
            cv2.addWeighted(drawn, opacity, self.image, 1.0 - opacity, 0.0, dst=self.image)

    def ellipse(
        self, at: Point, half_axes: Point, turn: float, color: Color, width: int = 1
    ) -> None:
        """An ellipse with its first half axis at `turn` [rad] to x, `width` [pixel] wide."""
        lengths = (self._length(half_axes[0]), self._length(half_axes[1]))
        centre, angle = self._pixel(at), -degrees(turn)
        cv2.ellipse(self.image, centre, lengths, angle, 0, 360, color, width, cv2.LINE_AA, SUBPIXEL)

    def arrow(self, tail: Point, head: Point, color: Color) -> None:
        """An arrow from `tail` to `head`."""
        ends = self._pixel(tail), self._pixel(head)
        cv2.arrowedLine(self.image, *ends, color, 2, cv2.LINE_AA, SUBPIXEL, 0.3)

    def text(
        self, at: Point, text: str, color: Color, *, size: float = 0.4, centred: bool = False
    ) -> None:
        """Letters beside a point or, if `centred`, on it."""
        font = cv2.FONT_HERSHEY_SIMPLEX
        (width, height), _ = cv2.getTextSize(text, font, size, 1)
        u, v = self.pixel(at)
        corner = (u - width // 2, v + height // 2) if centred else (u + 7, v - 6)
        cv2.putText(self.image, text, corner, font, size, color, 1, cv2.LINE_AA)

    def pixel(self, at: Point) -> tuple[int, int]:
        """Column and row of a point."""
        u, v = self._pixel(at)
        return u >> SUBPIXEL, v >> SUBPIXEL

    def _circle(self, at: Point, radius: float, color: Color, width: int) -> None:
        place, length = self._pixel(at), self._length(radius)
        cv2.circle(self.image, place, length, color, width, cv2.LINE_AA, SUBPIXEL)

    def _pixels(self, points: Points) -> NDArray[np.int32]:
        """Pixels with fraction bits (n, 2)."""
        flat = np.asarray(points, float).reshape(-1, 2) * (self._scale, -self._scale)
        place = np.clip(flat + self._middle, -FAR, FAR)
        pixels: NDArray[np.int32] = np.round(place * UNIT).astype(np.int32)
        return pixels

    def _pixel(self, point: Point) -> tuple[int, int]:
        u, v = self._pixels([point])[0].tolist()
        return u, v

    def _length(self, metres: float) -> int:
        return max(1, round(metres * self._scale * UNIT))


def framed(field_size: Point) -> Array:
    """Extent of the picture of a field: the field and the margin around it (2,) [m]."""
    extent: Array = np.asarray(field_size, dtype=float) + 2.0 * MARGIN
    return extent
