"""Text in pictures, in the outline font that comes with OpenCV."""

from functools import cache
from typing import Literal

import cv2

from hsr8.render.canvas import Color, Image

Side = Literal["left", "middle", "right"]

REGULAR, STRONG = 400, 600  # weights
SMALLEST = 9  # letters lower than this cannot be read [pixel]


@cache
def _face() -> cv2.FontFace:
    return cv2.FontFace("sans")


def font_size(share: float) -> int:
    """Size of letters that would be `share` [pixel], but never too small to be read."""
    return max(SMALLEST, round(share))


def text_width(text: str, size: int, *, strong: bool = False) -> int:
    """Length of a line [pixel]."""
    weight = STRONG if strong else REGULAR
    box = cv2.getTextSize((0, 0), text, (0, 0), _face(), size, weight)
    return int(box[2])


def draw_text(
    picture: Image,
    at: tuple[int, int],
    text: str,
    color: Color,
    size: int,
    *,
    strong: bool = False,
    side: Side = "left",
) -> None:
    """Write one line.

    Args:
        picture: to write into (height, width, 3).
        at: column of the line's left end, middle or right end, and row of its baseline [pixel].
        text: what to write.
        color: of the letters.
        size: of the letters [pixel].
        strong: in heavier letters.
        side: what of the line is at that column.
    """
    column, row = at
    if side != "left":
        length = text_width(text, size, strong=strong)
        column -= length if side == "right" else length // 2
    weight = STRONG if strong else REGULAR
    cv2.putText(picture, text, (column, row), color, _face(), size, weight)
