"""Renderer of a recorded world from any camera."""

from collections.abc import Sequence

import cv2
import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.process.gl import require_gl
from hsr8.robots.loaded import LoadedRobot
from hsr8.show.push_arrows import Arrow
from hsr8.suggestion import suggestion
from hsr8.world.camera.offscreen import camera_option
from hsr8.world.field.layout import Layout
from hsr8.world.model.assembly import FIELD, Optics, Quality, assemble

Array = NDArray[np.float64]
Image = NDArray[np.uint8]

ARROW = np.array([0.90, 0.20, 0.45, 1.0], dtype=np.float32)  # colour of arrows
ARROW_RADIUS = 0.012  # in a world of scale 1 [m]
SHADOW_SIZE = {True: 4096, False: 1536}  # of fine and of quick images [texel]
SHADOW_CONE = 0.48  # fraction of the sun's cone with shadows: up to the rim of the field
EDGE = 24  # minimum difference of a pixel on an edge to the mean of its neighbours, of 255
MAX_SIDE = 8192  # of an image before it is scaled down [pixel]


class SceneRenderer:
    """Renderer of a layout with robot and movers; use it in one thread only and close it.

    Args:
        robot: robot of the run.
        layout: layout of the run's world.
        quality: ``show`` for people, ``vision`` for the robot's camera.
        size: width and height of the images [pixel].
        optics: optics of the head camera.
        oversampling: factor by which images are drawn larger along each side.
        fine: sharp shadows; for ``show`` only.

    Raises:
        RenderingUnavailable: there is no OpenGL.
    """

    def __init__(
        self,
        robot: LoadedRobot,
        layout: Layout,
        quality: Quality,
        size: tuple[int, int],
        *,
        optics: Optics,
        oversampling: float,
        fine: bool,
    ) -> None:
        require_gl()
        self.model = assemble(robot, layout, quality, optics)
        self.data = mujoco.MjData(self.model)
        self._movers = np.array(
            [
                self.model.body(f"{FIELD}mover_{i:02d}").mocapid[0]
                for i in range(len(layout.movers))
            ],
            dtype=np.intp,
        )
        self._arrow_radius = ARROW_RADIUS * layout.scale
        visual = self.model.vis
        self._size, self._soft = size, quality == "show"
        self._option = mujoco.MjvOption() if quality == "show" else camera_option()
        oversampling = min(oversampling, MAX_SIDE / max(size))
        width, height = (round(oversampling * side) for side in size)
        visual.global_.offwidth, visual.global_.offheight = width, height
        if quality == "show":
            visual.quality.offsamples = 0  # oversampling smooths shadows and textures, too
            visual.quality.numslices, visual.quality.numstacks = 16, 10
            visual.quality.shadowsize = SHADOW_SIZE[fine]
            visual.map.shadowscale = SHADOW_CONE
            self.model.mat_reflectance[:] = 0.0  # a reflection draws the scene twice
        self._renderer = mujoco.Renderer(self.model, height=height, width=width)

    def set_state(self, qpos: Array, obstacles: Array) -> None:
        """Set the configuration of the robot and the positions of all obstacles (n, 2) [m]."""
        self.data.qpos[:] = qpos
        self.data.mocap_pos[self._movers, :2] = obstacles[len(obstacles) - len(self._movers) :]
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_comPos(self.model, self.data)
        mujoco.mj_camlight(self.model, self.data)

    def draw(self, view: str | mujoco.MjvCamera, arrows: Sequence[Arrow] = ()) -> Image:
        """Return an image (height, width, 3).

        Args:
            view: camera of the model or a free one.
            arrows: tail and tip of each in W (3,) [m].
        """
        scene, camera = self._renderer.scene, self._camera(view)
        # An infinite plane is centred below the camera of the scene, else that of the last image.
        mujoco.mjv_updateCamera(self.model, self.data, camera, scene)
        self._renderer.update_scene(self.data, camera=camera, scene_option=self._option)
        for geom in scene.geoms[: scene.ngeom]:
            if geom.type == mujoco.mjtGeom.mjGEOM_PLANE:
                geom.category = mujoco.mjtCatBit.mjCAT_DECOR  # casts no shadow, which takes time
        for tail, tip in arrows[: scene.maxgeom - scene.ngeom]:
            geom = scene.geoms[scene.ngeom]
            kind = mujoco.mjtGeom.mjGEOM_ARROW
            mujoco.mjv_initGeom(geom, kind, np.zeros(3), np.zeros(3), np.eye(3).ravel(), ARROW)
            mujoco.mjv_connector(geom, kind, self._arrow_radius, tail, tip)
            scene.ngeom += 1
        image: Image = self._renderer.render()
        if image.shape[1::-1] != self._size:
            image = cv2.resize(image, self._size, interpolation=cv2.INTER_AREA)
        elif self._soft:
            soften(image)
        return image

    def require_camera(self, name: str) -> None:
        """Refuse a camera that the model lacks.

        Raises:
            UsageError: unknown camera.
        """
        cameras = [self.model.camera(i).name for i in range(self.model.ncam)]
        names = [camera.removeprefix(FIELD) for camera in cameras]
        if name not in names:
            choices = list(dict.fromkeys(("dashboard", "follow", "head", *names)))
            raise UsageError(
                f"camera: unknown name {name!r}{suggestion(name, choices)}; "
                f"expected one of {', '.join(choices)}"
            )

    def _camera(self, view: str | mujoco.MjvCamera) -> mujoco.MjvCamera:
        if not isinstance(view, str):
            return view
        camera = mujoco.MjvCamera()
        camera.type = mujoco.mjtCamera.mjCAMERA_FIXED
        names = [self.model.camera(i).name for i in range(self.model.ncam)]
        camera.fixedcamid = names.index(f"{FIELD}{view}" if f"{FIELD}{view}" in names else view)
        return camera

    def close(self) -> None:
        """Free the OpenGL context."""
        self._renderer.close()


def soften(image: Image) -> None:
    """Blur the edges of `image` (height, width, 3); a tenth of the cost of oversampling."""
    edges = np.abs(cv2.Laplacian(cv2.cvtColor(image, cv2.COLOR_RGB2GRAY), cv2.CV_16S)) > EDGE
    cv2.copyTo(cv2.GaussianBlur(image, (3, 3), 0.0), edges.astype(np.uint8), image)
