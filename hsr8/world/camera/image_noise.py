"""Image noise: exposure, grain, missing objects and false blobs."""

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from hsr8.scenario.sensors import CameraNoise
from vision.color import COLOR_CLASSES

Image = NDArray[np.uint8]

GRAIN_IMAGES = 6  # grain drawn once, of which every image takes a random stretch [images]
GRAIN_LIMIT = 127  # [grey level]
BLOB_PIXELS = (3, 30)  # half axes of a false blob in an image of 240 rows [pixel]
BLOB_BRIGHTNESS = (0.5, 1.0)
REFERENCE_HEIGHT = 240  # of the image that BLOB_PIXELS refers to [pixel]


class ImageNoise:
    """Seeded noise of one camera.

    Args:
        noise: magnitudes.
        shape: shape of an image (height, width).
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
            # Drawing new grain for every image would cost half as much as rendering it.
            grain = noise.pixel * rng.standard_normal(GRAIN_IMAGES * self._size, np.float32)
            grain = np.clip(np.round(grain), -GRAIN_LIMIT, GRAIN_LIMIT)
            brighter, darker = np.maximum(grain, 0.0), np.maximum(-grain, 0.0)
            self._grain = brighter.astype(np.uint8), darker.astype(np.uint8)

    def light(self) -> float:
        """Return the factor on all lights for the next image."""
        if self._noise.exposure == 0.0:
            return 1.0
        return max(0.05, 1.0 + self._noise.exposure * float(self._rng.standard_normal()))

    def missed(self, count: int, fraction: float) -> Sequence[int]:
        """Draw which of `count` objects the next image omits, a `fraction` of them on average."""
        if fraction == 0.0:
            return ()
        missed: list[int] = np.flatnonzero(self._rng.random(count) < fraction).tolist()
        return missed

    def apply(self, image: Image, blobs: float) -> Image:
        """Add false blobs, `blobs` on average, and grain to `image` in place; return it."""
        if blobs > 0.0:
            for _ in range(int(self._rng.poisson(blobs))):
                self._paint(image)
        if self._grain is None:
            return image
        start = int(self._rng.integers((GRAIN_IMAGES - 1) * self._size))
        stretch = slice(start, start + self._size)
        # Unsigned, saturating and in place: four times as fast as a clipped sum.
        brighter, darker = (part[stretch].reshape(self._shape) for part in self._grain)
        cv2.add(image, brighter, image)
        cv2.subtract(image, darker, image)
        return image

    def _paint(self, image: Image) -> None:
        """Paint one false blob: an ellipse in a colour of obstacles or beacons."""
        rng = self._rng
        height, width = image.shape[:2]
        scale = height / REFERENCE_HEIGHT
        centre = (int(rng.integers(width)), int(rng.integers(height)))
        low, high = (max(1, round(scale * pixels)) for pixels in BLOB_PIXELS)
        axes = (int(rng.integers(low, high + 1)), int(rng.integers(low, high + 1)))
        rgb = self._colors[rng.integers(len(self._colors))] * rng.uniform(*BLOB_BRIGHTNESS)
        color = np.round(255.0 * rgb).tolist()
        cv2.ellipse(image, centre, axes, 0.0, 0.0, 360.0, color, -1)
