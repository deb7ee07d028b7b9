"""Dashboard of a video: scene, camera image, belief and gaze."""

from collections.abc import Callable, Collection, Sequence
from math import hypot
from types import SimpleNamespace

import cv2
import numpy as np
from numpy.typing import NDArray

from hsr8.recording import palette
from hsr8.scenario.schema import Scenario
from hsr8.show.image import Color, Image, draw_text, font_size, text_width
from hsr8.show.video.camera_overlay import CameraOverlay
from hsr8.show.video.gaze_panel import GazePanel
from hsr8.show.video.top_down import INK as DARK
from hsr8.show.video.top_down import PAPER, TopDown, pale
from hsr8.world.field.layout import Layout

Array = NDArray[np.float64]
Size = tuple[int, int]

REFERENCE = 720  # image height to which the lengths below apply [pixel]
GAP, BAR, MARGIN, PANEL = 4, 54, 14, 270  # [pixel]
VALUE, NAME, TITLE, LEGEND = 20, 13, 14, 13  # font sizes [pixel]
FRAME, BAND = (18, 19, 22), (28, 30, 34)
INK, FAINT, ALARM = (238, 239, 241), (150, 155, 164), (255, 130, 90)
MIN_PANEL = 120  # width of a legible gaze map [pixel]
CORNERS = "corners: chosen view"
MIN_NAMED = 33  # height of a band with room for names above its values [pixel]

HEIGHT = 0.1  # fraction of the image drawn into
MARK = 3  # width of an event [pixel]
AHEAD, DONE = (62, 65, 71), (138, 142, 150)
MARKS: dict[str, Color] = {  # colour by kind of event; later kinds cover earlier ones
    "via_point": (240, 180, 60),
    "goal": (76, 200, 110),
    "push": (230, 70, 130),
    "fault": (120, 170, 230),
    "lost": (150, 110, 220),
    "collision": (240, 120, 30),
    "fall": (230, 40, 40),
}


def draw_timeline(
    image: Image, span: tuple[float, float], time: float, events: Sequence[tuple[float, str]]
) -> None:
    """Draw a timeline over the lowest rows of `image` (height, width, 3).

    Args:
        image: image to draw into.
        span: simulated time of the first and the last image of the video [s].
        time: simulated time of this image [s].
        events: time [s] and kind of each event so far.
    """
    height, width, _ = image.shape
    length = max(span[1] - span[0], 1e-9)

    def column(when: float) -> int:
        position: int = round((when - span[0]) / length * width)
        return position

    strip = image[-max(2, round(HEIGHT * height)) :]
    strip[:] = AHEAD
    strip[:, : column(time)] = DONE
    for kind, color in MARKS.items():
        for when, of_kind in events:
            if of_kind == kind and when >= span[0]:
                middle = column(when)
                strip[:, max(0, middle - MARK // 2) : middle + MARK // 2 + 1] = color


STRONG = palette.LABELS["red"]
Mark = Callable[[Image, tuple[int, int], int], None]
"""Draws the symbol of an entry at a pixel with a radius [pixel]."""


def _disc(fill: Color, rim: Color) -> Mark:
    def draw(image: Image, at: tuple[int, int], radius: int) -> None:
        cv2.circle(image, at, radius, fill, -1, cv2.LINE_AA)
        cv2.circle(image, at, radius, rim, 1, cv2.LINE_AA)

    return draw


def _ring(color: Color) -> Mark:
    def draw(image: Image, at: tuple[int, int], radius: int) -> None:
        cv2.circle(image, at, radius, color, 1, cv2.LINE_AA)

    return draw


def _square(color: Color) -> Mark:
    def draw(image: Image, at: tuple[int, int], radius: int) -> None:
        (u, v), r = at, radius
        cv2.rectangle(image, (u - r, v - r), (u + r, v + r), color, -1)

    return draw


def _bar(color: Color) -> Mark:
    def draw(image: Image, at: tuple[int, int], radius: int) -> None:
        (u, v), r = at, radius
        cv2.rectangle(image, (u - MARK // 2, v - r), (u + MARK // 2, v + r), color, -1)

    return draw


def _nothing(image: Image, at: tuple[int, int], radius: int) -> None:
    """Draw no symbol."""


Entry = tuple[str, Mark]
"""Text and symbol of an entry of the legend."""
BELIEF: tuple[Entry, ...] = (
    ("believed", _disc(STRONG, STRONG)),
    ("out of view", _disc(pale(STRONG), STRONG)),
    ("true", _ring(DARK)),
    ("2σ, velocity", _ring(palette.BELIEF)),
    ("via points", _disc(palette.TARGET, palette.TARGET)),
    ("view", _square(palette.VIEW)),
)
COLUMNS = 3  # of the legend
LINE = 1.7  # height of a row relative to the letters [1]


def legend(kinds: Collection[str]) -> list[Entry]:
    """Return the entries of the belief, and of the marks of the kinds of events on the time bar."""
    marks = [
        (kind.replace("_", " "), _bar(color)) for kind, color in MARKS.items() if kind in kinds
    ]
    return [*BELIEF, ("on the time bar:", _nothing), *marks] if marks else [*BELIEF]


def legend_height(entries: Sequence[Entry], letters: int) -> int:
    """Return the height of a legend in letters of a font size [pixel]."""
    return -(-len(entries) // COLUMNS) * round(LINE * letters) + letters // 2


def draw_legend(image: Image, entries: Sequence[Entry], letters: int) -> None:
    """Draw a legend, in letters of a font size [pixel], into `image` (height, width, 3)."""
    radius = max(2, round(0.36 * letters))
    for k, (text, mark) in enumerate(entries):
        row, column = divmod(k, COLUMNS)
        base = row * round(LINE * letters) + letters
        left = column * (image.shape[1] // COLUMNS) + letters
        mark(image, (left, base - round(0.38 * letters)), radius)
        draw_text(image, (left + letters, base), text, DARK, letters)


class Dashboard:
    """Composition of the images of one video.

    Args:
        layout: layout of the run's world.
        scenario: scenario of the run.
        span: simulated time of the first and the last image [s].
        size: width and height, both even [pixel].
        speed: simulated seconds per second of video.
        kinds: kinds of the events of the run, whose marks the legend names.

    Attributes:
        scene_size, camera_size: sizes of the images to compose [pixel].
    """

    def __init__(
        self,
        layout: Layout,
        scenario: Scenario,
        span: tuple[float, float],
        size: Size,
        speed: float,
        *,
        kinds: Collection[str],
    ) -> None:
        width, height = size
        self._unit = unit = height / REFERENCE
        self._size, self._speed = size, speed
        self._vias = (
            None if layout.endless else max(0, len(layout.waypoints) - 1)
        )  # without the goal
        gap, self._bar = round(GAP * unit), max(16, round(BAR * unit))
        side = width // 3
        camera = scenario.camera
        camera_height = min(side * camera.height // camera.width, height // 2)
        self.scene_size: Size = (width - side - gap, height - self._bar)
        self.camera_size: Size = (side, camera_height)
        self._left, self._below = width - side, camera_height + gap
        self._overlay = CameraOverlay(camera.pinhole, self.camera_size)
        self._named = self._bar >= MIN_NAMED
        letters = font_size(LEGEND * unit)
        entries = legend(kinds)
        room = legend_height(entries, letters) if self._named else 0
        self._above = TopDown(layout, (side, height - self._below - room))
        self._span = span
        gaze = scenario.navigation.gaze
        panel = round(PANEL * unit)
        self._panel = GazePanel(max(panel, 64), gaze.max_pan, (gaze.min_tilt, gaze.max_tilt))
        self._with_panel = panel >= MIN_PANEL and panel < self.scene_size[0]
        self._background: Image = np.full((height, width, 3), FRAME, np.uint8)
        if self._named:
            below = self._background[height - room :, self._left :]
            below[:] = PAPER
            draw_legend(below, entries, letters)

    def draw(
        self,
        scene: Image,
        camera: Image,
        frame: SimpleNamespace,
        *,
        time: float,
        movers: Array,
        trail: Array,
        events: Sequence[tuple[float, str]],
        state: str,
    ) -> Image:
        """Return a new image (height, width, 3).

        Args:
            scene: the robot from outside, of `scene_size`.
            camera: image of the head camera at the capture of the frame, of `camera_size`.
            frame: latest camera frame, see `hsr8.show.video.run_images.shown_frames`.
            time: simulated time [s].
            movers: true positions (n, 2) [m].
            trail: true path of the robot so far (m, 2) [m].
            events: time [s] and kind of each event so far.
            state: current situation of the robot.
        """
        image = self._background.copy()
        width, height = self.scene_size
        image[:height, :width] = scene
        part = image[: self.camera_size[1], self._left :]
        part[:] = camera
        self._overlay.draw(part, frame)
        above = self._above.draw(frame, movers, trail)
        image[self._below : self._below + len(above), self._left :] = above
        if self._with_panel:
            margin = round(MARGIN * self._unit)
            corner = margin, height - margin - self._panel.size[1]
            self._panel.draw(image, corner, frame)
        self._draw_titles(image)
        band = image[height:, :width]
        band[:] = BAND
        collisions = sum(kind == "collision" for _, kind in events)
        self._draw_values(band, frame, time, collisions, state)
        draw_timeline(band, self._span, time, events)
        return image

    def _draw_titles(self, image: Image) -> None:
        if not self._named:
            return
        letters, pad = font_size(TITLE * self._unit), round(8 * self._unit)
        column = self._left + pad
        row = self.camera_size[1] - pad
        middle = column + text_width("head camera", letters, strong=True) + 2 * pad
        right = middle + text_width(CORNERS, letters) + pad
        image[row - letters - pad // 2 : row + pad, self._left : right] = BAND
        draw_text(image, (column, row), "head camera", INK, letters, strong=True)
        draw_text(image, (middle, row), CORNERS, palette.VIEW, letters)
        row = self._below + pad + letters
        draw_text(image, (column, row), "belief", BAND, letters, strong=True)

    def _draw_values(
        self, band: Image, frame: SimpleNamespace, time: float, collisions: int, state: str
    ) -> None:
        """Draw a line of values, each under its name."""
        error = hypot(frame.pose[0] - frame.truth[0], frame.pose[1] - frame.truth[1])
        vias = f"{frame.via_points}"
        if self._vias is not None:
            vias = f"{min(frame.via_points, self._vias)} / {self._vias}"
        speed = "time" if self._speed == 1.0 else f"time, {self._speed:g}x"
        numbers = [
            (speed, f"{time:.1f} s"),
            ("via points", vias),
            ("speed", f"{hypot(*frame.velocity[:2]):.2f} m/s"),
            ("pose error", f"{100.0 * error:.1f} cm"),
            ("collisions", f"{collisions}"),
            ("state", state),
        ]
        named = self._named
        letters, names = font_size(VALUE * self._unit), font_size(NAME * self._unit)
        pad = round(MARGIN * self._unit)
        base = round(0.78 * self._bar) if named else (self._bar + letters) // 2 - 2
        step = (band.shape[1] - 2 * pad) / len(numbers)
        for k, (name, value) in enumerate(numbers):
            column = pad + round(k * step)
            alarm = name == "collisions" and collisions > 0
            if text_width(value, letters, strong=True) > step and not named:
                continue
            draw_text(band, (column, base), value, ALARM if alarm else INK, letters, strong=True)
            if named:
                draw_text(band, (column, round(0.36 * self._bar)), name, FAINT, names)
