"""Position servos by rule, for models without servos (URDF) or with torque motors.

The rule scales the servos of HSR-VIII by weight and height, and is the same for all robots.
"""

from collections.abc import Mapping
from math import pi, sqrt

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.errors import ModelError
from hsr8.robots.description import ServoRule
from hsr8.robots.roles import Leg

Array = NDArray[np.float64]
GRAVITY = 9.81  # [m/s²]
BENT = 0.85  # height of the CoM with bent knees, by that with straight legs [1]


def leg_stiffness(mass: float, com_height: float, compliance: float) -> float:
    """Stiffness of a leg servo: weight times height of the CoM over the relative compliance.

    Args:
        mass: of the robot [kg].
        com_height: above the soles with straight legs [m].
        compliance: lean of the robot per lean of its legs [rad/rad].

    Returns:
        [N m/rad].
    """
    return mass * GRAVITY * BENT * com_height / compliance


def armature_floor(stiffness: float, inertia: float, timestep: float) -> float:
    """Rotor inertia that a stiff servo on a light joint needs so that the physics is stable.

    The semi-implicit step diverges where stiffness * timestep² exceeds four times the inertia; the
    floor keeps a factor of sixteen.

    Args:
        stiffness: of the servo [N m/rad].
        inertia: that the joint moves, with the base held [kg m²].
        timestep: of the physics [s].

    Returns:
        [kg m²].
    """
    return max(0.0, 4.0 * stiffness * timestep**2 - inertia)


def leg_damping(stiffness: float, inertia: float, lag: float) -> float:
    """Damping of a leg servo: critical, unless the servo then lags by more than `lag` [s].

    Args:
        stiffness: of the servo [N m/rad].
        inertia: that the joint moves, armature included [kg m²].
        lag: maximum ratio of damping to stiffness [s].

    Returns:
        [N m s/rad].
    """
    return min(critical_damping(stiffness, inertia), lag * stiffness)


def critical_damping(stiffness: float, inertia: float) -> float:
    """Damping of a servo that does not overshoot [N m s/rad]."""
    return 2.0 * sqrt(stiffness * inertia)


def upper_stiffness(inertia: float, frequency: float) -> float:
    """Stiffness of a servo outside the legs, by its natural frequency [Hz]: [N m/rad]."""
    return (2.0 * pi * frequency) ** 2 * inertia


def joint_damping(own: float, effort: float | None, speed: float | None) -> float:
    """Damping of a joint that leaves no torque at its maximum speed.

    Args:
        own: damping of the model [N m s/rad].
        effort: maximum torque, if known [N m].
        speed: maximum speed, if known [rad/s].

    Returns:
        [N m s/rad].
    """
    return own if effort is None or speed is None else max(own, effort / speed)


def add_servos(
    spec: mujoco.MjSpec,
    legs: tuple[Leg, Leg],
    *,
    sole_height: float,
    posture: Mapping[str, float],
    rule: ServoRule,
    effort: Mapping[str, float],
    speed: Mapping[str, float],
    timestep: float,
) -> tuple[str, ...]:
    """Give every hinge joint a position servo; the actuators of the model are removed.

    The servos have the names of their joints. Keyframes and sensors of actuators are removed, too.

    Args:
        spec: model with a free base, changed in place.
        legs: joints of the left and the right leg.
        sole_height: height of the soles above the origin of the base, with straight legs;
            negative [m].
        posture: joint angles with straight legs, 0 where missing [rad].
        rule: its numbers.
        effort: maximum torque by joint, where the model states none or a wrong one [N m].
        speed: maximum speed by joint [rad/s].
        timestep: of the physics [s].

    Returns:
        Notes: one line per derived fact.

    Raises:
        ModelError: the CoM is not above the soles, or a joint moves no inertia.
    """
    model = spec.copy().compile()
    joints = [j for j in range(model.njnt) if model.jnt_type[j] == mujoco.mjtJoint.mjJNT_HINGE]
    mass, com_height, inertias = _straight_robot(model, posture)
    com_height -= sole_height
    if com_height <= 0.0:
        raise ModelError(
            f"servo rule: the CoM is {com_height:.3f} m above the soles; expected a positive "
            "height: check feet, sole and zero posture"
        )
    own_effort = motor_efforts(model)
    _remove_actuators(spec)
    stiff = leg_stiffness(mass, com_height, rule.compliance)
    armatures: dict[str, float] = {}
    for j in joints:
        name, inertia = model.joint(j).name, float(inertias[model.jnt_dofadr[j]])
        if not inertia > 0.0:
            raise ModelError(f"servo rule: joint '{name}' moves no inertia; expected a mass")
        in_leg = name in legs[0] or name in legs[1]
        kp = stiff if in_leg else upper_stiffness(inertia, rule.upper_hz)
        armature = armature_floor(kp, inertia, timestep)
        if armature > 0.0:
            armatures[name] = armature
        total = inertia + armature
        kv = leg_damping(kp, total, rule.lag) if in_leg else critical_damping(kp, total)
        torque = effort.get(name, own_effort.get(name))
        joint = spec.joint(name)
        joint.armature += armature
        joint.damping[0] = joint_damping(joint.damping[0], torque, speed.get(name))
        _add_servo(spec, name, kp, kv, torque)
    notes = [
        f"servos by rule: {len(joints)}, those of the legs with {stiff:.0f} N m/rad for "
        f"{mass:.1f} kg with the CoM {com_height:.3f} m above the soles"
    ]
    if armatures:
        most = max(armatures, key=lambda name: armatures[name])
        notes.append(
            f"armature added to {len(armatures)} joints for a stable physics, most to '{most}': "
            f"{armatures[most]:.4f} kg m²"
        )
    return tuple(notes)


def motor_efforts(model: mujoco.MjModel) -> dict[str, float]:
    """Maximum torque of every joint whose motor or own limit bounds it [N m]."""
    efforts: dict[str, float] = {}

    def bound(joint: int, torque: float) -> None:
        name = model.joint(joint).name
        efforts[name] = min(torque, efforts.get(name, torque))

    for j in range(model.njnt):
        if model.jnt_actfrclimited[j]:
            bound(j, float(np.abs(model.jnt_actfrcrange[j]).max()))
    for a in range(model.nu):
        if model.actuator_trntype[a] != mujoco.mjtTrn.mjTRN_JOINT:
            continue
        joint, gear = int(model.actuator_trnid[a, 0]), abs(float(model.actuator_gear[a, 0]))
        if model.actuator_forcelimited[a]:
            bound(joint, gear * float(np.abs(model.actuator_forcerange[a]).max()))
        if model.actuator_ctrllimited[a] and model.actuator_biastype[a] == 0:
            gain = abs(float(model.actuator_gainprm[a, 0]))
            bound(joint, gear * gain * float(np.abs(model.actuator_ctrlrange[a]).max()))
    return efforts


def _straight_robot(
    model: mujoco.MjModel, posture: Mapping[str, float]
) -> tuple[float, float, Array]:
    """Mass [kg], CoM height above the base [m], and diagonal of the mass matrix (nv,)."""
    data = mujoco.MjData(model)
    free = np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_FREE)
    data.qpos[:] = 0.0
    for j in free:
        data.qpos[model.jnt_qposadr[j] + 3] = 1.0
    for name, angle in posture.items():
        data.qpos[model.joint(name).qposadr[0]] = angle
    mujoco.mj_forward(model, data)
    matrix = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, matrix)
    base = int(model.jnt_bodyid[free[0]])
    com_height = float(data.subtree_com[base][2] - data.xpos[base][2])
    return float(model.body_subtreemass[base]), com_height, matrix.diagonal()


def _remove_actuators(spec: mujoco.MjSpec) -> None:
    actuator = mujoco.mjtObj.mjOBJ_ACTUATOR
    sensors = [sensor for sensor in spec.sensors if sensor.objtype == actuator]
    for element in (*spec.keys, *sensors, *spec.actuators):
        spec.delete(element)


def _add_servo(spec: mujoco.MjSpec, joint: str, kp: float, kv: float, torque: float | None) -> None:
    servo = spec.add_actuator(name=joint, target=joint, trntype=mujoco.mjtTrn.mjTRN_JOINT)
    servo.set_to_position(kp=kp, kv=kv)
    if torque is not None:
        servo.forcerange = (-torque, torque)
        servo.forcelimited = mujoco.mjtLimited.mjLIMITED_TRUE
        spec.joint(joint).actfrcrange = (-torque, torque)
        spec.joint(joint).actfrclimited = mujoco.mjtLimited.mjLIMITED_TRUE
