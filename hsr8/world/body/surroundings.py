"""What surrounds the body in its model: the obstacles, where they are and how it touches them."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.world.field.layout import Layout
from hsr8.world.model.index import ModelIndex
from hsr8.world.truth.contacts import ContactWatch

Array = NDArray[np.float64]

BLOCK = 256  # physics steps for which the movers' places are computed at a time


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
        self._n_static = len(static)
        self._places = np.zeros((len(layout.obstacles), 2))  # of what stands, and room for movers
        self._places[: len(static)] = np.reshape([o.position for o in static], (-1, 2))
        self._still = np.zeros_like(self._places)
        self.index = ModelIndex.of(model, len(static), len(self._movers))
        self.watch = ContactWatch(model, self.index, layout)
        self._timestep = float(model.opt.timestep)
        self._first, self._block = -BLOCK, np.zeros((BLOCK, model.nmocap, 3))

    def move(self, data: mujoco.MjData, time: float) -> None:
        """Put every mover where its law wants it at `time` [s]."""
        if len(self._movers):
            data.mocap_pos[self.index.mover_mocap, :2] = self._movers.positions(time)

    def step(self, data: mujoco.MjData, number: int) -> None:
        """Put every mover where it is at the end of physics step `number`, counted from 0."""
        if len(self._movers) == 0:
            return
        if not 0 <= number - self._first < BLOCK:
            self._first = number
            ends = np.arange(number + 1.0, number + 1.0 + BLOCK) * self._timestep
            self._block[:] = data.mocap_pos
            self._block[:, self.index.mover_mocap, :2] = self._movers.positions(ends)
        data.mocap_pos[:] = self._block[number - self._first]

    def positions(self, time: float) -> Array:
        """Axes of all obstacles at `time` [s], layout order (n, 2) [m]."""
        return self._with(self._places, self._movers.positions(time))

    def placed(self, data: mujoco.MjData) -> Array:
        """Axes of all obstacles where they were put last, layout order (n, 2) [m]."""
        movers = data.mocap_pos.take(self.index.mover_mocap, axis=0)
        return self._with(self._places, movers[:, :2])

    def velocities(self, time: float) -> Array:
        """Velocities of all obstacles at `time` [s], layout order (n, 2) [m/s]."""
        return self._with(self._still, self._movers.velocities(time))

    def _with(self, static: Array, movers: Array) -> Array:
        """Rows of what stands, then those of the movers."""
        rows = static.copy()
        rows[self._n_static :] = movers
        return rows
