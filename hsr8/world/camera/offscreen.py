"""Asynchronous offscreen rendering: start an image, read it later."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.process.gl import flush, require_gl

Image = NDArray[np.uint8]

MAX_GEOMS = 10000  # per image


def camera_option() -> mujoco.MjvOption:
    """Return the drawing options of the head camera: solid meshes are drawn as convex hulls."""
    option = mujoco.MjvOption()
    option.flags[mujoco.mjtVisFlag.mjVIS_CONVEXHULL] = True
    return option


class Offscreen:
    """Renders one camera of a model; close it after use, and use it in one thread only.

    OpenGL renders in parallel from `begin` to `read`; `mujoco.Renderer` would wait at once.

    Args:
        model: compiled world; its offscreen buffer must hold the image.
        camera: name of the camera.
        width, height: width and height of the image [pixel].

    Raises:
        RenderingUnavailable: OpenGL cannot render here.
    """

    def __init__(self, model: mujoco.MjModel, camera: str, width: int, height: int) -> None:
        require_gl()
        self._model = model
        self._scene = mujoco.MjvScene(model, maxgeom=MAX_GEOMS)
        self._option = camera_option()
        self._camera = mujoco.MjvCamera()
        self._camera.type = mujoco.mjtCamera.mjCAMERA_FIXED
        self._camera.fixedcamid = model.camera(camera).id
        self._rect = mujoco.MjrRect(0, 0, width, height)
        self._upside_down = np.empty((height, width, 3), np.uint8)
        self._context: mujoco.GLContext | None = mujoco.GLContext(width, height)
        self._context.make_current()
        self._drawing = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_150)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._drawing)

    def begin(self, data: mujoco.MjData) -> None:
        """Start rendering the present `data`, which may change after the call."""
        everything = mujoco.mjtCatBit.mjCAT_ALL
        mujoco.mjv_updateScene(
            self._model, data, self._option, None, self._camera, everything, self._scene
        )
        self._make_current()
        mujoco.mjr_render(self._rect, self._scene, self._drawing)
        flush()

    def read(self) -> Image:
        """Wait for the image started last and return it (height, width, 3)."""
        self._make_current()
        mujoco.mjr_readPixels(self._upside_down, None, self._rect, self._drawing)
        return self._upside_down[::-1].copy()

    def close(self) -> None:
        """Free the OpenGL context."""
        if self._context is not None:
            self._make_current()
            self._drawing.free()
            self._context.free()
            self._context = None

    def _make_current(self) -> None:
        """Select the context: other renderers may have changed it."""
        assert self._context is not None
        self._context.make_current()
