"""Colour classes of obstacles and beacons, classification by a look-up table, and its files."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import cv2
import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from vision.errors import VisionError

Labels = NDArray[np.uint8]

TABLE_SIZE = 1 << 15  # one entry for each RGB555 colour
SUFFIX = ".npz"


@dataclass(frozen=True, slots=True)
class ColorClass:
    """Colour class.

    Attributes:
        name: name of the colour.
        kind: kind of the objects painted in it.
        rgb: paint, channels 0..1, well below 1 so that strong light clips no channel and keeps
            the hue.
        hue: first and last hue in OpenCV's half degrees, 0..180; first > last wraps
            around red.
        min_saturation: 0..255.
        min_value: 0..255.
    """

    name: str
    kind: Literal["obstacle", "beacon"]
    rgb: tuple[float, float, float]
    hue: tuple[float, float]
    min_saturation: int = 120
    min_value: int = 18

    def contains(self, hue: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Return whether each hue [half degree] is in the class."""
        first, last = self.hue
        if first <= last:
            return (first <= hue) & (hue <= last)
        return (hue >= first) | (hue <= last)


COLOR_CLASSES: Mapping[str, ColorClass] = {
    c.name: c
    for c in (
        ColorClass("red", "obstacle", (0.62, 0.09, 0.09), (168.0, 13.0)),
        ColorClass("green", "obstacle", (0.09, 0.56, 0.13), (44.0, 78.0)),
        ColorClass("blue", "obstacle", (0.10, 0.18, 0.64), (105.0, 125.5)),
        ColorClass("violet", "obstacle", (0.35, 0.09, 0.62), (126.0, 144.0)),
        ColorClass("yellow", "beacon", (0.62, 0.57, 0.08), (19.0, 40.0)),
        ColorClass("cyan", "beacon", (0.08, 0.57, 0.61), (82.0, 103.0)),
        ColorClass("magenta", "beacon", (0.62, 0.09, 0.55), (145.0, 165.0)),
    )
}
"""All colour classes; label k of a classified image is the k-th of them, from 1."""


class ColorTable:
    """Look-up table from RGB555 colours to labels.

    Args:
        classes: colour classes; label k is the k-th of them, counted from 1.
        labels: label of every RGB555 colour (32768,); default: from the bounds of the classes.

    Raises:
        VisionError: two classes overlap, or `labels` do not fit the classes.
    """

    def __init__(
        self, classes: Mapping[str, ColorClass] = COLOR_CLASSES, labels: Labels | None = None
    ) -> None:
        self.classes = tuple(classes.values())
        if labels is None:
            labels = _labels_of(self.classes)
        elif labels.shape != (TABLE_SIZE,) or labels.dtype != np.uint8:
            raise VisionError(
                f"colour table: wrong labels, got {labels.dtype} of shape {labels.shape}; "
                f"expected uint8 of shape ({TABLE_SIZE},)"
            )
        elif int(labels.max()) > len(self.classes):
            raise VisionError(
                f"colour table: wrong labels, got label {int(labels.max())}; "
                f"expected 0 to {len(self.classes)}"
            )
        self.labels = labels

    def classify(self, image: NDArray[np.uint8]) -> Labels:
        """Return the label of every pixel of an RGB image (h, w, 3): (h, w), 0 for no class.

        Raises:
            VisionError: the image is not an array of uint8 of shape (h, w, 3).
        """
        if image.dtype != np.uint8 or image.ndim != 3 or image.shape[2] != 3 or image.size == 0:
            raise VisionError(
                f"image: not RGB, got {image.dtype} of shape {image.shape}; "
                "expected uint8 of shape (height, width, 3)"
            )
        return labels_of(np.ascontiguousarray(image), self.labels)


def table_colors() -> NDArray[np.uint8]:
    """Return the centre of each RGB555 bin (32768, 3), by code."""
    code = np.arange(TABLE_SIZE)
    rgb = np.stack([(code >> 10) & 31, (code >> 5) & 31, code & 31], axis=-1) * 8 + 4
    return rgb.astype(np.uint8)


def _labels_of(classes: Sequence[ColorClass]) -> Labels:
    """Return the label of every RGB555 colour from the bounds of the classes."""
    labels = np.zeros(TABLE_SIZE, dtype=np.uint8)
    hue, saturation, value = _hsv_of_table()
    for label, color in enumerate(classes, start=1):
        claimed = (
            color.contains(hue) & (saturation >= color.min_saturation) & (value >= color.min_value)
        )
        overlap = np.unique(labels[claimed & (labels > 0)]).tolist()
        if overlap:
            other = classes[overlap[0] - 1]
            raise VisionError(
                f"colour classes {other.name!r} and {color.name!r}: overlapping hues, "
                f"got {other.hue} and {color.hue}"
            )
        labels[claimed] = label
    return labels


def _hsv_of_table() -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return hue [half degree], saturation and value 0..255 of each RGB555 bin."""
    rgb = (table_colors()[None] / 255.0).astype(np.float32)
    hsv = cv2.cvtColor(rgb, cv2.COLOR_RGB2HSV)[0].astype(np.float64)
    return 0.5 * hsv[:, 0], 255.0 * hsv[:, 1], 255.0 * hsv[:, 2]


@compiled
def labels_of(image: Labels, table: Labels) -> Labels:
    """Return the label of every pixel of an RGB image (h, w, 3): (h, w).

    Args:
        image: RGB.
        table: label of every RGB555 colour (32768,).
    """
    height, width, _ = image.shape
    labels, codes = np.empty((height, width), np.uint8), np.empty(width, np.uint16)
    for row in range(height):
        channels, of_row = image[row].reshape(-1), labels[row]
        # A separate loop for the codes is vectorized.
        for k in range(width):
            # A code has 15 bits, a channel 8: compute with wider integers.
            red, green = int(channels[3 * k]), int(channels[3 * k + 1])
            blue = int(channels[3 * k + 2])
            codes[k] = (red >> 3) << 10 | (green >> 3) << 5 | blue >> 3
        for k in range(width):
            of_row[k] = table[codes[k]]
    return labels


def save_table(table: ColorTable, path: Path) -> None:
    """Write `table` to `path`.

    Raises:
        OSError: the file cannot be written.
    """
    with path.open("wb") as file:
        np.savez_compressed(
            file, labels=table.labels, names=np.array([c.name for c in table.classes])
        )


def load_table(path: Path) -> ColorTable:
    """Read a table.

    Raises:
        VisionError: the file cannot be read, or is not a colour table of the present classes.
    """
    try:
        with np.load(path, allow_pickle=False) as archive:
            labels, names = archive["labels"], archive["names"].tolist()
    except OSError as error:
        raise VisionError(f"{path}: {error.strerror or 'not a colour table'}") from None
    except Exception:  # a damaged archive raises anything
        raise VisionError(
            f"{path}: not a colour table; expected a file written by `hsr8 color-table`"
        ) from None
    if names != list(COLOR_CLASSES):
        raise VisionError(
            f"{path}: other colour classes, got {', '.join(map(str, names))}; "
            f"expected {', '.join(COLOR_CLASSES)}"
        )
    try:
        return ColorTable(COLOR_CLASSES, labels)
    except VisionError as error:
        raise VisionError(f"{path}: {error}") from None
