"""The head camera: images rendered from the model's own camera, without a display."""

from typing import TYPE_CHECKING

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.gl import require_gl

if TYPE_CHECKING:
    from hsr8.world.body import Body

Image = NDArray[np.uint8]

HEAD_CAMERA = "egocentric"


class RenderedCamera:
    """Renders one camera of a model; close it after use, and use it in one thread only.

    Args:
        model: compiled world; its offscreen buffer must hold the image.
        width, height: size of the image [pixel].
        name: camera of the model.

    Raises:
        RenderingUnavailable: no OpenGL draws here.
    """

    def __init__(
        self, model: mujoco.MjModel, width: int, height: int, name: str = HEAD_CAMERA
    ) -> None:
        require_gl()
        self._name = name
        self._renderer = mujoco.Renderer(model, height=height, width=width)

    def capture(self, body: "Body") -> Image:
        """Image (height, width, 3) of the world as it is now."""
        body.update_kinematics()
        return self.render(body.data)

    def render(self, data: mujoco.MjData) -> Image:
        """Image (height, width, 3) of `data`, whose poses must be up to date."""
        self._renderer.update_scene(data, camera=self._name)
        image: Image = self._renderer.render()
        return image

    def close(self) -> None:
        """Free the OpenGL context."""
        self._renderer.close()
