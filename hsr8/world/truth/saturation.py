"""How near the joints come to what their servos can do."""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.world.model.index import ModelIndex

Array = NDArray[np.float64]

AT_LIMIT = 0.999  # share of the largest torque that counts as all of it [1]
CLIPPED = 1e-3  # so far beyond that end a set-point counts as cut off [rad]
TOUCHING = 1e-4  # so far beyond the end of its range a joint rests on its stop [rad]
BLOCK = 64  # control ticks that are looked at together


@dataclass(frozen=True, slots=True)
class Saturation:
    """What was asked of the servos since the start of the run, order of ``JOINT_NAMES``.

    Attributes:
        torque_any: control ticks with any joint at its largest torque.
        torque_ticks: the same by joint (26,).
        stop_any: control ticks with any joint at the end of its range.
        stop_ticks: the same by joint (26,).
        clip_any: control ticks with any set-point cut off at the end of a joint's range.
        clip_ticks: the same by joint (26,).
        peak_torque: largest share of the largest torque (26,) [1].
        peak_speed: largest speed (26,) [rad/s].
    """

    torque_any: int
    torque_ticks: NDArray[np.int64]
    stop_any: int
    stop_ticks: NDArray[np.int64]
    clip_any: int
    clip_ticks: NDArray[np.int64]
    peak_torque: Array
    peak_speed: Array


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
        # Ticks not yet looked at: a copy is cheap, looking is not.
        self._force, self._set = np.zeros((BLOCK, model.nu)), np.zeros((BLOCK, model.nu))
        self._angle, self._speed = np.zeros((BLOCK, model.nq)), np.zeros((BLOCK, model.nv))
        self._waiting = 0
        n = len(index.actuators)
        none = np.zeros(n, dtype=np.int64)
        self._seen = Saturation(0, none, 0, none, 0, none, np.zeros(n), np.zeros(n))

    def watch(self, data: mujoco.MjData) -> None:
        """Take the state after a control tick."""
        row = self._waiting
        self._force[row], self._set[row] = data.actuator_force, data.ctrl
        self._angle[row], self._speed[row] = data.qpos, data.qvel
        self._waiting = row + 1
        if self._waiting == BLOCK:
            self._look()

    def so_far(self) -> Saturation:
        """What was seen since the start of the run."""
        self._look()
        return self._seen

    def _look(self) -> None:
        if not self._waiting:
            return
        index, rows, before = self._index, slice(self._waiting), self._seen
        self._waiting = 0
        share = np.abs(self._force[rows, index.actuators]) / self._most
        angle, wanted = self._angle[rows, index.joint_qpos], self._set[rows, index.actuators]
        full = share >= AT_LIMIT
        stopped = (angle < self._lower) | (angle > self._upper)
        clipped = (wanted < self._least_set) | (wanted > self._most_set)
        speed = np.abs(self._speed[rows, index.joint_dof])
        self._seen = Saturation(
            torque_any=before.torque_any + int(full.any(axis=1).sum()),
            torque_ticks=before.torque_ticks + full.sum(axis=0),
            stop_any=before.stop_any + int(stopped.any(axis=1).sum()),
            stop_ticks=before.stop_ticks + stopped.sum(axis=0),
            clip_any=before.clip_any + int(clipped.any(axis=1).sum()),
            clip_ticks=before.clip_ticks + clipped.sum(axis=0),
            peak_torque=np.maximum(before.peak_torque, share.max(axis=0)),
            peak_speed=np.maximum(before.peak_speed, speed.max(axis=0)),
        )
