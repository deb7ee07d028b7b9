"""Learning of a colour table from labelled images (kernel density classifier).

Lighting changes brightness but hardly chromaticity, the fractions of red and green in a colour.
Labelled pixels are counted in the chromaticity plane, the histograms are smoothed, more for
dark colours because of noise, and each colour of the table gets the label of highest density.
"""

from collections.abc import Iterable, Mapping
from itertools import pairwise

import cv2
import numpy as np
from numpy.typing import NDArray

from vision.color import COLOR_CLASSES, ColorClass, ColorTable, Labels, table_colors
from vision.errors import VisionError

Array = NDArray[np.float64]

CELLS = 96  # of the chromaticity plane, along each side
BLUR = 2.0  # standard deviation of the smoothing in bright light [cell]
NOISE = 3.0  # of a channel, which adds smoothing for dark colours [grey level]
BRIGHTNESS = (0, 48, 72, 108, 162, 243, 766)  # bins of the sum of the channels, one blur each
MIN_CHANNEL = 18  # minimum of the strongest channel of a classified colour, 0..255
MIN_DENSITY = 1e-5  # minimum density of a classified colour, relative to the class's maximum
IGNORED = 255  # label of unlabelled pixels


def learn(
    images: Iterable[tuple[NDArray[np.uint8], Labels]],
    classes: Mapping[str, ColorClass] = COLOR_CLASSES,
) -> ColorTable:
    """Return the table that classifies colours as in the labelled images.

    Args:
        images: RGB (h, w, 3) and label of each pixel (h, w): k for the k-th class, counted
            from 1, 0 for the background, 255 for pixels to ignore.
        classes: colour classes.

    Raises:
        VisionError: an image and its labels differ in size, a label is unknown, or all pixels
            are background.
    """
    counts = np.zeros((len(classes) + 1, CELLS, CELLS))
    for image, labels in images:
        if image.shape != (*labels.shape, 3):
            raise VisionError(f"labels: got shape {labels.shape}; expected {image.shape[:2]}")
        labelled = labels != IGNORED
        highest = int(labels[labelled].max(initial=0))
        if highest > len(classes):
            raise VisionError(f"labels: got label {highest}; expected 0 to {len(classes)}")
        cells, bright = _cells(image.reshape(-1, 3))
        used = labelled.ravel() & bright
        np.add.at(counts.reshape(len(counts), -1), (labels.ravel()[used], cells[used]), 1.0)
    if not counts[1:].any():
        raise VisionError("labels: all pixels are background")
    colors = table_colors()
    cells, bright = _cells(colors)
    total = colors.sum(axis=1, dtype=np.int64)
    table = np.zeros(len(colors), np.uint8)
    for low, high in pairwise(BRIGHTNESS):
        level = bright & (total >= low) & (total < high)
        blur = BLUR + NOISE * CELLS / max(low, MIN_CHANNEL)
        density = np.stack([_blurred(plane, blur) for plane in counts])
        at = density.reshape(len(density), -1)[:, cells[level]]
        table[level] = np.where(at.max(axis=0) < MIN_DENSITY, 0, at.argmax(axis=0))
    return ColorTable(classes, table)


def _cells(colors: NDArray[np.uint8]) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    """Return the cell of each RGB colour (n, 3), and whether it is bright enough to classify."""
    rgb = colors.astype(np.float64)
    total = np.maximum(rgb.sum(axis=1), 1.0)
    red, green = ((CELLS - 1) * rgb[:, k] / total for k in (0, 1))
    cell = np.round(red).astype(np.intp) * CELLS + np.round(green).astype(np.intp)
    return cell, colors.max(axis=1) >= MIN_CHANNEL


def _blurred(counts: Array, sigma: float) -> Array:
    """Return smoothed counts, normalized to a maximum of 1."""
    size = 2 * round(5.0 * sigma) + 1
    blurred: Array = cv2.GaussianBlur(counts, (size, size), sigma, borderType=cv2.BORDER_CONSTANT)
    return blurred / max(float(blurred.max()), 1e-9)
