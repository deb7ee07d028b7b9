"""The head camera: images rendered from the model's own camera, without a display."""

from typing import TYPE_CHECKING

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.gl import require_gl
from hsr8.scenario.camera import Camera
from hsr8.world.image_noise import ImageNoise

if TYPE_CHECKING:
    from hsr8.world.body import Body

Image = NDArray[np.uint8]

HEAD_CAMERA = "egocentric"
THINGS = ("obstacle_", "mover_", "beacon_")  # names of what the robot looks for begin so
AWAY = -100.0  # where what an image does not show is drawn [m]


class RenderedCamera:
    """Renders the head camera of a model; close it after use, and use it in one thread only.

    Args:
        model: compiled world; its offscreen buffer must hold the image.
        settings: size, noise and faults of the images.
        rng: generator of the noise.

    Raises:
        RenderingUnavailable: no OpenGL draws here.
    """

    def __init__(self, model: mujoco.MjModel, settings: Camera, rng: np.random.Generator) -> None:
        require_gl()
        self._settings = settings
        self._noise = ImageNoise(settings.noise, (settings.height, settings.width), rng)
        self._renderer = mujoco.Renderer(model, height=settings.height, width=settings.width)
        self._lights = _Lights(model)
        bodies = [i for i in range(model.nbody) if model.body(i).name.startswith(THINGS)]
        self._things = [
            range(model.body_geomadr[i], model.body_geomadr[i] + model.body_geomnum[i])
            for i in bodies
        ]

    def capture(self, body: "Body") -> Image:
        """Image (height, width, 3) of the world as it is now."""
        body.update_kinematics()
        settings, noise = self._settings, self._noise
        light, missed = noise.light(), noise.missed(len(self._things))
        if settings.black(body.time):
            return noise.spoil(np.zeros((settings.height, settings.width, 3), np.uint8))
        self._lights.set(light * settings.light(body.time))
        self._renderer.update_scene(body.data, camera=HEAD_CAMERA)
        if missed:
            self._take_away({geom for i in missed for geom in self._things[i]})
        image: Image = self._renderer.render()
        return noise.spoil(image)

    def close(self) -> None:
        """Free the OpenGL context."""
        self._renderer.close()

    def _take_away(self, geoms: set[int]) -> None:
        """Leave geoms of the model out of the scene that is to be drawn."""
        scene = self._renderer.scene
        for shape in scene.geoms[: scene.ngeom]:
            if shape.objtype == mujoco.mjtObj.mjOBJ_GEOM and shape.objid in geoms:
                shape.pos[2] = AWAY


class _Lights:
    """The lights of a model, which can be dimmed."""

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model = model
        self._factor = 1.0
        head = model.vis.headlight
        self._usual = (head.ambient.copy(), head.diffuse.copy(), model.light_diffuse.copy())

    def set(self, factor: float) -> None:
        """Make all lights `factor` times as strong as the model has them."""
        if factor == self._factor:
            return
        self._factor = factor
        head = self._model.vis.headlight
        ambient, diffuse, lights = self._usual
        head.ambient[:] = factor * ambient
        head.diffuse[:] = factor * diffuse
        self._model.light_diffuse[:] = factor * lights
