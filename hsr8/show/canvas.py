"""Drawing of a field from above, in metres."""

from collections.abc import Sequence
from copy import copy
from math import degrees
from typing import Self

import cv2
import numpy as np
from numpy.typing import NDArray

from hsr8.show.image import Color, Image

Array = NDArray[np.float64]
Point = Sequence[float] | Array
Points = Sequence[Point] | Array

# Lengths are those in a world of scale 1.
MARGIN = 0.55  # shown around the field, with the beacons [m]
SUBPIXEL = 4  # bits of a pixel that OpenCV draws with
UNIT = 1 << SUBPIXEL
FAR = 1e5  # limit of coordinates, because OpenCV uses 32-bit numbers [pixel]
BEACON, TOP = 0.09, 0.05  # drawn radii of a beacon and of its upper half [m]


class Canvas:
    """Image of the floor, x of W to the right and y up, the origin in the centre.

    Args:
        field_size: extent of the field along x and y, without the margin [m].
        size: width and height [pixel].
        paper: colour of the ground.
        scale: scale of the world [1].

    Attributes:
        image: (height, width, 3), RGB.
    """

    def __init__(
        self, field_size: Point, size: tuple[int, int], paper: Color, scale: float = 1.0
    ) -> None:
        width, depth = framed(field_size, scale).tolist()
        self._world_scale = scale
        self._scale: float = min(size[0] / width, size[1] / depth)
        self._half = 0.5 * np.array(field_size, dtype=float)
        self._middle = (0.5 * size[0], 0.5 * size[1])
        self.image: Image = np.full((size[1], size[0], 3), paper, dtype=np.uint8)

    def copy(self) -> Self:
        """Return an independent copy."""
        other = copy(self)
        other.image = self.image.copy()
        return other

    def field(self, floor: Color, rim: Color, width: int) -> None:
        """Draw the field with its rim, `width` [pixel] wide."""
        corners = self._half * np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
        self.area(corners, floor)
        self.line(corners, rim, width, closed=True)

    def beacon(self, at: Point, top: Color, bottom: Color) -> None:
        """Draw a beacon: the top half on the bottom half."""
        self.disc(at, BEACON * self._world_scale, bottom)
        self.disc(at, TOP * self._world_scale, top)

    def disc(self, at: Point, radius: float, color: Color) -> None:
        """Draw a filled circle; `radius` in [m]."""
        self._circle(at, radius, color, -1)

    def ring(self, at: Point, radius: float, color: Color, width: int = 1) -> None:
        """Draw a circle, `width` [pixel] wide; `radius` in [m]."""
        self._circle(at, radius, color, width)

    def line(self, points: Points, color: Color, width: int = 1, *, closed: bool = False) -> None:
        """Draw lines between points, back to the first if `closed`, `width` [pixel] wide."""
        pixels = [self._pixels(points)]
        cv2.polylines(self.image, pixels, closed, color, width, cv2.LINE_AA, SUBPIXEL)

    def area(self, points: Points, color: Color, opacity: float = 1.0) -> None:
        """Draw a filled polygon, transparent if `opacity` is less than 1."""
        drawn = self.image.copy() if opacity < 1.0 else self.image
        cv2.fillPoly(drawn, [self._pixels(points)], color, cv2.LINE_AA, SUBPIXEL)
        if opacity < 1.0:
            cv2.addWeighted(drawn, opacity, self.image, 1.0 - opacity, 0.0, dst=self.image)

    def ellipse(
        self, at: Point, half_axes: Point, angle: float, color: Color, width: int = 1
    ) -> None:
        """Draw an ellipse with its first half axis at `angle` [rad] to x, `width` [pixel] wide."""
        lengths = (self._length(half_axes[0]), self._length(half_axes[1]))
        centre, turn = self._pixel(at), -degrees(angle)
        cv2.ellipse(self.image, centre, lengths, turn, 0, 360, color, width, cv2.LINE_AA, SUBPIXEL)

    def arrow(self, tail: Point, head: Point, color: Color) -> None:
        """Draw an arrow from `tail` to `head`."""
        ends = self._pixel(tail), self._pixel(head)
        cv2.arrowedLine(self.image, *ends, color, 2, cv2.LINE_AA, SUBPIXEL, 0.3)

    def pixel(self, at: Point) -> tuple[int, int]:
        """Return column and row of a point."""
        u, v = self._pixel(at)
        return u >> SUBPIXEL, v >> SUBPIXEL

    def _circle(self, at: Point, radius: float, color: Color, width: int) -> None:
        centre, length = self._pixel(at), self._length(radius)
        cv2.circle(self.image, centre, length, color, width, cv2.LINE_AA, SUBPIXEL)

    def _pixels(self, points: Points) -> NDArray[np.int32]:
        """Return pixels with fraction bits (n, 2)."""
        flat = np.asarray(points, float).reshape(-1, 2) * (self._scale, -self._scale)
        clipped = np.clip(flat + self._middle, -FAR, FAR)
        pixels: NDArray[np.int32] = np.round(clipped * UNIT).astype(np.int32)
        return pixels

    def _pixel(self, point: Point) -> tuple[int, int]:
        u, v = self._pixels([point])[0].tolist()
        return u, v

    def _length(self, metres: float) -> int:
        return max(1, round(metres * self._scale * UNIT))


def framed(field_size: Point, scale: float = 1.0) -> Array:
    """Return the extent of a field in a world of some scale with its margin (2,) [m]."""
    extent: Array = np.asarray(field_size, dtype=float) + 2.0 * MARGIN * scale
    return extent
