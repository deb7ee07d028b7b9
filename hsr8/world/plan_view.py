"""A world seen from above, as a picture for people."""

from itertools import pairwise

import cv2
import numpy as np
from numpy.typing import NDArray

from hsr8.world.layout import Layout
from hsr8.world.motion import Circle, Line, Shuttle
from vision.colour import COLOUR_CLASSES

Image = NDArray[np.uint8]

MARGIN = 0.55  # drawn beyond the rim [m]
SHIFT = 3  # sub-pixel bits of OpenCV's drawing
INK = (60, 58, 55)
PAPER = (246, 246, 244)
FLOOR = (226, 225, 221)
WHITE = (255, 255, 255)
ROUTE = (235, 125, 20)


class PlanView:
    """Draws a layout, x of W to the right and y up.

    Args:
        layout: to draw.
        size: of the longer side of the picture [pixel].
    """

    def __init__(self, layout: Layout, size: int = 900) -> None:
        self._layout = layout
        extent = np.asarray(layout.field_size) + 2.0 * MARGIN
        self._scale = size / float(extent.max())
        self._middle = 0.5 * extent * self._scale
        width, height = (np.ceil(extent * self._scale)).astype(int).tolist()
        self._image = np.full((height, width, 3), PAPER, dtype=np.uint8)

    def draw(self) -> Image:
        """Picture (height, width, 3), RGB."""
        self._field()
        self._route()
        for obstacle in self._layout.obstacles:
            if obstacle.motion is not None:
                self._lane(obstacle.motion)
        for i, obstacle in enumerate(self._layout.obstacles):
            self._disc(obstacle.position, obstacle.radius, _rgb(obstacle.colour))
            if obstacle.motion is not None:
                self._arrow(obstacle.position, obstacle.motion.velocity(0.0))
            self._text(obstacle.position, str(i), WHITE, centred=True)
        for beacon in self._layout.beacons:
            self._disc(beacon.position, beacon.radius + 0.03, _rgb(beacon.bottom))
            self._disc(beacon.position, beacon.radius, _rgb(beacon.top))
        self._robot()
        return self._image

    def _field(self) -> None:
        half = 0.5 * np.asarray(self._layout.field_size)
        corners = self._pixel(-half * (1, -1)), self._pixel(half * (1, -1))
        cv2.rectangle(self._image, *corners, FLOOR, -1, cv2.LINE_AA, SHIFT)
        cv2.rectangle(self._image, *corners, INK, 2, cv2.LINE_AA, SHIFT)

    def _route(self) -> None:
        places = [np.asarray(self._layout.start[:2]), *self._layout.waypoints]
        colour = ROUTE if len(places) <= 12 else tuple((np.add(ROUTE, FLOOR) // 2).tolist())
        for a, b in pairwise(places):
            self._line(a, b, colour, 1)
        last = len(places) - 1
        for k, place in enumerate(places[1:], start=1):
            if k == last and not self._layout.endless:
                self._ring(place, 0.10, ROUTE)
                if self._layout.goal_heading is not None:
                    heading = self._layout.goal_heading
                    self._arrow(place, (0.12 * np.cos(heading), 0.12 * np.sin(heading)), ROUTE)
            self._disc(place, 0.035, ROUTE)
            if last <= 12:
                self._text(place, str(k), ROUTE)

    def _lane(self, law: object) -> None:
        if isinstance(law, Shuttle):
            self._line(np.asarray(law.start), np.asarray(law.end), INK, 1)
        elif isinstance(law, Line):
            ahead = np.asarray(law.start) + 60.0 * np.asarray(law.rate)
            self._line(np.asarray(law.start), ahead, INK, 1)
        elif isinstance(law, Circle):
            self._ring(law.centre, law.radius, INK)

    def _robot(self) -> None:
        x, y, heading = self._layout.start
        self._disc((x, y), 0.12, (250, 250, 250))
        self._ring((x, y), 0.12, INK)
        self._arrow((x, y), (0.1 * np.cos(heading), 0.1 * np.sin(heading)))

    def _pixel(self, point: object) -> tuple[int, int]:
        place = np.asarray(point, dtype=float) * (1.0, -1.0) * self._scale + self._middle
        # A lane may lead far out of the picture; OpenCV takes 32-bit coordinates.
        x, y = np.clip(np.round(place * (1 << SHIFT)), -1e6, 1e6).astype(int).tolist()
        return x, y

    def _length(self, metres: float) -> int:
        return max(1, round(metres * self._scale * (1 << SHIFT)))

    def _disc(self, centre: object, radius: float, colour: tuple[int, ...]) -> None:
        place, size = self._pixel(centre), self._length(radius)
        cv2.circle(self._image, place, size, colour, -1, cv2.LINE_AA, SHIFT)

    def _ring(self, centre: object, radius: float, colour: tuple[int, ...]) -> None:
        place, size = self._pixel(centre), self._length(radius)
        cv2.circle(self._image, place, size, colour, 1, cv2.LINE_AA, SHIFT)

    def _line(self, a: object, b: object, colour: tuple[int, ...], width: int) -> None:
        cv2.line(self._image, self._pixel(a), self._pixel(b), colour, width, cv2.LINE_AA, SHIFT)

    def _arrow(
        self,
        tail: object,
        velocity: object,
        colour: tuple[int, ...] = INK,
    ) -> None:
        """Arrow of two seconds of `velocity`."""
        head = np.asarray(tail, dtype=float) + 2.0 * np.asarray(velocity, dtype=float)
        cv2.arrowedLine(
            self._image, self._pixel(tail), self._pixel(head), colour, 2, cv2.LINE_AA, SHIFT, 0.3
        )

    def _text(
        self, place: object, text: str, colour: tuple[int, ...], centred: bool = False
    ) -> None:
        font, size = cv2.FONT_HERSHEY_SIMPLEX, 0.4
        (width, height), _ = cv2.getTextSize(text, font, size, 1)
        x, y = (v >> SHIFT for v in self._pixel(place))
        corner = (x - width // 2, y + height // 2) if centred else (x + 8, y - 8)
        cv2.putText(self._image, text, corner, font, size, colour, 1, cv2.LINE_AA)


def _rgb(colour: str) -> tuple[int, ...]:
    return tuple(round(255 * channel) for channel in COLOUR_CLASSES[colour].rgb)
