"""Rendered head camera: images from the camera of the model, without a display."""

from collections.abc import Callable
from functools import cache, partial
from typing import TYPE_CHECKING

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.robots.model.normal_form import HEAD_CAMERA
from hsr8.scenario.fault import ticks
from hsr8.scenario.sensors import Camera
from hsr8.world.camera.feed import CameraFaults
from hsr8.world.camera.frustum import Frustum
from hsr8.world.camera.image_noise import ImageNoise
from hsr8.world.camera.motion_blur import MotionBlur
from hsr8.world.camera.offscreen import Offscreen
from hsr8.world.model.assembly import FIELD

if TYPE_CHECKING:
    from hsr8.world.body.body import Body

Array = NDArray[np.float64]
Image = NDArray[np.uint8]

HIDDEN_GROUP = 5  # geom group that MuJoCo does not render


class RenderedCamera:
    """Renders the head camera of a model; close it after use, and use it in one thread only.

    Args:
        model: compiled world; its offscreen buffer must hold the image.
        settings: size and noise of the images.
        rng: generator of the noise.
        faults: faults of the images.

    Raises:
        RenderingUnavailable: OpenGL cannot render here.
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
        self._noise = ImageNoise(settings.noise, (settings.height, settings.width), rng)
        self._offscreen = Offscreen(model, HEAD_CAMERA, settings.width, settings.height)
        self._blur: MotionBlur | None = None
        if settings.shutter_ms > 0.0:
            self._blur = MotionBlur(settings.pinhole, 1e-3 * settings.shutter_ms)
        self._latest: Callable[[], Image] | None = None
        self._lights = _Lights(model)
        self._frustum = Frustum(model, HEAD_CAMERA, settings.width / settings.height)
        self._group, self._original_group = model.geom_group, model.geom_group.copy()
        bodies = [i for i in range(model.nbody) if model.body(i).name.startswith(FIELD)]
        self._objects = [
            slice(model.body_geomadr[i], model.body_geomadr[i] + model.body_geomnum[i])
            for i in bodies
        ]

    def capture(self, body: "Body") -> Callable[[], Image]:
        """Start an image (height, width, 3) of the present world; the result waits for it."""
        self._settle()
        body.update_kinematics()
        settings, noise, faults, tick = self._settings, self._noise, self._faults, ticks(body.time)
        light, missed = noise.light(), noise.missed(len(self._objects), faults.missed(tick))
        blobs = faults.false_detections(tick)
        if faults.black(tick):
            black = np.zeros((settings.height, settings.width, 3), np.uint8)
            self._latest = cache(lambda: noise.apply(black, blobs))
            return self._latest
        self._lights.set(light * faults.light(tick))
        hidden = self._frustum.outside(body.data)
        for i in missed:
            hidden[self._objects[i]] = True
        self._group[hidden] = HIDDEN_GROUP
        self._offscreen.begin(body.data)
        self._group[:] = self._original_group
        read = self._offscreen.read
        if self._blur is not None:
            read = partial(self._blurred, self._blur, angular_velocity(body.model, body.data))
        self._latest = cache(lambda: noise.apply(read(), blobs))
        return self._latest

    def _settle(self) -> None:
        """Read the latest image, so that noise is drawn in the order of the captures."""
        if self._latest is not None:
            self._latest()
            self._latest = None

    def close(self) -> None:
        """Free the OpenGL context."""
        self._offscreen.close()

    def _blurred(self, blur: MotionBlur, rate: Array) -> Image:
        return blur.blur(self._offscreen.read(), rate)


def angular_velocity(model: mujoco.MjModel, data: mujoco.MjData) -> Array:
    """Return the angular velocity of the head camera in its frame C (3,) [rad/s]."""
    mujoco.mj_comVel(model, data)
    velocity = np.zeros(6)
    camera = model.camera(HEAD_CAMERA).id
    mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_CAMERA, camera, velocity, 1)
    return velocity[:3] * (1.0, -1.0, -1.0)  # MuJoCo cameras look along -z with y up


class _Lights:
    """Dimmable lights of a model."""

    def __init__(self, model: mujoco.MjModel) -> None:
        self._factor = 1.0
        head = model.vis.headlight
        lights = (head.ambient, head.diffuse, model.light_diffuse)
        self._lights = [(light, light.copy()) for light in lights]

    def set(self, factor: float) -> None:
        """Scale all lights of the model by `factor`."""
        if factor == self._factor:
            return
        self._factor = factor
        for light, original in self._lights:
            light[:] = factor * original
