"""What spoils a rendered image: light, grain, things not shown and things that are not there."""

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from hsr8.scenario.camera import CameraNoise
from vision.color import COLOR_CLASSES

Image = NDArray[np.uint8]

GRAIN_IMAGES = 6  # the grain of every image is a random stretch of so many images' grain
GRAIN_LIMIT = 127  # [grey level]
BLOB_PIXELS = (3, 30)  # half axes of a false blob, at 240 rows [pixel]
BLOB_LIGHT = (0.5, 1.0)  # how strongly a false blob is lit
USUAL_HEIGHT = 240  # of an image [pixel]


class ImageNoise:
    """Seeded noise of one camera.

    Args:
        noise: magnitudes.
        shape: of an image (height, width).
        rng: generator of this camera.
    """

    def __init__(
        self, noise: CameraNoise, shape: tuple[int, int], rng: np.random.Generator
    ) -> None:
        self._noise = noise
        self._rng = rng
        self._shape = (*shape, 3)
        self._size = 3 * shape[0] * shape[1]
        self._colors = np.array([c.rgb for c in COLOR_CLASSES.values()])
        self._grain: tuple[Image, Image] | None = None
        if noise.pixel > 0.0:
            # Drawing every image's grain afresh would cost half as much as rendering it.
            grain = noise.pixel * rng.standard_normal(GRAIN_IMAGES * self._size, np.float32)
            grain = np.clip(np.round(grain), -GRAIN_LIMIT, GRAIN_LIMIT)
            brighter, darker = np.maximum(grain, 0.0), np.maximum(-grain, 0.0)
            self._grain = brighter.astype(np.uint8), darker.astype(np.uint8)

    def light(self) -> float:
        """Factor on all lights for the next image."""
        if self._noise.exposure == 0.0:
            return 1.0
        return max(0.05, 1.0 + self._noise.exposure * float(self._rng.standard_normal()))

    def missed(self, things: int, share: float) -> Sequence[int]:
        """Which of so many things the next image does not show, a `share` of them on average."""
        if share == 0.0:
            return ()
        missed: list[int] = np.flatnonzero(self._rng.random(things) < share).tolist()
        return missed

    def apply(self, image: Image, ghosts: float) -> Image:
        """`image`, spoilt in place by `ghosts` false blobs on average and by grain."""
        if ghosts > 0.0:
            for _ in range(int(self._rng.poisson(ghosts))):
                self._paint(image)
        if self._grain is None:
            return image
        start = int(self._rng.integers((GRAIN_IMAGES - 1) * self._size))
        stretch = slice(start, start + self._size)
        # Unsigned and saturating: four times as fast as a sum that is clipped. In place: fresh
        # memory for an image costs more than the sums.
        brighter, darker = (part[stretch].reshape(self._shape) for part in self._grain)
        cv2.add(image, brighter, image)
        cv2.subtract(image, darker, image)
        return image

    def _paint(self, image: Image) -> None:
        """One false blob: an ellipse in a colour of obstacles or beacons."""
        rng = self._rng
        height, width = image.shape[:2]
        scale = height / USUAL_HEIGHT
        centre = (int(rng.integers(width)), int(rng.integers(height)))
        low, high = (max(1, round(scale * pixels)) for pixels in BLOB_PIXELS)
        axes = (int(rng.integers(low, high + 1)), int(rng.integers(low, high + 1)))
        rgb = self._colors[rng.integers(len(self._colors))] * rng.uniform(*BLOB_LIGHT)
        color = np.round(255.0 * rgb).tolist()
        cv2.ellipse(image, centre, axes, 0.0, 0.0, 360.0, color, -1)
