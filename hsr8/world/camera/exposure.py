"""An image that is still being drawn when it is handed on."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Image = NDArray[np.uint8]


class Exposure:
    """One image of a camera.

    OpenGL draws beside the program, so whoever asks late waits least.

    Args:
        read: waits until the image is drawn and returns it; called once at most.
    """

    __slots__ = ("_image", "_read")

    def __init__(self, read: Callable[[], Image]) -> None:
        self._read: Callable[[], Image] | None = read
        self._image: Image | None = None

    def image(self) -> Image:
        """The image (height, width, 3)."""
        if self._read is not None:
            self._image, self._read = self._read(), None
        assert self._image is not None
        return self._image
