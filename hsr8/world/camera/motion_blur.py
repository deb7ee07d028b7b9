"""What the turning of a camera makes of an image while it is exposed."""

import cv2
import numpy as np
from numpy.typing import NDArray

from vision.camera import PinholeCamera

Array = NDArray[np.float64]
Image = NDArray[np.uint8]


class MotionBlur:
    """Smears images as a camera does that turns while its shutter is open.

    An image shows the mean of all that the camera sees as it turns evenly about the moment of
    its capture. Only turning counts: what moves by 0.2 m/s is smeared by 2 mm in 10 ms, a head
    at 6 rad/s smears by 3.4 deg. What comes in from beyond the border continues the border.

    Args:
        camera: which takes the images.
        shutter: time for which one is exposed [s].
    """

    def __init__(self, camera: PinholeCamera, shutter: float) -> None:
        self._shutter = shutter
        width, height, focal = camera.width, camera.height, camera.focal
        # OpenCV counts from the middle of the first pixel.
        self._matrix = np.array(
            [[focal, 0.0, 0.5 * (width - 1)], [0.0, focal, 0.5 * (height - 1)], [0.0, 0.0, 1.0]]
        )
        self._inverse = np.linalg.inv(self._matrix)
        corners = np.array([[0, 0], [width, 0], [0, height], [width, height]], float)
        self._corners = corners.reshape(-1, 1, 2)

    def smear(self, image: Image, turning: Array) -> Image:
        """`image`, exposed while the camera turns.

        Args:
            image: as sharp as if nothing turned (height, width, 3).
            turning: angular velocity of the camera in its own frame C (3,) [rad/s].
        """
        turned = self._shutter * np.asarray(turning, float)
        ends = [
            cv2.perspectiveTransform(self._corners, self._warp(s * turned)) for s in (-0.5, 0.5)
        ]
        looks = 1 + round(0.5 * float(np.abs(ends[1] - ends[0]).max()))  # one every two pixels
        if looks == 1:
            return image
        size, total = image.shape[1::-1], np.zeros(image.shape, np.float32)
        for share in (np.arange(looks) + 0.5) / looks - 0.5:
            seen = cv2.warpPerspective(
                image, self._warp(share * turned), size, borderMode=cv2.BORDER_REPLICATE
            )
            cv2.accumulate(seen, total)
        return np.round(total / looks).astype(np.uint8)

    def _warp(self, rotation: Array) -> Array:
        """Where points of the image are once the camera has turned by a rotation vector (3,)."""
        warp: Array = self._matrix @ cv2.Rodrigues(-rotation)[0] @ self._inverse
        return warp
