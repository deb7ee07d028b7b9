"""Colours of people's pictures: log, plots and video agree on them."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

Colour = tuple[int, int, int]

LABELS: dict[str, Colour] = {
    "red": (214, 60, 52),
    "green": (76, 168, 78),
    "blue": (52, 112, 206),
    "violet": (146, 84, 196),
    "yellow": (226, 190, 40),
    "cyan": (44, 184, 200),
    "magenta": (214, 64, 160),
}
UNKNOWN: Colour = (150, 150, 150)

BELIEF: Colour = (20, 150, 240)
TRUTH: Colour = (60, 60, 64)
TARGET: Colour = (240, 140, 20)
VIEW: Colour = (250, 200, 60)
FIELD: Colour = (112, 128, 144)
PLAN: Colour = (0, 140, 120)
VIRTUAL: Colour = (230, 70, 130)
LEFT_FOOT: Colour = (70, 130, 220)
RIGHT_FOOT: Colour = (220, 110, 70)


def of_label(label: str) -> Colour:
    """Colour of an obstacle's class, or of the top of a beacon ``top/bottom``."""
    return LABELS.get(label.partition("/")[0], UNKNOWN)


def darker(colour: Colour) -> Colour:
    """The colour of what lies on a disc of `colour`."""
    red, green, blue = colour
    return red // 2, green // 2, blue // 2


def packed(colour: Colour, alpha: int = 255) -> int:
    """0xRRGGBBAA."""
    red, green, blue = colour
    return (red << 24) | (green << 16) | (blue << 8) | alpha


def packed_all(colours: Iterable[Colour]) -> NDArray[np.uint32]:
    """Opaque colours, each as 0xRRGGBBAA (n,)."""
    return np.array([packed(colour) for colour in colours], dtype=np.uint32)
