"""Limits of joints that a description states, in the model."""

from collections.abc import Mapping

import mujoco
import numpy as np

from hsr8.robots.model.prepare import LIMITED, TO_JOINT


def set_ranges(spec: mujoco.MjSpec, ranges: Mapping[str, tuple[float, float]]) -> None:
    """Set the limits of joints [rad]."""
    for name, limits in ranges.items():
        joint = spec.joint(name)
        joint.range = np.degrees(limits) if spec.compiler.degree else limits
        joint.limited = LIMITED


def set_efforts(spec: mujoco.MjSpec, efforts: Mapping[str, float]) -> None:
    """Set the maximum torque of joints, also of their actuators [N m]."""
    for name, effort in efforts.items():
        joint = spec.joint(name)
        if joint is None:
            continue  # held
        joint.actfrcrange, joint.actfrclimited = (-effort, effort), LIMITED
        for servo in [s for s in spec.actuators if s.target == name and s.trntype in TO_JOINT]:
            force = effort / abs(float(servo.gear[0]))
            servo.forcerange, servo.forcelimited = (-force, force), LIMITED
            if servo.biastype == mujoco.mjtBias.mjBIAS_NONE:
                servo.ctrllimited = mujoco.mjtLimited.mjLIMITED_FALSE
