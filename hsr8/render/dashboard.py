"""Dashboard of a video: scene, camera image, belief and gaze."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import hypot
from types import SimpleNamespace

import cv2
import numpy as np
from numpy.typing import NDArray

from hsr8.recorder import palette
from hsr8.render.camera_overlay import CameraOverlay
from hsr8.render.gaze_panel import GazePanel
from hsr8.render.image import Color, Image, draw_text, font_size, text_width
from hsr8.render.top_down import INK as DARK
from hsr8.render.top_down import PAPER, TopDown, pale
from hsr8.scenario.schema import Scenario
from hsr8.world.field.layout import Layout

Array = NDArray[np.float64]
Size = tuple[int, int]

REFERENCE = 720  # image height to which the lengths below apply [pixel]
GAP, BAR, MARGIN, PANEL = 4, 54, 14, 270  # [pixel]
VALUE, NAME, TITLE, LEGEND = 20, 13, 14, 13  # font sizes [pixel]
FRAME, BAND = (18, 19, 22), (28, 30, 34)
INK, FAINT, ALARM = (238, 239, 241), (150, 155, 164), (255, 130, 90)
MIN_PANEL = 120  # width of a legible gaze map [pixel]
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


class Timeline:
    """Timeline of one video.

    Args:
        start, stop: simulated time of the first and the last image [s].
    """

    def __init__(self, start: float, stop: float) -> None:
        self._start, self._length = start, max(stop - start, 1e-9)

    def draw(self, image: Image, time: float, events: Sequence[tuple[float, str]]) -> None:
        """Draw over the lowest rows of `image` (height, width, 3).

        Args:
            image: image to draw into.
            time: simulated time [s].
            events: time [s] and kind of each event so far.
        """
        height, width, _ = image.shape
        strip = image[-max(2, round(HEIGHT * height)) :]
        strip[:] = AHEAD
        strip[:, : self._column(time, width)] = DONE
        for kind, color in MARKS.items():
            for when, of_kind in events:
                if of_kind == kind and when >= self._start:
                    column = self._column(when, width)
                    strip[:, max(0, column - MARK // 2) : column + MARK // 2 + 1] = color

    def _column(self, time: float, width: int) -> int:
        return round((time - self._start) / self._length * width)


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


ENTRIES: tuple[tuple[str, Mark], ...] = (
    ("believed", _disc(STRONG, STRONG)),
    ("out of view", _disc(pale(STRONG), STRONG)),
    ("true", _ring(DARK)),
    ("2σ, velocity", _ring(palette.BELIEF)),
    ("next points", _disc(palette.TARGET, palette.TARGET)),
    ("view", _square(palette.VIEW)),
)
"""Text and symbol of every entry, in rows of three."""
COLUMNS = 3
LINE = 1.7  # height of a row relative to the letters [1]


class Legend:
    """Legend in rows of three entries.

    Args:
        width: width of the image to draw into [pixel].
        letters: font size [pixel].

    Attributes:
        height: height of the rows [pixel].
    """

    def __init__(self, width: int, letters: float) -> None:
        self._letters = font_size(letters)
        self._step = width // COLUMNS
        self._line = round(LINE * self._letters)
        self.height = -(-len(ENTRIES) // COLUMNS) * self._line + self._letters // 2

    def draw(self, image: Image) -> None:
        """Draw into the lowest rows of `image` (height, width, 3)."""
        top = image.shape[0] - self.height
        radius = max(2, round(0.36 * self._letters))
        for k, (text, mark) in enumerate(ENTRIES):
            row, column = divmod(k, COLUMNS)
            base = top + row * self._line + self._letters
            left = column * self._step + self._letters
            mark(image, (left, base - round(0.38 * self._letters)), radius)
            draw_text(image, (left + self._letters, base), text, DARK, self._letters)


@dataclass(frozen=True, slots=True)
class DashboardFrame:
    """Content of the dashboard at one instant.

    Attributes:
        time: simulated time [s].
        frame: latest camera frame, see `hsr8.render.run_images.shown_frames`.
        movers: true positions (n, 2) [m].
        trail: true path of the robot so far (m, 2) [m].
        events: time [s] and kind of each event so far.
        state: current situation of the robot.
    """

    time: float
    frame: SimpleNamespace
    movers: Array
    trail: Array
    events: Sequence[tuple[float, str]]
    state: str


class Dashboard:
    """Composition of the images of one video.

    Args:
        layout: layout of the run's world.
        scenario: scenario of the run.
        timeline: drawn under the scene.
        size: width and height, both even [pixel].
        speed: simulated seconds per second of video.

    Attributes:
        scene_size, camera_size: sizes of the images to compose [pixel].
    """

    def __init__(
        self, layout: Layout, scenario: Scenario, timeline: Timeline, size: Size, speed: float
    ) -> None:
        width, height = size
        self._unit = unit = height / REFERENCE
        self._size, self._speed = size, speed
        self._vias = None if layout.endless else len(layout.waypoints)
        gap, self._bar = round(GAP * unit), max(16, round(BAR * unit))
        side = width // 3
        camera = scenario.camera
        camera_height = min(side * camera.height // camera.width, height // 2)
        self.scene_size: Size = (width - side - gap, height - self._bar)
        self.camera_size: Size = (side, camera_height)
        self._left, self._below = width - side, camera_height + gap
        self._overlay = CameraOverlay(camera.pinhole, self.camera_size)
        self._named = self._bar >= MIN_NAMED
        self._legend = Legend(side, LEGEND * unit)
        room = self._legend.height if self._named else 0
        self._above = TopDown(layout, (side, height - self._below - room))
        self._timeline = timeline
        gaze = scenario.navigation.gaze
        panel = round(PANEL * unit)
        self._panel = GazePanel(max(panel, 64), gaze.max_pan, (gaze.min_tilt, gaze.max_tilt))
        self._with_panel = panel >= MIN_PANEL and panel < self.scene_size[0]
        self._background: Image = np.full((height, width, 3), FRAME, np.uint8)
        if self._named:
            below = self._background[height - self._legend.height :, self._left :]
            below[:] = PAPER
            self._legend.draw(below)

    def draw(self, scene: Image, camera: Image, shown: DashboardFrame) -> Image:
        """Return a new image (height, width, 3).

        Args:
            scene: the robot from outside, of `scene_size`.
            camera: image of the head camera at the capture of the frame, of `camera_size`.
            shown: content.
        """
        image, frame = self._background.copy(), shown.frame
        width, height = self.scene_size
        image[:height, :width] = scene
        part = image[: self.camera_size[1], self._left :]
        part[:] = camera
        self._overlay.draw(part, frame)
        above = self._above.draw(frame, shown.movers, shown.trail)
        image[self._below : self._below + len(above), self._left :] = above
        if self._with_panel:
            margin = round(MARGIN * self._unit)
            corner = margin, height - margin - self._panel.size[1]
            self._panel.draw(image, corner, frame)
        self._draw_titles(image)
        band = image[height:, :width]
        band[:] = BAND
        self._draw_values(band, shown)
        self._timeline.draw(band, shown.time, shown.events)
        return image

    def _draw_titles(self, image: Image) -> None:
        if not self._named:
            return
        letters, pad = font_size(TITLE * self._unit), round(8 * self._unit)
        column = self._left + pad
        row = self.camera_size[1] - pad
        right = column + text_width("head camera", letters, strong=True) + pad
        image[row - letters - pad // 2 : row + pad, self._left : right] = BAND
        draw_text(image, (column, row), "head camera", INK, letters, strong=True)
        row = self._below + pad + letters
        draw_text(image, (column, row), "belief", BAND, letters, strong=True)

    def _draw_values(self, band: Image, shown: DashboardFrame) -> None:
        """Draw a line of values, each under its name."""
        frame = shown.frame
        collisions = sum(kind == "collision" for _, kind in shown.events)
        error = hypot(frame.pose[0] - frame.truth[0], frame.pose[1] - frame.truth[1])
        vias = f"{frame.via_points}" + ("" if self._vias is None else f" / {self._vias}")
        speed = "time" if self._speed == 1.0 else f"time, {self._speed:g}x"
        numbers = [
            (speed, f"{shown.time:.1f} s"),
            ("waypoints", vias),
            ("speed", f"{hypot(*frame.velocity[:2]):.2f} m/s"),
            ("pose error", f"{100.0 * error:.1f} cm"),
            ("collisions", f"{collisions}"),
            ("state", shown.state),
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
