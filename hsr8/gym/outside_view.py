"""Images of a run from outside, by a camera that follows the robot."""

import numpy as np

from hsr8.robots.scale import DEFAULT_STATURE
from hsr8.robots.shown import stature
from hsr8.show.follow import FollowCamera
from hsr8.show.scene_renderer import Image, SceneRenderer
from hsr8.simulation.loop import Simulation
from hsr8.world.model.assembly import Optics
from hsr8.world.truth.truth import Truth

SIZE = 640, 480  # width and height [pixel]
HISTORY = 60  # images over which the motion of the camera is smoothed


class OutsideView:
    """Images of one run; close it.

    Args:
        simulation: simulation to show.
        fps: images per second of simulated time.

    Raises:
        RenderingUnavailable: there is no OpenGL.
    """

    def __init__(self, simulation: Simulation, fps: float) -> None:
        robot, world = simulation.humanoid, simulation.scenario.world
        self._fps, self._size = fps, stature(robot) / DEFAULT_STATURE
        self._qpos: list[np.ndarray] = []
        self._drawn: Truth | None = None
        self._renderer = SceneRenderer(
            robot,
            simulation.layout,
            "show",
            SIZE,
            optics=Optics(brightness=world.brightness),
            oversampling=1.0,
            fine=False,
        )

    def draw(self, truth: Truth) -> Image:
        """Return an image (height, width, 3), the same for the same truth."""
        if truth is not self._drawn:
            self._qpos = [*self._qpos[1 - HISTORY :], truth.qpos]
            self._drawn = truth
        self._renderer.set_state(truth.qpos, truth.obstacle_positions)
        follow = FollowCamera(np.array(self._qpos), self._fps, 1.0, self._size)
        return self._renderer.draw(follow.at(-1))

    def close(self) -> None:
        """Free the OpenGL context."""
        self._renderer.close()
