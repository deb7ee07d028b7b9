"""Saturation of the servos: torque, range and speed of the joints against their limits."""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.robots.tree import max_torque
from hsr8.world.model.index import ModelIndex

Array = NDArray[np.float64]

AT_LIMIT = 0.999  # fraction of the maximum torque that counts as saturated [1]
TOUCHING = 1e-4  # angle beyond the range at which a joint touches its stop [rad]
BLOCK = 64  # control ticks evaluated at a time


@dataclass(frozen=True, slots=True)
class Saturation:
    """Saturation of the servos since the start of the run, in the order of walking.

    Attributes:
        names: of the joints (n,).
        torque_any: control ticks with any joint at its maximum torque.
        torque_ticks: control ticks at maximum torque, by joint (n,).
        stop_any: control ticks with any joint at the end of its range.
        stop_ticks: control ticks at the end of the range, by joint (n,).
        peak_torque: peak torque over maximum torque (n,) [1].
        peak_speed: peak speed (n,) [rad/s].
    """

    names: tuple[str, ...]
    torque_any: int
    torque_ticks: NDArray[np.int64]
    stop_any: int
    stop_ticks: NDArray[np.int64]
    peak_torque: Array
    peak_speed: Array


class SaturationWatch:
    """Counts saturated joints in every control tick.

    Args:
        model: compiled world.
        index: addresses in the model.
    """

    def __init__(self, model: mujoco.MjModel, index: ModelIndex) -> None:
        self._index = index
        joints = model.dof_jntid[index.joint_dof]
        self._max_torque = max_torque(model, joints, index.actuators)
        limited = model.jnt_limited[joints, None] != 0
        ranges = np.where(limited, model.jnt_range[joints], [-np.inf, np.inf])
        self._lower, self._upper = ranges[:, 0] - TOUCHING, ranges[:, 1] + TOUCHING
        # Pending ticks: copying one is cheap, evaluating one is not.
        self._force = np.zeros((BLOCK, model.nu))
        self._angle, self._speed = np.zeros((BLOCK, model.nq)), np.zeros((BLOCK, model.nv))
        self._pending = 0
        n = len(index.actuators)
        none = np.zeros(n, dtype=np.int64)
        self._total = Saturation(index.names, 0, none, 0, none, np.zeros(n), np.zeros(n))

    def watch(self, data: mujoco.MjData) -> None:
        """Add the state after a control tick."""
        row = self._pending
        self._force[row], self._angle[row] = data.actuator_force, data.qpos
        self._speed[row] = data.qvel
        self._pending = row + 1
        if self._pending == BLOCK:
            self._evaluate()

    def so_far(self) -> Saturation:
        """Return the saturation since the start of the run."""
        if self._pending:
            self._evaluate()
        return self._total

    def _evaluate(self) -> None:
        index, rows, before = self._index, slice(self._pending), self._total
        self._pending = 0
        # A limit of the joint, unlike one of the servo, clips later than here.
        torque = np.minimum(np.abs(self._force[rows, index.actuators]) / self._max_torque, 1.0)
        angle = self._angle[rows, index.joint_qpos]
        saturated = torque >= AT_LIMIT
        stopped = (angle < self._lower) | (angle > self._upper)
        speed = np.abs(self._speed[rows, index.joint_dof])
        self._total = Saturation(
            names=index.names,
            torque_any=before.torque_any + int(saturated.any(axis=1).sum()),
            torque_ticks=before.torque_ticks + saturated.sum(axis=0),
            stop_any=before.stop_any + int(stopped.any(axis=1).sum()),
            stop_ticks=before.stop_ticks + stopped.sum(axis=0),
            peak_torque=np.maximum(before.peak_torque, torque.max(axis=0)),
            peak_speed=np.maximum(before.peak_speed, speed.max(axis=0)),
        )
