"""Faults of sensors, servos and the environment, applied to readings, targets and the model."""

from collections import deque
from collections.abc import Sequence
from dataclasses import replace
from math import hypot

import mujoco

from hsr8.scenario.fault import (
    AttitudeBias,
    Bump,
    EncoderFrozen,
    EncoderOffset,
    Fault,
    FootGain,
    GyroBias,
    ImuFrozen,
    LowFriction,
    SensorFault,
    ServoDelay,
    ServoFault,
    ServoWeak,
    ticks,
)
from hsr8.world.model.index import ModelIndex
from hsr8.world.rotation import quaternion_from_yaw, quaternion_product, small_rotation
from walking.parameters import CONTROL_PERIOD
from walking.state import BodySensors, JointTargets

AXES = {"roll": 0, "pitch": 1, "yaw": 2}


class SensorFaults:
    """Applies sensor faults in the order of the scenario.

    Args:
        faults: faults of the scenario; faults of other parts are ignored.
        names: names of the robot's joints.
    """

    def __init__(self, faults: Sequence[Fault], names: Sequence[str]) -> None:
        self._names = names
        self._faults = [f for f in faults if isinstance(f, SensorFault)]
        self._frozen: dict[int, BodySensors] = {}
        self._yaw_error = 0.0

    def apply_fault(self, sensors: BodySensors, tick: int) -> BodySensors:
        """Return the readings of control tick `tick` with the faults applied."""
        for number, fault in enumerate(self._faults):
            if fault.acts(tick):
                sensors = self._with_fault(sensors, number, fault)
        if self._yaw_error:
            turned = quaternion_product(quaternion_from_yaw(self._yaw_error), sensors.orientation)
            sensors = replace(sensors, orientation=turned)
        return sensors

    def _with_fault(self, now: BodySensors, number: int, fault: SensorFault) -> BodySensors:
        if isinstance(fault, ImuFrozen | EncoderFrozen):
            return self._frozen_readings(now, self._frozen.setdefault(number, now), fault)
        if isinstance(fault, GyroBias):
            gyro = now.gyro.copy()
            gyro[AXES[fault.axis]] += fault.magnitude
            if fault.axis == "yaw":
                self._yaw_error += CONTROL_PERIOD * fault.magnitude
            return replace(now, gyro=gyro)
        if isinstance(fault, AttitudeBias):
            roll, pitch = (fault.magnitude, 0.0) if fault.axis == "roll" else (0.0, fault.magnitude)
            tilted = quaternion_product(now.orientation, small_rotation(roll, pitch))
            return replace(now, orientation=tilted)
        if isinstance(fault, EncoderOffset):
            position = now.joint_position.copy()
            position[fault.joints(self._names)] += fault.magnitude
            return replace(now, joint_position=position)
        force = now.foot_force.copy()
        force[fault.feet] *= fault.magnitude if isinstance(fault, FootGain) else 0.0
        return replace(now, foot_force=force)

    def _frozen_readings(
        self, now: BodySensors, then: BodySensors, fault: ImuFrozen | EncoderFrozen
    ) -> BodySensors:
        if isinstance(fault, ImuFrozen):
            return replace(
                now,
                gyro=then.gyro,
                accelerometer=then.accelerometer,
                orientation=then.orientation,
            )
        position, velocity = now.joint_position.copy(), now.joint_velocity.copy()
        joints = fault.joints(self._names)
        position[joints], velocity[joints] = then.joint_position[joints], 0.0
        return replace(now, joint_position=position, joint_velocity=velocity)


class ServoFaults:
    """Applies servo faults in the order of the scenario.

    Args:
        faults: faults of the scenario; faults of other parts are ignored.
        names: names of the robot's joints.
    """

    def __init__(self, faults: Sequence[Fault], names: Sequence[str]) -> None:
        self._names = names
        self._faults = [f for f in faults if isinstance(f, ServoFault)]
        delays = [ticks(f.magnitude) for f in self._faults if isinstance(f, ServoDelay)]
        self._commanded: deque[JointTargets] = deque(maxlen=max(delays, default=0) + 1)
        self._applied: JointTargets | None = None
        self._frozen: dict[int, JointTargets] = {}

    def apply_fault(self, targets: JointTargets, tick: int) -> JointTargets:
        """Return the targets that reach the servos in control tick `tick`."""
        if not self._faults:
            return targets
        self._commanded.append(targets)
        position, setpoint = targets.position.copy(), targets.setpoint.copy()
        for number, fault in enumerate(self._faults):
            if not fault.acts(tick):
                continue
            if isinstance(fault, ServoDelay):
                then = self._commanded[max(0, len(self._commanded) - 1 - ticks(fault.magnitude))]
            else:
                then = self._frozen.setdefault(number, self._applied or targets)
            joints = fault.joints(self._names)
            position[joints], setpoint[joints] = then.position[joints], then.setpoint[joints]
        self._applied = JointTargets(position, setpoint)
        return self._applied


COLLIDES = (3, 1)  # contype and conaffinity of geoms that collide with the robot
SOLE_PRIORITY = 1  # so that the friction of the soles alone counts


class WorldFaults:
    """Applies world faults to a model.

    Args:
        model: compiled world.
        index: addresses in it.
        faults: faults of the scenario; faults of other parts are ignored.
        scale: scale of the world [1].
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        index: ModelIndex,
        faults: Sequence[Fault],
        scale: float = 1.0,
    ) -> None:
        self._scale = scale
        self._index = index
        self._weak = [f for f in faults if isinstance(f, ServoWeak)]
        self._low_friction = [f for f in faults if isinstance(f, LowFriction)]
        bumps = [f for f in faults if isinstance(f, Bump)]
        self._bumps = list(zip(bumps, index.bumps, strict=True))
        self._any = bool(self._weak or self._low_friction or self._bumps)
        self._local = any(f.position is not None for f in self._low_friction)
        self._torque = model.actuator_forcerange.copy(), model.jnt_actfrcrange.copy()
        self._joints = model.dof_jntid[index.joint_dof]
        self._friction = [float(model.geom_friction[g, 0]) for g in index.foot_geoms]
        if self._low_friction:
            model.geom_priority[list(index.foot_geoms)] = SOLE_PRIORITY

    def apply_fault(self, model: mujoco.MjModel, data: mujoco.MjData, tick: int) -> None:
        """Apply the faults of control tick `tick` before it is simulated."""
        if not self._any:
            return
        if self._weak:
            model.actuator_forcerange[:], model.jnt_actfrcrange[:] = self._torque
            for weak in self._weak:
                if weak.acts(tick):
                    joints = weak.joints(self._index.names)
                    model.actuator_forcerange[self._index.actuators[joints]] *= weak.magnitude
                    model.jnt_actfrcrange[self._joints[joints]] *= weak.magnitude
        for bump, geom in self._bumps:
            mask = COLLIDES if bump.acts(tick) else (0, 0)
            model.geom_contype[geom], model.geom_conaffinity[geom] = mask
        if self._local:
            # The result must not depend on an update of the poses by a camera.
            mujoco.mj_kinematics(model, data)
        for side, geom in enumerate(self._index.foot_geoms):
            friction = self._friction[side]
            x, y, _ = data.geom_xpos[geom].tolist()
            for slip in self._low_friction:
                if slip.acts(tick) and _within(slip, x, y, self._scale):
                    friction = slip.magnitude
            if self._low_friction:
                model.geom_friction[geom, 0] = friction


def _within(slip: LowFriction, x: float, y: float, scale: float) -> bool:
    if slip.position is None:
        return True
    return hypot(x - slip.position[0], y - slip.position[1]) <= slip.reach(scale)
