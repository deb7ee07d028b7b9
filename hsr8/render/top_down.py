"""The world from above: what is true as outlines, what is believed filled."""

from collections.abc import Sequence
from math import cos, degrees, pi, sin

import cv2
import numpy as np
from numpy.typing import NDArray

from hsr8.recorder import ellipse, palette
from hsr8.recorder.frame_summary import FrameSummary
from hsr8.world.layout import Layout

Array = NDArray[np.float64]
Image = NDArray[np.uint8]

PAPER, FIELD, RIM = (228, 231, 235), (246, 245, 242), (190, 190, 188)
INK, SHADE = (60, 60, 64), (206, 205, 202)
MARGIN = 0.55  # shown around the field, where the beacons stand [m]
SUBPIXEL = 4  # bits of a pixel that OpenCV draws with
UNIT = 1 << SUBPIXEL
VIEW_RANGE = 1.6  # drawn length of the field of view [m]
TRAIL = 40.0  # path drawn behind the robot [s]
ROBOT = ((0.16, 0.0), (-0.09, 0.10), (-0.05, 0.0), (-0.09, -0.10))  # an arrow head [m]
AHEAD = 3  # way points shown
SIGMAS = 2.0


class TopDown:
    """Draws one square map per frame.

    Args:
        layout: of the run's world.
        size: width and height [pixel].
    """

    def __init__(self, layout: Layout, size: tuple[int, int]) -> None:
        self._layout = layout
        self._size = size
        width, depth = layout.field_size
        self._scale = float(min(size[0] / (width + 2 * MARGIN), size[1] / (depth + 2 * MARGIN)))
        self._ground = self._draw_ground()

    def draw(self, frame: FrameSummary, movers: Array, trail: Array) -> Image:
        """The map at one camera frame.

        Args:
            frame: belief and decisions.
            movers: true positions (n, 2) [m].
            trail: true path of the robot so far (m, 2) [m].

        Returns:
            Picture (height, width, 3), RGB.
        """
        image = self._ground.copy()
        self._wedge(image, frame)
        if len(trail) > 1:
            self._line(image, trail, (150, 150, 154), 1)
        for track in frame.tracks:
            self._track(image, track.position, track.radius, track.label, track.visible)
            if track.motion != "static":
                tip = np.add(track.position, 2.0 * np.array(track.velocity))
                self._line(image, np.array([track.position, tip]), palette.BELIEF, 1)
        for obstacle, position in zip(self._layout.movers, movers.tolist(), strict=True):
            self._ring(image, position, obstacle.radius, INK)
        for x, y, radius in frame.virtual_obstacles:
            self._ring(image, (x, y), radius, palette.VIRTUAL)
        self._way_points(image, frame.passed)
        self._line(image, np.array([frame.pose[:2], frame.target]), palette.TARGET, 1)
        self._disc(image, frame.target, 0.05, palette.TARGET)
        self._robot(image, frame.truth, INK, filled=False)
        self._robot(image, frame.pose, palette.BELIEF, filled=True)
        self._pose_ellipse(image, frame)
        return image

    def _draw_ground(self) -> Image:
        image = np.full((self._size[1], self._size[0], 3), PAPER, np.uint8)
        half = 0.5 * np.array(self._layout.field_size)
        corners = [half * (sx, sy) for sx, sy in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        cv2.fillPoly(image, [self._pixels(corners)], FIELD, cv2.LINE_AA, SUBPIXEL)
        cv2.polylines(image, [self._pixels(corners)], True, RIM, 1, cv2.LINE_AA, SUBPIXEL)
        for beacon in self._layout.beacons:
            self._disc(image, beacon.position, 0.09, palette.of_label(beacon.top))
            self._disc(image, beacon.position, 0.045, palette.of_label(beacon.bottom))
        for obstacle in self._layout.static:
            self._disc(image, obstacle.position, obstacle.radius, SHADE)
            self._ring(image, obstacle.position, obstacle.radius, INK)
        return image

    def _way_points(self, image: Image, passed: int) -> None:
        """The next few, numbered; the paper's tour has ninety."""
        points = np.reshape(self._layout.waypoints, (-1, 2)).tolist()
        last = passed + AHEAD if self._layout.endless else min(passed + AHEAD, len(points))
        for number in range(passed, last):
            point = points[number % len(points)]
            self._ring(image, point, 0.05, palette.TARGET)
            u, v = (self._pixels([point])[0] >> SUBPIXEL).tolist()
            place, font = (u + 6, v - 5), cv2.FONT_HERSHEY_SIMPLEX
            cv2.putText(image, str(number + 1), place, font, 0.38, palette.TARGET, 1, cv2.LINE_AA)

    def _pixels(
        self, points: Sequence[Sequence[float]] | Sequence[Array] | Array
    ) -> NDArray[np.int32]:
        """Pixels with fraction bits of points in W (n, 2) [m]."""
        flat = np.asarray(points, float).reshape(-1, 2) * (self._scale, -self._scale)
        flat += (0.5 * self._size[0], 0.5 * self._size[1])
        pixels: NDArray[np.int32] = np.round(flat * UNIT).astype(np.int32)
        return pixels

    def _length(self, metres: float) -> int:
        return round(metres * self._scale * UNIT)

    def _centre(self, point: Sequence[float]) -> tuple[int, int]:
        u, v = self._pixels([point])[0].tolist()
        return u, v

    def _disc(self, image: Image, at: Sequence[float], radius: float, c: palette.Colour) -> None:
        cv2.circle(image, self._centre(at), self._length(radius), c, -1, cv2.LINE_AA, SUBPIXEL)

    def _ring(self, image: Image, at: Sequence[float], radius: float, c: palette.Colour) -> None:
        cv2.circle(image, self._centre(at), self._length(radius), c, 1, cv2.LINE_AA, SUBPIXEL)

    def _line(self, image: Image, points: Array, c: palette.Colour, width: int) -> None:
        cv2.polylines(image, [self._pixels(points)], False, c, width, cv2.LINE_AA, SUBPIXEL)

    def _track(
        self, image: Image, at: Sequence[float], radius: float, label: str, visible: bool
    ) -> None:
        strong = palette.of_label(label)
        # A track out of view is paler.
        red, green, blue = ((c + 2 * 246) // 3 for c in strong)
        self._disc(image, at, radius, strong if visible else (red, green, blue))
        self._ring(image, at, radius, strong)

    def _robot(
        self, image: Image, pose: Sequence[float], c: palette.Colour, *, filled: bool
    ) -> None:
        x, y, yaw = pose
        ca, sa = cos(yaw), sin(yaw)
        outline = self._pixels([(x + ca * u - sa * v, y + sa * u + ca * v) for u, v in ROBOT])
        if filled:
            cv2.fillPoly(image, [outline], c, cv2.LINE_AA, SUBPIXEL)
        else:
            cv2.polylines(image, [outline], True, c, 1, cv2.LINE_AA, SUBPIXEL)

    def _pose_ellipse(self, image: Image, frame: FrameSummary) -> None:
        xx, xy, yy = frame.covariance
        half, direction = ellipse.axes(np.array([[[xx, xy], [xy, yy]]]))
        lengths = (self._length(SIGMAS * half[0, 0]), self._length(SIGMAS * half[0, 1]))
        turn = -degrees(float(direction[0]))
        centre = self._centre(frame.pose[:2])
        cv2.ellipse(image, centre, lengths, turn, 0, 360, palette.BELIEF, 1, cv2.LINE_AA, SUBPIXEL)

    def _wedge(self, image: Image, frame: FrameSummary) -> None:
        """The field of view, a little darker."""
        x, y, yaw = frame.pose
        middle = yaw + frame.gaze[0]
        half = min(0.5 * frame.fov, pi)
        angles = middle + half * np.linspace(-1.0, 1.0, 12)
        rim = np.column_stack([x + VIEW_RANGE * np.cos(angles), y + VIEW_RANGE * np.sin(angles)])
        fan = self._pixels(np.vstack([[x, y], rim]))
        shaded = image.copy()
        cv2.fillPoly(shaded, [fan], palette.VIEW, cv2.LINE_AA, SUBPIXEL)
        cv2.addWeighted(shaded, 0.35, image, 0.65, 0.0, dst=image)
