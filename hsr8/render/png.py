"""Writing of PNG files."""

from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from hsr8.files import atomic


def write_png(path: Path, image: NDArray[np.uint8]) -> None:
    """Write `image` (height, width, 3), RGB, as PNG, whatever the suffix of `path`.

    Raises:
        OSError: the file cannot be written.
    """
    _, data = cv2.imencode(".png", cv2.cvtColor(image, cv2.COLOR_RGB2BGR))
    atomic.write_bytes(path, data.tobytes())
