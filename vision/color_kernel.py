"""Compiled part of the colour classification."""

import numpy as np
from numpy.typing import NDArray

from compilation import compiled

Labels = NDArray[np.uint8]


@compiled
def classify(image: Labels, table: Labels) -> Labels:
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
