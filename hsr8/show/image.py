"""Images: their type, text in the outline font of OpenCV, PNG files."""

from functools import cache
from pathlib import Path
from typing import Literal

import cv2
import numpy as np
from numpy.typing import NDArray

from hsr8.files import atomic

Color = tuple[int, ...]
Image = NDArray[np.uint8]
Side = Literal["left", "middle", "right"]

REGULAR, BOLD = 400, 600  # weights
MIN_SIZE = 9  # of legible letters [pixel]


@cache
def _face() -> cv2.FontFace:
    return cv2.FontFace("sans")


def font_size(size: float) -> int:
    """Return the nearest legible font size [pixel]."""
    return max(MIN_SIZE, round(size))


def text_width(text: str, size: int, *, strong: bool = False) -> int:
    """Return the length of a line [pixel]."""
    box = cv2.getTextSize((0, 0), text, (0, 0), _face(), size, BOLD if strong else REGULAR)
    return int(box[2])


def draw_text(
    image: Image,
    at: tuple[int, int],
    text: str,
    color: Color,
    size: int,
    *,
    strong: bool = False,
    side: Side = "left",
) -> None:
    """Draw one line of text.

    Args:
        image: image to draw into (height, width, 3).
        at: column of the line's left end, middle or right end, and row of its baseline [pixel].
        text: text to draw.
        color: colour of the letters.
        size: size of the font [pixel].
        strong: bold.
        side: part of the line at that column.
    """
    column, row = at
    if side != "left":
        length = text_width(text, size, strong=strong)
        column -= length if side == "right" else length // 2
    cv2.putText(image, text, (column, row), color, _face(), size, BOLD if strong else REGULAR)


def write_png(path: Path, image: NDArray[np.uint8]) -> None:
    """Write `image` (height, width, 3), RGB, as PNG, whatever the suffix of `path`.

    Raises:
        OSError: the file cannot be written.
    """
    _, data = cv2.imencode(".png", cv2.cvtColor(image, cv2.COLOR_RGB2BGR))
    atomic.write_bytes(path, data.tobytes())
