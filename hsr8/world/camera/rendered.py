"""The head camera: images rendered from the model's own camera, without a display."""

from functools import partial
from typing import TYPE_CHECKING

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.scenario.camera import Camera
from hsr8.scenario.fault import ticks
from hsr8.world.camera.exposure import Exposure
from hsr8.world.camera.faults import CameraFaults
from hsr8.world.camera.frustum import Frustum
from hsr8.world.camera.image_noise import ImageNoise
from hsr8.world.camera.motion_blur import MotionBlur
from hsr8.world.camera.offscreen import Offscreen
from hsr8.world.model.assembly import HEAD_CAMERA
from vision.camera import PinholeCamera

if TYPE_CHECKING:
    from hsr8.world.body.body import Body

Array = NDArray[np.float64]
Image = NDArray[np.uint8]

THINGS = ("obstacle_", "mover_", "beacon_")  # names of what the robot looks for begin so
NOT_DRAWN = 5  # a group of geoms that MuJoCo does not draw


class RenderedCamera:
    """Renders the head camera of a model; close it after use, and use it in one thread only.

    Args:
        model: compiled world; its offscreen buffer must hold the image.
        settings: size and noise of the images.
        rng: generator of the noise.
        faults: of the images.

    Raises:
        RenderingUnavailable: no OpenGL draws here.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        settings: Camera,
        rng: np.random.Generator,
        faults: CameraFaults | None = None,
    ) -> None:
        self._faults = faults or CameraFaults()
        self._settings = settings
        self.noise = ImageNoise(settings.noise, (settings.height, settings.width), rng)
        self._offscreen = Offscreen(model, HEAD_CAMERA, settings.width, settings.height)
        self._blur: MotionBlur | None = None
        if settings.shutter_ms > 0.0:
            fov = settings.vertical_fov
            optics = PinholeCamera.from_vertical_fov(settings.width, settings.height, fov)
            self._blur = MotionBlur(optics, 1e-3 * settings.shutter_ms)
        self._latest: Exposure | None = None
        self._lights = _Lights(model)
        self._frustum = Frustum(model, HEAD_CAMERA, settings.width / settings.height)
        self._group, self._usual_group = model.geom_group, model.geom_group.copy()
        bodies = [i for i in range(model.nbody) if model.body(i).name.startswith(THINGS)]
        self._things = [
            slice(model.body_geomadr[i], model.body_geomadr[i] + model.body_geomnum[i])
            for i in bodies
        ]

    def capture(self, body: "Body") -> Exposure:
        """Image (height, width, 3) of the world as it is now; it need not be drawn yet."""
        self.settle()
        body.update_kinematics()
        settings, noise, faults, tick = self._settings, self.noise, self._faults, ticks(body.time)
        light, missed = noise.light(), noise.missed(len(self._things), faults.missed(tick))
        ghosts = faults.ghosts(tick)
        if faults.black(tick):
            black = np.zeros((settings.height, settings.width, 3), np.uint8)
            self._latest = Exposure(lambda: noise.apply(black, ghosts))
            return self._latest
        self._lights.set(light * faults.light(tick))
        away = self._frustum.misses(body.data)
        for i in missed:
            away[self._things[i]] = True
        self._group[away] = NOT_DRAWN
        self._offscreen.begin(body.data)
        self._group[:] = self._usual_group
        read = self._offscreen.read
        if self._blur is not None:
            read = partial(self._blurred, self._blur, turning(body.model, body.data))
        self._latest = Exposure(lambda: noise.apply(read(), ghosts))
        return self._latest

    def settle(self) -> None:
        """Wait for the latest image, also when nobody asks for it: its noise is drawn in turn."""
        if self._latest is not None:
            self._latest.image()
            self._latest = None

    def close(self) -> None:
        """Free the OpenGL context."""
        self._offscreen.close()

    def _blurred(self, blur: MotionBlur, rate: Array) -> Image:
        return blur.smear(self._offscreen.read(), rate)


def turning(model: mujoco.MjModel, data: mujoco.MjData) -> Array:
    """Angular velocity of the head camera in its frame C, right, down and ahead (3,) [rad/s]."""
    mujoco.mj_comVel(model, data)
    velocity = np.zeros(6)
    camera = model.camera(HEAD_CAMERA).id
    mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_CAMERA, camera, velocity, 1)
    return velocity[:3] * (1.0, -1.0, -1.0)  # MuJoCo's camera looks along -z with y up


class _Lights:
    """The lights of a model, which can be dimmed."""

    def __init__(self, model: mujoco.MjModel) -> None:
        self._factor = 1.0
        head = model.vis.headlight
        lights = (head.ambient, head.diffuse, model.light_diffuse)
        self._lights = [(light, light.copy()) for light in lights]

    def set(self, factor: float) -> None:
        """Make all lights `factor` times as strong as the model has them."""
        if factor == self._factor:
            return
        self._factor = factor
        for light, usual in self._lights:
            light[:] = factor * usual
