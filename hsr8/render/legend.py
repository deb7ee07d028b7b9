"""Legend of the map of the belief."""

from collections.abc import Callable

import cv2

from hsr8.recorder import palette
from hsr8.render.text import Color, Image, draw_text, font_size
from hsr8.render.top_down import INK, pale

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
    ("true", _ring(INK)),
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
            draw_text(image, (left + self._letters, base), text, INK, self._letters)
