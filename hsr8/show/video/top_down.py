"""Map of the world: ground truth in outlines, belief filled."""

from collections.abc import Sequence
from math import cos, pi, sin
from types import SimpleNamespace

import cv2
import numpy as np
from numpy.typing import NDArray

from hsr8.recording import palette
from hsr8.recording.derived import ellipse_axes
from hsr8.show.canvas import Canvas
from hsr8.show.image import Color, Image, draw_text, font_size
from hsr8.world.field.layout import Layout

Array = NDArray[np.float64]

PAPER, FIELD, RIM = (222, 225, 230), (247, 246, 243), (176, 178, 182)
INK, SHADE, PATH = (44, 46, 52), (212, 211, 208), (146, 148, 154)
# Lengths are those in a world of scale 1.
VIEW_RANGE = 1.6  # drawn length of the field of view [m]
VIEW_OPACITY = 0.35
NUMBER = (176, 92, 0)  # colour of the numbers of via points
TRAIL = 40.0  # duration of the drawn path [s]
ROBOT = ((0.16, 0.0), (-0.09, 0.10), (-0.05, 0.0), (-0.09, -0.10))  # arrow head [m]
AHEAD = 3  # via points shown
SIGMAS = 2.0
VELOCITY = 2.0  # prediction time of velocity lines [s]
MAX_SIGMA = 0.5  # of a drawn ellipse [m]
POINT = 0.05  # radius of a via point [m]
OVERSAMPLING = 2  # for smooth small circles
STROKE = 300  # image height per pixel of line width [pixel]


class TopDown:
    """Map of one run.

    Args:
        layout: layout of the run's world.
        size: width and height [pixel].
    """

    def __init__(self, layout: Layout, size: tuple[int, int]) -> None:
        self._layout = layout
        self._size, self._scale = size, layout.scale
        self._width = max(OVERSAMPLING, round(OVERSAMPLING * size[1] / STROKE))
        self._letters = OVERSAMPLING * font_size(size[1] / 27)
        self._ground = Canvas(
            layout.field_size,
            (OVERSAMPLING * size[0], OVERSAMPLING * size[1]),
            PAPER,
            layout.scale,
        )
        self._ground.field(FIELD, RIM, self._width)
        for beacon in layout.beacons:
            top, bottom = palette.of_label(beacon.top), palette.of_label(beacon.bottom)
            self._ground.beacon(beacon.position, top, bottom)
        for obstacle in layout.static:
            self._ground.disc(obstacle.position, obstacle.radius, SHADE)
            self._ground.ring(obstacle.position, obstacle.radius, INK, self._width)

    def draw(self, frame: SimpleNamespace, movers: Array, trail: Array) -> Image:
        """Return the map at one camera frame.

        Args:
            frame: belief and decisions, see `hsr8.show.video.run_images.shown_frames`.
            movers: true positions (n, 2) [m].
            trail: true path of the robot so far (m, 2) [m].

        Returns:
            Image (height, width, 3), RGB.
        """
        canvas, width = self._ground.copy(), self._width
        canvas.area(_view(frame, self._scale), palette.VIEW, VIEW_OPACITY)
        if len(trail) > 1:
            canvas.line(trail, PATH, width)
        for track in frame.tracks:
            self._draw_track(canvas, track)
        for obstacle, position in zip(self._layout.movers, movers.tolist(), strict=True):
            canvas.ring(position, obstacle.radius, INK, width)
        for virtual in frame.virtual_obstacles:
            canvas.ring(virtual.position, virtual.radius, palette.VIRTUAL, width)
        self._draw_via_points(canvas, frame.via_points)
        canvas.line((frame.pose[:2], frame.target), palette.TARGET, width)
        canvas.disc(frame.target, POINT * self._scale, palette.TARGET)
        canvas.area(_robot(frame.pose, self._scale), palette.BELIEF)
        canvas.line(_robot(frame.truth, self._scale), INK, width, closed=True)
        self._draw_covariance(canvas, frame.pose[:2], frame.pose_covariance)
        shown: Image = cv2.resize(canvas.image, self._size, interpolation=cv2.INTER_AREA)
        return shown

    def _draw_via_points(self, canvas: Canvas, passed: int) -> None:
        """Draw the next via points with their numbers, and the goal."""
        points = np.reshape(self._layout.waypoints, (-1, 2)).tolist()
        last = passed + AHEAD if self._layout.endless else min(passed + AHEAD, len(points))
        for number in range(passed, last):
            point = points[number % len(points)]
            canvas.ring(point, POINT * self._scale, palette.TARGET, self._width)
            u, v = canvas.pixel(point)
            corner = (u + self._letters // 2, v - self._letters // 2)
            goal = not self._layout.endless and number == len(points) - 1
            text = "goal" if goal else str(number + 1)
            draw_text(canvas.image, corner, text, NUMBER, self._letters, strong=True)

    def _draw_track(self, canvas: Canvas, track: SimpleNamespace) -> None:
        strong = palette.of_label(track.label)
        canvas.disc(track.position, track.radius, strong if track.visible else pale(strong))
        canvas.ring(track.position, track.radius, strong, self._width)
        if SIGMAS**2 * (track.covariance[0][0] + track.covariance[1][1]) > track.radius**2:
            self._draw_covariance(canvas, track.position, track.covariance)
        if track.motion != "static":
            tip = np.add(track.position, VELOCITY * np.array(track.velocity))
            canvas.line((track.position, tip), palette.BELIEF, self._width)

    def _draw_covariance(
        self, canvas: Canvas, at: Sequence[float], covariance: Sequence[Sequence[float]]
    ) -> None:
        """Draw the position part of a covariance (k, k)."""
        (xx, xy), (_, yy) = covariance[0][:2], covariance[1][:2]
        if xx + yy < (MAX_SIGMA * self._scale) ** 2:
            half, direction = ellipse_axes(np.array([[[xx, xy], [xy, yy]]]))
            canvas.ellipse(at, SIGMAS * half[0], float(direction[0]), palette.BELIEF, self._width)


def pale(color: Color) -> Color:
    """Return the colour of a track that is out of view."""
    return tuple((channel + 2 * 246) // 3 for channel in color)


def _robot(pose: Sequence[float], scale: float) -> list[tuple[float, float]]:
    """Return the outline of the robot in W [m]."""
    x, y, yaw = pose
    c, s = scale * cos(yaw), scale * sin(yaw)
    return [(x + c * u - s * v, y + s * u + c * v) for u, v in ROBOT]


def _view(frame: SimpleNamespace, scale: float) -> Array:
    """Return the outline of the field of view in W [m]."""
    x, y, yaw = frame.pose
    half = min(0.5 * frame.fov[0], pi)
    angles = yaw + frame.head[0] + half * np.linspace(-1.0, 1.0, 12)
    reach = VIEW_RANGE * scale
    rim = np.column_stack([x + reach * np.cos(angles), y + reach * np.sin(angles)])
    return np.vstack([[x, y], rim])
