"""Saturation of the servos: torque, range and speed of the joints against their limits."""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from compilation import compiled
from hsr8.robots.model.tree import max_torque
from hsr8.world.model.index import ModelIndex

Array = NDArray[np.float64]
Ints = NDArray[np.intp]

AT_LIMIT = 0.999  # fraction of the maximum torque that counts as saturated [1]
TOUCHING = 1e-4  # angle beyond the range at which a joint touches its stop [rad]


@dataclass(frozen=True, slots=True)
class Saturation:
    """Saturation of the servos since the start of the run, in the order of walking.

    Attributes:
        names: names of the joints (n,).
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
        limited = model.jnt_limited[joints, None] != 0
        ranges = np.where(limited, model.jnt_range[joints], [-np.inf, np.inf])
        torque = max_torque(model, joints, index.actuators)
        self._limits = np.stack([torque, ranges[:, 0] - TOUCHING, ranges[:, 1] + TOUCHING])
        self._addresses = np.stack([index.actuators, index.joint_qpos, index.joint_dof])
        n = len(index.names)
        self._ticks = np.zeros((2, n + 1), dtype=np.int64)
        self._peaks = np.zeros((2, n))

    def watch(self, data: mujoco.MjData) -> None:
        """Add the state after a control tick."""
        count(
            data.actuator_force,
            data.qpos,
            data.qvel,
            self._addresses,
            self._limits,
            self._ticks,
            self._peaks,
        )

    def so_far(self) -> Saturation:
        """Return the saturation since the start of the run."""
        torque, stop = self._ticks.copy()
        peak_torque, peak_speed = self._peaks.copy()
        return Saturation(
            names=self._index.names,
            torque_any=int(torque[-1]),
            torque_ticks=torque[:-1],
            stop_any=int(stop[-1]),
            stop_ticks=stop[:-1],
            peak_torque=peak_torque,
            peak_speed=peak_speed,
        )


@compiled
def count(
    force: Array,
    qpos: Array,
    qvel: Array,
    addresses: Ints,
    limits: Array,
    ticks: NDArray[np.int64],
    peaks: Array,
) -> None:
    """Count the joints that are saturated in one control tick, and update their peaks.

    Args:
        force: forces of the actuators [N m].
        qpos: generalised position, MuJoCo order (nq,).
        qvel: generalised velocity, MuJoCo order (nv,).
        addresses: address of each joint in `force`, `qpos` and `qvel` (3, n).
        limits: maximum torque [N m] and angles beyond the range [rad] of each joint (3, n).
        ticks: control ticks at maximum torque and at the end of the range, by joint and of any
            joint; updated (2, n + 1).
        peaks: peak torque over maximum torque [1] and peak speed [rad/s] of each joint;
            updated (2, n).
    """
    n = addresses.shape[1]
    any_torque, any_stop = False, False
    for k in range(n):
        # A limit of the joint, unlike one of the servo, clips later than here.
        torque = min(abs(force[addresses[0, k]]) / limits[0, k], 1.0)
        angle = qpos[addresses[1, k]]
        saturated, stopped = torque >= AT_LIMIT, angle < limits[1, k] or angle > limits[2, k]
        ticks[0, k] += saturated
        ticks[1, k] += stopped
        any_torque, any_stop = any_torque or saturated, any_stop or stopped
        peaks[0, k] = max(peaks[0, k], torque)
        peaks[1, k] = max(peaks[1, k], abs(qvel[addresses[2, k]]))
    ticks[0, n] += any_torque
    ticks[1, n] += any_stop
