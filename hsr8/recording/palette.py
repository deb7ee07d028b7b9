"""Colours shared by log, plots and video."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

Color = tuple[int, int, int]

LABELS: dict[str, Color] = {
    "red": (214, 60, 52),
    "green": (76, 168, 78),
    "blue": (52, 112, 206),
    "violet": (146, 84, 196),
    "yellow": (226, 190, 40),
    "cyan": (44, 184, 200),
    "magenta": (214, 64, 160),
}
UNKNOWN: Color = (150, 150, 150)

BELIEF: Color = (20, 150, 240)
TRUTH: Color = (60, 60, 64)
TARGET: Color = (240, 140, 20)
VIEW: Color = (250, 200, 60)
FIELD: Color = (112, 128, 144)
PLAN: Color = (0, 140, 120)
VIRTUAL: Color = (230, 70, 130)
LEFT_FOOT: Color = (70, 130, 220)
RIGHT_FOOT: Color = (220, 110, 70)


def of_label(label: str) -> Color:
    """Return the colour of an obstacle's class, or of the top of a beacon ``top/bottom``."""
    return LABELS.get(label.partition("/")[0], UNKNOWN)


def darker(color: Color) -> Color:
    """Return a colour that is visible on a disc of `color`."""
    red, green, blue = color
    return red // 2, green // 2, blue // 2


def packed(color: Color, alpha: int = 255) -> int:
    """Return 0xRRGGBBAA."""
    red, green, blue = color
    return (red << 24) | (green << 16) | (blue << 8) | alpha


def packed_all(colors: Iterable[Color]) -> NDArray[np.uint32]:
    """Return opaque colours as 0xRRGGBBAA (n,)."""
    return np.array([packed(color) for color in colors], dtype=np.uint32)
