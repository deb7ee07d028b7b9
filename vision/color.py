"""Colour classes: what colours mean, how things are painted, and a table to recognise them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import cv2
import numpy as np
from numpy.typing import NDArray

from vision import color_kernel
from vision.errors import VisionError

Labels = NDArray[np.uint8]

TABLE_SIZE = 1 << 15  # one entry for each RGB555 colour
OUTSIDE = 255  # label of what lies beyond the border of an image


@dataclass(frozen=True, slots=True)
class ColorClass:
    """A colour that means something.

    Attributes:
        name: of the colour.
        kind: whether obstacles or beacons carry it.
        rgb: how such things are painted, channels 0..1. No channel comes near 1, so
            that strong light clips none and the hue stays.
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
        """Whether each hue [half degree] lies in the class."""
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
"""Every colour vision knows; label k of a classified image is the k-th of them, from 1."""


class ColorTable:
    """Look-up table from RGB555 colours to labels.

    Args:
        classes: colours to recognise; label k is the k-th of them, counted from 1.
        labels: label of every RGB555 colour (32768,); made from the hues that the classes
            declare if left out.

    Raises:
        VisionError: two classes claim the same colour, or `labels` do not fit the classes.
    """

    def __init__(
        self, classes: Mapping[str, ColorClass] = COLOR_CLASSES, labels: Labels | None = None
    ) -> None:
        self.classes = tuple(classes.values())
        if labels is None:
            labels = _declared(self.classes)
        elif labels.shape != (TABLE_SIZE,) or labels.dtype != np.uint8:
            raise VisionError(
                f"a colour table has {TABLE_SIZE} labels of uint8, "
                f"got {labels.dtype} of shape {labels.shape}"
            )
        elif int(labels.max()) > len(self.classes):
            raise VisionError(
                f"the colour table has a label {int(labels.max())}, but there are "
                f"{len(self.classes)} colour classes"
            )
        self.labels = labels

    def classify(self, image: NDArray[np.uint8]) -> Labels:
        """Label of every pixel of an RGB image (h, w, 3): (h, w), 0 for no class.

        Raises:
            VisionError: the image is not an array of uint8 of shape (h, w, 3).
        """
        if image.dtype != np.uint8 or image.ndim != 3 or image.shape[2] != 3 or image.size == 0:
            raise VisionError(
                "an image must be an RGB array of uint8 of shape (height, width, 3), "
                f"got {image.dtype} of shape {image.shape}"
            )
        return color_kernel.classify(np.ascontiguousarray(image), self.labels)


def table_colors() -> NDArray[np.uint8]:
    """RGB in the middle of each bin of a table (32768, 3), in the order of the codes."""
    code = np.arange(TABLE_SIZE)
    rgb = np.stack([(code >> 10) & 31, (code >> 5) & 31, code & 31], axis=-1) * 8 + 4
    return rgb.astype(np.uint8)


def _declared(classes: Sequence[ColorClass]) -> Labels:
    """Labels from the hues, the saturation and the value that the classes declare."""
    labels = np.zeros(TABLE_SIZE, dtype=np.uint8)
    hue, saturation, value = _hsv_of_table()
    for label, color in enumerate(classes, start=1):
        claimed = (
            color.contains(hue) & (saturation >= color.min_saturation) & (value >= color.min_value)
        )
        rivals = np.unique(labels[claimed & (labels > 0)]).tolist()
        if rivals:
            other = classes[rivals[0] - 1]
            raise VisionError(
                f"colour classes {other.name!r} and {color.name!r} overlap: "
                f"hues {other.hue} and {color.hue}"
            )
        labels[claimed] = label
    return labels


def _hsv_of_table() -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Hue [half degree], saturation and value 0..255 in the middle of each RGB555 bin."""
    rgb = (table_colors()[None] / 255.0).astype(np.float32)
    hsv = cv2.cvtColor(rgb, cv2.COLOR_RGB2HSV)[0].astype(np.float64)
    return 0.5 * hsv[:, 0], 255.0 * hsv[:, 1], 255.0 * hsv[:, 2]
