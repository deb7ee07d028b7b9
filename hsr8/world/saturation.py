"""How near the joints come to what their servos can do."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.world.index import ModelIndex
from hsr8.world.truth import Saturation

Array = NDArray[np.float64]

AT_LIMIT = 0.999  # share of the largest torque that counts as all of it [1]
CLIPPED = 1e-3  # so far beyond that end a set-point counts as cut off [rad]
TOUCHING = 1e-4  # so far beyond the end of its range a joint rests on its stop [rad]


class SaturationWatch:
    """Watches torque, range and speed of every joint in every control tick.

    Args:
        model: compiled world.
        index: addresses in it.
    """

    def __init__(self, model: mujoco.MjModel, index: ModelIndex) -> None:
        self._index = index
        self._most = np.array(model.actuator_forcerange[index.actuators, 1])
        low, high = model.actuator_ctrlrange[index.actuators].T
        self._least_set, self._most_set = low - CLIPPED, high + CLIPPED
        ranges = model.jnt_range[model.dof_jntid[index.joint_dof]]
        self._lower, self._upper = ranges[:, 0] - TOUCHING, ranges[:, 1] + TOUCHING
        n = len(index.actuators)
        self._torque_ticks = np.zeros(n, dtype=np.int64)
        self._stop_ticks = np.zeros(n, dtype=np.int64)
        self._clip_ticks = np.zeros(n, dtype=np.int64)
        self._torque_any = self._stop_any = self._clip_any = 0
        self._peak_torque, self._peak_speed = np.zeros(n), np.zeros(n)

    def watch(self, data: mujoco.MjData) -> None:
        """Take the state after a control tick."""
        index = self._index
        share = np.abs(data.actuator_force[index.actuators]) / self._most
        np.maximum(self._peak_torque, share, out=self._peak_torque)
        speed = np.abs(data.qvel[index.joint_dof])
        np.maximum(self._peak_speed, speed, out=self._peak_speed)
        if share.max() >= AT_LIMIT:
            self._torque_any += 1
            self._torque_ticks += share >= AT_LIMIT
        angle = data.qpos[index.joint_qpos]
        stopped = (angle < self._lower) | (angle > self._upper)
        if stopped.any():
            self._stop_any += 1
            self._stop_ticks += stopped
        wanted = data.ctrl[index.actuators]
        clipped = (wanted < self._least_set) | (wanted > self._most_set)
        if clipped.any():
            self._clip_any += 1
            self._clip_ticks += clipped

    def so_far(self) -> Saturation:
        """What was seen since the start of the run."""
        return Saturation(
            torque_any=self._torque_any,
            torque_ticks=self._torque_ticks.copy(),
            stop_any=self._stop_any,
            stop_ticks=self._stop_ticks.copy(),
            clip_any=self._clip_any,
            clip_ticks=self._clip_ticks.copy(),
            peak_torque=self._peak_torque.copy(),
            peak_speed=self._peak_speed.copy(),
        )
