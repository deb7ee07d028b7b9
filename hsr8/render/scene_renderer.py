"""A recorded world set up again, to be drawn from any camera."""

from collections.abc import Sequence

import cv2
import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.gl import require_gl
from hsr8.render.push_arrows import Arrow
from hsr8.suggestion import suggestion
from hsr8.world.field.layout import Layout
from hsr8.world.model.assembly import Optics, Quality, assemble

Array = NDArray[np.float64]
Image = NDArray[np.uint8]


ARROW = np.array([0.90, 0.20, 0.45, 1.0], dtype=np.float32)  # colour of arrows
ARROW_RADIUS = 0.012  # [m]
SHADOW_SIZE = {True: 4096, False: 2048}  # of fine and of quick pictures [texel]
SHADOW_CONE = 0.48  # share of the sun's cone that is searched for shadows
EDGE = 24  # a pixel that differs so much from the mean of its neighbours is on an edge, of 255
LARGEST = 8192  # side of what is drawn before it is scaled down [pixel]


class SceneRenderer:
    """Draws a layout with the robot and the movers where a recording had them.

    Use it as a context manager and in one thread only.

    Args:
        layout: of the run's world.
        quality: ``show`` for people, ``vision`` for what the robot saw.
        size: width and height of the pictures [pixel].
        optics: of the head camera.
        finer: pictures are drawn so many times as fine along each side, and scaled down.
        fine: sharp shadows; for ``show`` only.

    Raises:
        RenderingUnavailable: no OpenGL draws here.
    """

    def __init__(
        self,
        layout: Layout,
        quality: Quality,
        size: tuple[int, int],
        *,
        optics: Optics,
        finer: float,
        fine: bool,
    ) -> None:
        require_gl()
        self.model = assemble(layout, quality, optics)
        self.data = mujoco.MjData(self.model)
        self._movers = np.array(
            [self.model.body(f"mover_{i:02d}").mocapid[0] for i in range(len(layout.movers))],
            dtype=np.intp,
        )
        visual = self.model.vis
        self._size, self._soft = size, quality == "show"
        finer = min(finer, LARGEST / max(size))
        width, height = (round(finer * side) for side in size)
        visual.global_.offwidth, visual.global_.offheight = width, height
        if quality == "show":
            visual.quality.offsamples = 0  # `finer` smooths shadows and texture, too
            visual.quality.numslices, visual.quality.numstacks = 16, 10
            visual.quality.shadowsize = SHADOW_SIZE[fine]
            # The sun's shadows reach the rim of the field, no further, so that they are sharp.
            visual.map.shadowscale = SHADOW_CONE
            # A reflection would draw everything twice.
            self.model.mat_reflectance[:] = 0.0
        self._renderer = mujoco.Renderer(self.model, height=height, width=width)

    def place(self, qpos: Array, movers: Array) -> None:
        """Put the robot and the movers (n, 2) [m] where they were."""
        self.data.qpos[:] = qpos
        self.data.mocap_pos[self._movers, :2] = movers
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_comPos(self.model, self.data)
        mujoco.mj_camlight(self.model, self.data)

    def draw(self, view: str | mujoco.MjvCamera, arrows: Sequence[Arrow] = ()) -> Image:
        """Picture (height, width, 3) from a camera of the model or a free one.

        Args:
            view: camera.
            arrows: tail and tip of each in W (3,) [m].
        """
        self._renderer.update_scene(self.data, camera=view)
        scene = self._renderer.scene
        for tail, tip in arrows:
            if scene.ngeom >= scene.maxgeom:
                break
            geom = scene.geoms[scene.ngeom]
            kind = mujoco.mjtGeom.mjGEOM_ARROW
            mujoco.mjv_initGeom(geom, kind, np.zeros(3), np.zeros(3), np.eye(3).ravel(), ARROW)
            mujoco.mjv_connector(geom, kind, ARROW_RADIUS, tail, tip)
            scene.ngeom += 1
        image: Image = self._renderer.render()
        if image.shape[1::-1] != self._size:
            image = cv2.resize(image, self._size, interpolation=cv2.INTER_AREA)
        elif self._soft:
            soften(image)
        return image

    def require_camera(self, name: str) -> None:
        """Make sure that the model has a camera.

        Raises:
            UsageError: it has not; the message names those it has.
        """
        names = [self.model.camera(i).name for i in range(self.model.ncam)]
        if name not in names:
            choices = list(dict.fromkeys(("dashboard", "follow", "head", *names)))
            raise UsageError(
                f"there is no camera {name!r}{suggestion(name, choices)} "
                f"(cameras: {', '.join(choices)})"
            )

    def close(self) -> None:
        """Free the OpenGL context."""
        self._renderer.close()


def soften(image: Image) -> None:
    """Blur the edges in `image` (height, width, 3), whose steps show where it is drawn once.

    It costs a tenth of what drawing finer does.
    """
    edges = np.abs(cv2.Laplacian(cv2.cvtColor(image, cv2.COLOR_RGB2GRAY), cv2.CV_16S)) > EDGE
    cv2.copyTo(cv2.GaussianBlur(image, (3, 3), 0.0), edges.astype(np.uint8), image)
