"""Pixels to labels by a table, compiled."""

import numpy as np
from numba import njit
from numpy.typing import NDArray

Labels = NDArray[np.uint8]


@njit(cache=True)
def classify(image: Labels, table: Labels) -> Labels:
    """Label of every pixel of an RGB image (h, w, 3): (h, w).

    Args:
        image: RGB.
        table: label of every RGB555 colour (32768,).
    """
    height, width, _ = image.shape
    labels = np.empty((height, width), np.uint8)
    for row in range(height):
        for column in range(width):
            # As wide integers: a code has 15 bits, a channel 8.
            red, green = int(image[row, column, 0]), int(image[row, column, 1])
            blue = int(image[row, column, 2])
            labels[row, column] = table[(red >> 3) << 10 | (green >> 3) << 5 | blue >> 3]
    return labels
