"""A colour table learnt from labelled pixels.

Light changes how bright a thing is, and hardly its chromaticity, the shares of red and
green in its colour. So the classes are told apart by chromaticity: pixels are counted in
its plane, the counts are blurred by what noise and another light may do, which is more in
the dark, and each colour of the table gets the label whose pixels are densest there.
"""

from collections.abc import Iterable, Mapping
from itertools import pairwise

import cv2
import numpy as np
from numpy.typing import NDArray

from vision.color import COLOR_CLASSES, ColorClass, ColorTable, Labels, table_colors
from vision.errors import VisionError

Array = NDArray[np.float64]

CELLS = 96  # of the plane of chromaticity, along each side
BLUR = 2.0  # how far pixels speak for other colours in bright light [cell]
NOISE = 3.0  # of a channel, which blurs dark colours more [grey level]
BRIGHTNESS = (0, 48, 72, 108, 162, 243, 766)  # sums of the channels between which one blur does
DARKEST = 18  # a colour whose strongest channel is weaker tells nothing, 0..255
FAINTEST = 1e-5  # share of a class's greatest density below which a colour is not of it
IGNORED = 255  # label of pixels that nobody has judged


def learn(
    images: Iterable[tuple[NDArray[np.uint8], Labels]],
    classes: Mapping[str, ColorClass] = COLOR_CLASSES,
) -> ColorTable:
    """Table that recognises the classes as they are labelled in some images.

    Args:
        images: RGB (h, w, 3) and label of each pixel (h, w): k for the k-th class, counted
            from 1, 0 for the background, 255 for pixels to leave out.
        classes: colours to recognise.

    Raises:
        VisionError: an image and its labels differ in size, a label means no class, or no
            pixel at all is of a class.
    """
    counts = np.zeros((len(classes) + 1, CELLS, CELLS))
    for image, labels in images:
        if image.shape != (*labels.shape, 3):
            raise VisionError(f"an image of shape {image.shape} has labels of shape {labels.shape}")
        judged = labels != IGNORED
        worst = int(labels[judged].max(initial=0))
        if worst > len(classes):
            raise VisionError(f"label {worst} means no class: there are {len(classes)}")
        cells, bright = _cells(image.reshape(-1, 3))
        chosen = judged.ravel() & bright
        np.add.at(counts.reshape(len(counts), -1), (labels.ravel()[chosen], cells[chosen]), 1.0)
    if not counts[1:].any():
        raise VisionError("no pixel of the labelled images is of a colour class")
    colors = table_colors()
    cells, bright = _cells(colors)
    total = colors.sum(axis=1, dtype=np.int64)
    table = np.zeros(len(colors), np.uint8)
    for low, high in pairwise(BRIGHTNESS):
        level = bright & (total >= low) & (total < high)
        blur = BLUR + NOISE * CELLS / max(low, DARKEST)
        density = np.stack([_blurred(plane, blur) for plane in counts])
        at = density.reshape(len(density), -1)[:, cells[level]]
        table[level] = np.where(at.max(axis=0) < FAINTEST, 0, at.argmax(axis=0))
    return ColorTable(classes, table)


def _cells(colors: NDArray[np.uint8]) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    """Cell of each RGB colour (n, 3), and whether it is bright enough to have one."""
    rgb = colors.astype(np.float64)
    total = np.maximum(rgb.sum(axis=1), 1.0)
    red, green = ((CELLS - 1) * rgb[:, k] / total for k in (0, 1))
    cell = np.round(red).astype(np.intp) * CELLS + np.round(green).astype(np.intp)
    return cell, colors.max(axis=1) >= DARKEST


def _blurred(counts: Array, sigma: float) -> Array:
    """Counts spread over the neighbourhood, at most 1."""
    size = 2 * round(5.0 * sigma) + 1
    blurred: Array = cv2.GaussianBlur(counts, (size, size), sigma, borderType=cv2.BORDER_CONSTANT)
    return blurred / max(float(blurred.max()), 1e-9)
