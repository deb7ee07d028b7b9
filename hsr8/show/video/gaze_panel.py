"""Panel with the value of every gaze, the chosen gaze and the partial evaluations."""

from collections.abc import Sequence
from types import SimpleNamespace

import cv2
import numpy as np

from hsr8.recording import palette
from hsr8.show.evaluations import EVALUATIONS
from hsr8.show.image import Image, draw_text, font_size, text_width

PANEL, GROOVE = (28, 30, 34), (70, 74, 82)
INK, FAINT = (238, 239, 241), (164, 168, 176)
OPACITY = 0.86
MAX_RATIO = 1.0  # height to width of the map, which is narrow for a camera that does not pan
COLUMNS = 2  # of the partial evaluations


class GazePanel:
    """Panel in a corner of an image.

    Args:
        width: width of the panel [pixel].
        max_pan: maximum pan of the map to either side [rad].
        tilts: minimum and maximum tilt of the map [rad].
    """

    def __init__(self, width: int, max_pan: float, tilts: tuple[float, float]) -> None:
        self._max_pan, self._tilts = max_pan, tilts
        self._pad = pad = max(4, width // 28)
        self._letters = font_size(width / 21)
        ratio = min(MAX_RATIO, (tilts[1] - tilts[0]) / (2.0 * max_pan))
        self._map = (width - 2 * pad, max(8, round((width - 2 * pad) * ratio)))
        self._top = self._letters + 2 * pad
        self._line = self._letters + 2 * pad
        rows = len(EVALUATIONS) // COLUMNS
        self.size = (width, self._top + self._map[1] + rows * self._line + pad)
        ramp = np.arange(256, dtype=np.uint8)[:, None]
        heat = cv2.applyColorMap(ramp, cv2.COLORMAP_INFERNO)[:, 0, ::-1]
        self._heat = np.ascontiguousarray(heat)

    def draw(self, image: Image, corner: tuple[int, int], frame: SimpleNamespace) -> None:
        """Draw into `image` (height, width, 3) with the upper left corner at `corner`."""
        left, top = corner
        width, height = self.size
        panel = image[top : top + height, left : left + width]
        panel[:] = cv2.addWeighted(panel, 1.0 - OPACITY, np.full_like(panel, PANEL), OPACITY, 0.0)
        pad, base = self._pad, self._pad + self._letters - 1
        draw_text(panel, (pad, base), "value of gazes", INK, self._letters, strong=True)
        column = width - pad
        radius = max(2, self._letters // 3)
        for text, color, filled in (("chosen", palette.BELIEF, False), ("now", INK, True)):
            draw_text(panel, (column, base), text, FAINT, self._letters, side="right")
            column -= text_width(text, self._letters) + 2 * radius + 2
            centre = column, base - radius
            cv2.circle(panel, centre, radius, color, -1 if filled else 1, cv2.LINE_AA)
            column -= 4 * radius
        self._draw_map(panel, frame)
        self._draw_evaluations(panel, frame)

    def _draw_map(self, panel: Image, frame: SimpleNamespace) -> None:
        part = panel[self._top : self._top + self._map[1], self._pad : self._pad + self._map[0]]
        part[:] = self._heat[0]
        if frame.gaze_map is not None:
            shades = cv2.resize(frame.gaze_map, self._map, interpolation=cv2.INTER_NEAREST)
            part[:] = self._heat[shades]
        current = self._pixel(frame.head)
        radius = max(2, self._map[1] // 14)
        chosen = self._pixel(frame.gaze)
        cv2.line(panel, current, chosen, INK, 1, cv2.LINE_AA)
        cv2.circle(panel, chosen, radius + 2, palette.BELIEF, 2, cv2.LINE_AA)
        cv2.circle(panel, current, radius - 1, INK, -1, cv2.LINE_AA)

    def _draw_evaluations(self, panel: Image, frame: SimpleNamespace) -> None:
        """Draw a bar per evaluation below the map."""
        pad, thick = self._pad, max(2, self._pad // 2)
        step = (self.size[0] - pad) // COLUMNS
        for k, (name, value) in enumerate(zip(EVALUATIONS, frame.psi, strict=True)):
            column = pad + k % COLUMNS * step
            row = self._top + self._map[1] + k // COLUMNS * self._line + pad + self._letters
            draw_text(panel, (column, row - 1), name, FAINT, self._letters)
            groove = panel[row + thick : row + 2 * thick, column : column + step - pad]
            groove[:] = GROOVE
            groove[:, : round(min(1.0, max(0.0, value)) * groove.shape[1])] = palette.VIEW

    def _pixel(self, gaze: Sequence[float]) -> tuple[int, int]:
        """Return column and row of a direction in the panel."""
        low, high = self._tilts
        u = (self._max_pan - gaze[0]) / (2.0 * self._max_pan)
        v = (high - gaze[1]) / (high - low)
        u, v = min(1.0, max(0.0, u)), min(1.0, max(0.0, v))
        column = self._pad + round(u * (self._map[0] - 1))
        return column, self._top + round(v * (self._map[1] - 1))
