"""The dashboard of a video: the scene, what the robot sees, believes, and where it looks."""

from dataclasses import dataclass
from math import hypot

import numpy as np
from numpy.typing import NDArray

from hsr8.recorder.run.frame_summary import FrameSummary
from hsr8.render.camera_overlay import CameraOverlay
from hsr8.render.canvas import Image
from hsr8.render.gaze_panel import GazePanel
from hsr8.render.text import draw_text, font_size, text_width
from hsr8.render.timeline import Timeline
from hsr8.render.top_down import TopDown
from hsr8.scenario.schema import Scenario
from hsr8.world.field.layout import Layout

Array = NDArray[np.float64]
Size = tuple[int, int]

USUAL = 720  # height of picture that lengths below are meant for [pixel]
GAP, BAR, MARGIN, PANEL = 4, 54, 14, 270  # [pixel]
VALUE, NAME, TITLE = 20, 13, 14  # size of letters [pixel]
FRAME, BAND = (18, 19, 22), (28, 30, 34)
INK, FAINT, ALARM = (238, 239, 241), (150, 155, 164), (255, 130, 90)
LEAST_PANEL = 120  # a narrower gaze map cannot be read [pixel]
SHORTEST_NAMED = 40  # a lower band has no room for names above its values [pixel]


@dataclass(frozen=True, slots=True)
class DashboardFrame:
    """What the dashboard tells of an instant.

    Attributes:
        time: simulated [s].
        frame: the latest camera frame.
        movers: true positions (n, 2) [m].
        trail: true path of the robot so far (m, 2) [m].
        collisions: so far.
        doing: what the robot is at, in words.
    """

    time: float
    frame: FrameSummary
    movers: Array
    trail: Array
    collisions: int
    doing: str


class Dashboard:
    """Puts the pictures of one video together.

    Args:
        layout: of the run's world.
        scenario: of the run.
        timeline: what happens when, drawn under the scene.
        size: width and height, both even [pixel].
        speed: simulated seconds per second of video.

    Attributes:
        scene_size, eye_size: of the pictures to be handed in [pixel].
    """

    def __init__(
        self, layout: Layout, scenario: Scenario, timeline: Timeline, size: Size, speed: float
    ) -> None:
        width, height = size
        self._unit = unit = height / USUAL
        self._size, self._speed = size, speed
        self._vias = None if layout.endless else len(layout.waypoints)
        gap, self._bar = round(GAP * unit), max(16, round(BAR * unit))
        side = width // 3
        camera = scenario.camera
        eye_height = min(side * camera.height // camera.width, height // 2)
        self.scene_size: Size = (width - side - gap, height - self._bar)
        self.eye_size: Size = (side, eye_height)
        self._left, self._below = width - side, eye_height + gap
        self._overlay = CameraOverlay(
            (camera.width, camera.height), self.eye_size, camera.vertical_fov
        )
        self._above = TopDown(layout, (side, height - self._below))
        self._timeline = timeline
        gaze = scenario.navigation.gaze
        panel = round(PANEL * unit)
        self._panel = GazePanel(max(panel, 64), gaze.max_pan, (gaze.min_tilt, gaze.max_tilt))
        self._with_panel = panel >= LEAST_PANEL and panel < self.scene_size[0]
        self._picture: Image = np.full((height, width, 3), FRAME, np.uint8)

    def draw(self, scene: Image, eye: Image, moment: DashboardFrame) -> Image:
        """The picture (height, width, 3); it is the caller's.

        Args:
            scene: the robot from outside, of `scene_size`.
            eye: what its camera sees at the time of the frame, of `eye_size`.
            moment: what to tell.
        """
        picture, frame = self._picture.copy(), moment.frame
        width, height = self.scene_size
        picture[:height, :width] = scene
        part = picture[: self.eye_size[1], self._left :]
        part[:] = eye
        self._overlay.draw(part, frame)
        picture[self._below :, self._left :] = self._above.draw(frame, moment.movers, moment.trail)
        if self._with_panel:
            margin = round(MARGIN * self._unit)
            corner = margin, height - margin - self._panel.size[1]
            self._panel.draw(picture, corner, frame)
        self._write_titles(picture)
        band = picture[height:, :width]
        band[:] = BAND
        self._write_numbers(band, moment)
        self._timeline.draw(band, moment.time)
        return picture

    def _write_titles(self, picture: Image) -> None:
        if self._bar < SHORTEST_NAMED:
            return
        letters, pad = font_size(TITLE * self._unit), round(8 * self._unit)
        column = self._left + pad
        row = self.eye_size[1] - pad
        right = column + text_width("head camera", letters, strong=True) + pad
        picture[row - letters - pad // 2 : row + pad, self._left : right] = BAND
        draw_text(picture, (column, row), "head camera", INK, letters, strong=True)
        row = self._below + pad + letters
        draw_text(picture, (column, row), "belief", BAND, letters, strong=True)
        place = (self._size[0] - pad, row)
        draw_text(
            picture, place, "filled: believed    outlined: true", BAND, letters - 2, side="right"
        )

    def _write_numbers(self, band: Image, moment: DashboardFrame) -> None:
        """A line of values, each under its name."""
        frame = moment.frame
        error = hypot(frame.pose[0] - frame.truth[0], frame.pose[1] - frame.truth[1])
        vias = f"{frame.passed}" + ("" if self._vias is None else f" / {self._vias}")
        speed = "time" if self._speed == 1.0 else f"time, {self._speed:g}x"
        numbers = [
            (speed, f"{moment.time:.1f} s"),
            ("way points", vias),
            ("speed", f"{hypot(*frame.velocity[:2]):.2f} m/s"),
            ("pose error", f"{100.0 * error:.1f} cm"),
            ("collisions", f"{moment.collisions}"),
            ("doing", moment.doing),
        ]
        named = self._bar >= SHORTEST_NAMED
        letters, names = font_size(VALUE * self._unit), font_size(NAME * self._unit)
        pad = round(MARGIN * self._unit)
        base = round(0.78 * self._bar) if named else (self._bar + letters) // 2 - 2
        step = (band.shape[1] - 2 * pad) / len(numbers)
        for k, (name, value) in enumerate(numbers):
            column = pad + round(k * step)
            alarm = name == "collisions" and moment.collisions > 0
            if text_width(value, letters, strong=True) > step and not named:
                continue
            draw_text(band, (column, base), value, ALARM if alarm else INK, letters, strong=True)
            if named:
                draw_text(band, (column, round(0.36 * self._bar)), name, FAINT, names)
