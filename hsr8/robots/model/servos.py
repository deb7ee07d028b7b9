"""Position servos of a robot: those of its model, or by rule where it has none or torque motors.

The rule scales the servos of HSR-VIII by weight and height, and is the same for all robots.
"""

from collections import Counter
from collections.abc import Mapping
from math import ceil, pi, sqrt

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.robots.checks.mechanism import is_position_servo, joint_actuators
from hsr8.robots.file.description import RobotDescription, ServoRule
from hsr8.robots.file.key_mistake import KeyMistake
from hsr8.robots.parts.roles import Roles
from hsr8.robots.parts.skeleton import HINGE, Posed
from walking.parameters import CONTROL_PERIOD

Array = NDArray[np.float64]
MIN_SUBSTEPS = 2  # physics steps per control period
OWN_SERVOS = "servos of the model"
"""Note on a robot whose own servos are used."""
MAX_LISTED = 6  # joints in a note
GRAVITY = 9.81  # [m/s²]
BENT = 0.85  # height of the CoM with bent knees, by that with straight legs [1]


def leg_stiffness(mass: float, com_height: float, compliance: float) -> float:
    """Stiffness of a leg servo: weight times height of the CoM over the relative compliance.

    Args:
        mass: mass of the robot [kg].
        com_height: height of the centre of mass above the soles with straight legs [m].
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
        stiffness: stiffness of the servo [N m/rad].
        inertia: inertia that the joint moves, with the base held [kg m²].
        timestep: time step of the physics [s].

    Returns:
        [kg m²].
    """
    return max(0.0, 4.0 * stiffness * timestep**2 - inertia)


def leg_damping(stiffness: float, inertia: float, lag: float) -> float:
    """Damping of a leg servo: critical, unless the servo then lags by more than `lag` [s].

    Args:
        stiffness: stiffness of the servo [N m/rad].
        inertia: inertia that the joint moves, armature included [kg m²].
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
        effort: maximum torque, if known; placeholders, beyond the weight at the height of the
            CoM, would brake every motion [N m].
        speed: maximum speed, if known [rad/s].

    Returns:
        [N m s/rad].
    """
    return own if effort is None or speed is None else max(own, effort / speed)


def physics_step(step: float) -> float:
    """Return the physics step nearest to that of a file which divides the control period [s]."""
    return CONTROL_PERIOD / max(MIN_SUBSTEPS, ceil(CONTROL_PERIOD / step - 0.5 - 1e-9))


def choose_servos(
    spec: mujoco.MjSpec,
    zero: Posed,
    roles: Roles,
    description: RobotDescription,
    *,
    posture: Mapping[str, float],
    speed: Mapping[str, float],
    sole_height: float,
) -> list[str]:
    """Add servos by rule where the description asks for it or the legs have none; return notes.

    Args:
        spec: specification, changed in place.
        zero: the robot in the zero posture, compiled from `spec`.
        roles: roles of the robot's parts.
        description: description of the robot.
        posture: angles of all joints with straight legs [rad].
        speed: maximum speed by joint [rad/s].
        sole_height: height of the soles above the base, with straight legs; negative [m].

    Raises:
        KeyMistake: the CoM is not above the soles, or a joint moves no inertia.
    """
    stated, model = description.servo, zero.model
    effort = own_efforts(model)
    hinges = [model.joint(j).name for j in range(model.njnt) if model.jnt_type[j] == HINGE]
    if stated == "own" or (stated is None and has_servos(model, roles)):
        driven = [name for name in hinges if joint_actuators(model, model.joint(name).id)]
        return [OWN_SERVOS, *_silent_limits("effort", effort, driven)]
    notes = _add_servos(
        spec,
        Posed.at(model, posture),
        roles,
        sole_height=sole_height,
        rule=stated if isinstance(stated, ServoRule) else ServoRule(),
        effort=effort,
        speed=speed,
    )
    silent = _silent_limits("effort", effort, hinges), _silent_limits("speed", speed, hinges)
    return [*notes, *silent[0], *silent[1]]


def has_servos(model: mujoco.MjModel, roles: Roles) -> bool:
    """Return whether every leg joint has a position servo."""
    return all(
        any(is_position_servo(model, a) for a in joint_actuators(model, model.joint(name).id))
        for leg in roles.legs
        for name in leg
    )


def _silent_limits(key: str, limits: Mapping[str, float], joints: list[str]) -> list[str]:
    """Return a note on the joints without a limit."""
    silent = [name for name in joints if name not in limits]
    more = " ..." if len(silent) > MAX_LISTED else ""
    names = f"{', '.join(silent[:MAX_LISTED])}{more}"
    note = f"{key} of {len(silent)} joints is not stated and not limited: {names}"
    return [note] if silent else []


def _add_servos(
    spec: mujoco.MjSpec,
    straight: Posed,
    roles: Roles,
    *,
    sole_height: float,
    rule: ServoRule,
    effort: Mapping[str, float],
    speed: Mapping[str, float],
) -> list[str]:
    """Give every hinge joint a position servo; the actuators of the model are removed.

    The servos have the names of their joints. Keyframes and sensors of actuators are removed, too.

    Args:
        spec: model with a free base, changed in place.
        straight: model compiled from `spec`, with straight legs.
        roles: roles of the robot's parts.
        sole_height: height of the soles above the base; negative [m].
        rule: numbers of the rule.
        effort: maximum torque by joint, where one is known [N m].
        speed: maximum speed by joint [rad/s].

    Returns:
        Notes: one line per derived fact.

    Raises:
        KeyMistake: the CoM is not above the soles, or a joint moves no inertia.
    """
    model, data = straight.model, straight.data
    joints = [j for j in range(model.njnt) if model.jnt_type[j] == HINGE]
    matrix = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, matrix)
    base = model.body(roles.base).id
    mass = float(model.body_subtreemass[base])
    com_height = float(data.subtree_com[base][2]) - sole_height
    if com_height <= 0.0:
        raise KeyMistake(
            f"servo: the CoM is {com_height:.3f} m above the soles; expected a positive height: "
            "check feet, sole and zero"
        )
    replaced = _replaced(model)
    _remove_actuators(spec)
    timestep = physics_step(float(spec.option.timestep))
    stiff = leg_stiffness(mass, com_height, rule.compliance)
    load = mass * GRAVITY * com_height
    armatures: dict[str, float] = {}
    springs = [joint.name for joint in spec.joints if joint.stiffness.any()]
    for j in joints:
        name, inertia = model.joint(j).name, float(matrix[model.jnt_dofadr[j], model.jnt_dofadr[j]])
        if not inertia > 0.0:
            raise KeyMistake(f"servo: joint {name!r} moves no inertia; expected a mass")
        in_leg = name in roles.legs[0] or name in roles.legs[1]
        kp = stiff if in_leg else upper_stiffness(inertia, rule.upper_hz)
        armature = armature_floor(kp, inertia, timestep)
        if armature > 0.0:
            armatures[name] = armature
        total = inertia + armature
        kv = leg_damping(kp, total, rule.lag) if in_leg else critical_damping(kp, total)
        torque = effort.get(name)
        joint = spec.joint(name)
        joint.stiffness = np.zeros_like(joint.stiffness)
        joint.armature += armature
        used = None if torque is None else min(torque, load)
        joint.damping[0] = joint_damping(joint.damping[0], used, speed.get(name))
        _add_servo(spec, name, kp, kv, torque)
    notes = [
        f"servos by rule: {len(joints)}, those of the legs with {stiff:.0f} N m/rad for "
        f"{mass:.1f} kg with the CoM {com_height:.3f} m above the soles"
    ]
    if replaced:
        notes.append(f"actuators of the model replaced: {replaced}")
    if springs:
        notes.append(f"springs of {len(springs)} joints removed: {', '.join(springs[:MAX_LISTED])}")
    if armatures:
        most = max(armatures, key=lambda name: armatures[name])
        notes.append(
            f"armature added to {len(armatures)} joints for a stable physics, most to '{most}': "
            f"{armatures[most]:.4f} kg m²"
        )
    return notes


def own_efforts(model: mujoco.MjModel) -> dict[str, float]:
    """Maximum torque of every joint whose actuators or own limit bound it [N m].

    The limit of a joint with several actuators is the sum of theirs. Of limits that differ by
    direction, the smaller one counts.
    """
    efforts: dict[str, float] = {}
    for j in range(model.njnt):
        actuators = joint_actuators(model, j)
        torque = sum(max_torque_of(model, a) for a in actuators) if actuators else np.inf
        if model.jnt_actfrclimited[j]:
            torque = min(torque, smaller_side(model.jnt_actfrcrange[j]))
        if np.isfinite(torque):
            efforts[model.joint(j).name] = float(torque)
    return efforts


def max_torque_of(model: mujoco.MjModel, actuator: int) -> float:
    """Return the maximum torque of an actuator on its joint, infinite without limit [N m]."""
    joint = int(model.actuator_trnid[actuator, 0])
    limited = bool(model.jnt_actfrclimited[joint])
    torque = smaller_side(model.jnt_actfrcrange[joint]) if limited else np.inf
    bounds = [np.inf]
    if model.actuator_forcelimited[actuator]:
        bounds.append(smaller_side(model.actuator_forcerange[actuator]))
    if model.actuator_ctrllimited[actuator] and model.actuator_biastype[actuator] == 0:
        gain = abs(float(model.actuator_gainprm[actuator, 0]))
        bounds.append(gain * smaller_side(model.actuator_ctrlrange[actuator]))
    return min(torque, abs(float(model.actuator_gear[actuator, 0])) * min(bounds))


def smaller_side(limits: Array) -> float:
    """Return the smaller absolute value of two limits."""
    return float(np.abs(limits).min())


def _replaced(model: mujoco.MjModel) -> str:
    """Return the number of actuators by kind; those with a state have the kind of its dynamics."""
    kinds = Counter[str]()
    for a in range(model.nu):
        dynamics = mujoco.mjtDyn(model.actuator_dyntype[a]).name.removeprefix("mjDYN_").lower()
        servo = "position servo" if is_position_servo(model, a) else "motor or other kind"
        kinds[servo if dynamics == "none" else f"with state {dynamics}"] += 1
    return ", ".join(f"{count} {kind}" for kind, count in kinds.items())


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
