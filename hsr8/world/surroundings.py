"""What surrounds the body in its model: the obstacles, where they are and how it touches them."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.world.contacts import ContactWatch
from hsr8.world.index import ModelIndex
from hsr8.world.layout import Layout

Array = NDArray[np.float64]


class Surroundings:
    """The obstacles of a layout in its compiled model.

    Args:
        model: compiled world.
        layout: what stands and moves in it.

    Attributes:
        index: addresses in the model.
        watch: contacts of the robot.
    """

    def __init__(self, model: mujoco.MjModel, layout: Layout) -> None:
        static = layout.static
        self._movers = layout.motion()
        self._static = np.array([o.position for o in static], dtype=float).reshape(-1, 2)
        self._still = np.zeros_like(self._static)
        self.index = ModelIndex.of(model, len(static), len(self._movers))
        self.watch = ContactWatch(model, self.index, len(static))

    def move(self, data: mujoco.MjData, time: float) -> None:
        """Put every mover where its law wants it at `time` [s]."""
        if len(self._movers):
            data.mocap_pos[self.index.mover_mocap, :2] = self._movers.positions(time)

    def positions(self, time: float) -> Array:
        """Axes of all obstacles at `time` [s], layout order (n, 2) [m]."""
        return np.concatenate([self._static, self._movers.positions(time)])

    def velocities(self, time: float) -> Array:
        """Velocities of all obstacles at `time` [s], layout order (n, 2) [m/s]."""
        return np.concatenate([self._still, self._movers.velocities(time)])
