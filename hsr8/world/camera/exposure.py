"""Image that is read only when it is needed, so that rendering runs in parallel."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Image = NDArray[np.uint8]


class Exposure:
    """One image of a camera, read at most once.

    Args:
        read: waits until the image is rendered and returns it.
    """

    __slots__ = ("_image", "_read")

    def __init__(self, read: Callable[[], Image]) -> None:
        self._read: Callable[[], Image] | None = read
        self._image: Image | None = None

    def image(self) -> Image:
        """Return the image (height, width, 3)."""
        if self._read is not None:
            self._image, self._read = self._read(), None
        assert self._image is not None
        return self._image
