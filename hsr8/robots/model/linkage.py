"""Legs driven by rods, belts or several motors, as their serial equivalent.

Two parallel rods between cranks on the shank and the foot are the usual ankle of recent robots. The
serial equivalent drives the joints of the leg directly: the rods are fixed to the links that carry
them, and the limits of their motors are carried through the transmission of the bent leg. With the
closure J_l q̇_l + J_s q̇_s = 0 of the cranks and rods l and the leg s, the transmission is
T = -J_l⁺ J_s, torques of the leg are Tᵀ τ and reflected inertias Tᵀ I T.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.robots.checks.mechanism import is_position_servo, joint_actuators
from hsr8.robots.file.description import RobotDescription
from hsr8.robots.file.key_mistake import KeyMistake
from hsr8.robots.model.prepare import hold
from hsr8.robots.model.servos import max_torque_of
from hsr8.robots.parts.limbs import bent
from hsr8.robots.parts.prepared import Prepared
from hsr8.robots.parts.roles import find_roles, present
from hsr8.robots.parts.skeleton import FREE, Posed, skeleton_of

Array = NDArray[np.float64]

EQUALITY = int(mujoco.mjtConstraint.mjCNSTR_EQUALITY)
ITERATIONS, CLOSED = 50, 1e-9  # of Newton's method, until an error of the closure [m, rad]
NONE = 1e-6  # transmission that counts as none [1]


@dataclass(frozen=True, slots=True, eq=False)
class Closure:
    """Constraints of the legs, and the joints that they move.

    Attributes:
        ties: indices of the equality constraints.
        dofs: degrees of freedom of the legs (m,).
        loop: those of cranks and rods (k,).
        transmission: rates of `loop` per rate of `dofs` (k, m).
        coupled: mask of those of `dofs` that the constraints move (m,).
    """

    ties: list[int]
    dofs: NDArray[np.intp]
    loop: NDArray[np.intp]
    transmission: Array
    coupled: NDArray[np.bool_]


def drive_serially(
    prepared: Prepared, description: RobotDescription, speed: Mapping[str, float]
) -> tuple[dict[str, float], list[str]]:
    """Replace rods, couplings, gears and double motors of the legs by one actuator per joint.

    Args:
        prepared: prepared model, whose specification is changed.
        description: description of the robot.
        speed: maximum speed by joint, also of cranks [rad/s].

    Returns:
        Maximum speeds of the joints that the cranks limit [rad/s], and notes.

    Raises:
        KeyMistake: a leg lacks six joints, nothing has to be replaced, or the rods do not close.
    """
    spec = prepared.spec
    model = spec.copy().compile()
    model.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    roles = find_roles(model, description, prepared)
    zero = present(model, description.zero)
    skeleton = skeleton_of(model, model.body(roles.base).id, zero)
    legs = [[skeleton.joints.index(name) for name in leg] for leg in roles.legs]
    posed = Posed.at(model, {**zero, **bent(skeleton, legs, zero)})
    joints = [name for leg in roles.legs for name in leg]
    closure = close_loops(posed, joints)
    drives = [_Drive.of(model, closure, k, joints[k], speed) for k in range(len(joints))]
    changed = [drive for drive in drives if drive.changed]
    if not changed:
        raise KeyMistake(
            "linkage: every joint of the legs has one actuator with gear 1 already; expected no "
            "such key"
        )
    looped = [model.joint(int(j)).name for j in dict.fromkeys(model.dof_jntid[closure.loop])]
    used = {a for drive in changed for a in drive.actuators}
    used |= {a for name in looped for a in joint_actuators(model, model.joint(name).id)}
    servos = [spec.actuators[a] for a in sorted(used)]
    names = {servo.name for servo in servos}
    sensors = [sensor for sensor in spec.sensors if sensor.objname in names]
    for part in (*sensors, *servos, *(spec.equalities[tie] for tie in closure.ties)):
        spec.delete(part)
    for name in looped:
        hold(spec, name, float(model.qpos0[model.joint(name).qposadr[0]]))
    for drive in changed:
        drive.add_to(spec)
    speeds = {drive.joint: drive.speed for drive in changed if np.isfinite(drive.speed)}
    return speeds, _notes(changed, looped, closure)


def close_loops(posed: Posed, names: Sequence[str]) -> Closure:
    """Close the loops of the legs and return their constraints and transmission.

    Args:
        posed: the robot with bent legs; its cranks and rods are moved until the loops close.
        names: joints of the legs.

    Raises:
        KeyMistake: the loops do not close.
    """
    model, data = posed.model, posed.data
    dofs = np.array([model.joint(name).dofadr[0] for name in names])
    free = np.isin(model.dof_jntid, np.flatnonzero(model.jnt_type == FREE))
    ties = list[int]()
    reached = np.isin(np.arange(model.nv), dofs)
    for _ in range(model.neq):  # constraints of the legs, then those of the cranks that these move
        ties = [t for t in range(model.neq) if np.any(_rows(data, [t])[0][:, reached])]
        moved = np.abs(_rows(data, ties)[0]).max(axis=0, initial=0.0) > NONE
        reached = reached | (moved & ~free)
    loop = np.flatnonzero(reached & ~np.isin(np.arange(model.nv), dofs))
    error = 0.0
    for _ in range(ITERATIONS):
        jacobian, residual = _rows(data, ties)
        error = float(np.abs(residual).max(initial=0.0))
        if error < CLOSED or not len(loop):
            break
        step = np.zeros(model.nv)
        step[loop] = -np.linalg.pinv(jacobian[:, loop], rcond=NONE) @ residual
        mujoco.mj_integratePos(model, data.qpos, step, 1.0)
        mujoco.mj_fwdPosition(model, data)
    if error > CLOSED and len(loop):
        raise KeyMistake(
            f"linkage: the rods do not close with bent legs, got an error of {1e3 * error:.3g} mm; "
            "expected rods that reach: check zero, or the lengths in the model"
        )
    jacobian, _ = _rows(data, ties)
    transmission = -np.linalg.pinv(jacobian[:, loop], rcond=NONE) @ jacobian[:, dofs]
    coupled = np.abs(jacobian[:, dofs]).max(axis=0, initial=0.0) > NONE
    return Closure(ties, dofs, loop, transmission, coupled)


def _rows(data: mujoco.MjData, ties: Sequence[int]) -> tuple[Array, Array]:
    """Return Jacobian (n, nv) and error (n,) of equality constraints."""
    chosen = (data.efc_type == EQUALITY) & np.isin(data.efc_id, ties)
    return data.efc_J.reshape(-1, len(data.qvel))[chosen], data.efc_pos[chosen]


@dataclass(frozen=True, slots=True, eq=False)
class _Drive:
    """Actuators of a leg joint, and the one that replaces them.

    Attributes:
        joint: name.
        actuators: indices of those that move the joint.
        changed: whether they have to be replaced.
        torque: maximum, infinite if unknown [N m].
        speed: maximum, infinite if unknown [rad/s].
        gains: stiffness [N m/rad] and damping [N m s/rad]; None of motors.
        armature: reflected from cranks and rods [kg m²].
        damping: reflected from them [N m s/rad].
    """

    joint: str
    actuators: tuple[int, ...]
    changed: bool
    torque: float
    speed: float
    gains: tuple[float, float] | None
    armature: float
    damping: float

    @classmethod
    def of(
        cls,
        model: mujoco.MjModel,
        closure: Closure,
        index: int,
        joint: str,
        speed: Mapping[str, float],
    ) -> "_Drive":
        """Return the drive of a leg joint.

        Args:
            model: model with its rods.
            closure: closure of its loops.
            index: index of the joint in the transmission.
            joint: name of the joint.
            speed: maximum speed by joint [rad/s].
        """
        own = model.joint(joint).id
        ratios = {own: 1.0}
        for dof, ratio in zip(closure.loop, closure.transmission[:, index], strict=True):
            if abs(ratio) > NONE:
                ratios[int(model.dof_jntid[dof])] = float(ratio)
        moving = {a: r for j, r in ratios.items() for a in joint_actuators(model, j)}
        torque = sum(abs(r) * max_torque_of(model, a) for a, r in moving.items())
        fastest = [
            speed[name] / abs(ratio)
            for j, ratio in ratios.items()
            if (name := model.joint(j).name) in speed
        ]
        gears = {a: r * float(model.actuator_gear[a, 0]) for a, r in moving.items()}
        gains = None
        if moving and all(is_position_servo(model, a) for a in moving):
            stiffness = sum(g * g * float(model.actuator_gainprm[a, 0]) for a, g in gears.items())
            damping = sum(-g * g * float(model.actuator_biasprm[a, 2]) for a, g in gears.items())
            gains = stiffness, damping
        reflected = {int(model.jnt_dofadr[j]): r * r for j, r in ratios.items() if j != own}
        return cls(
            joint=joint,
            changed=bool(closure.coupled[index])
            or (bool(moving) and list(gears.values()) != [1.0]),
            torque=float(torque) if moving else np.inf,
            speed=min(fastest, default=np.inf),
            gains=gains,
            armature=float(sum(s * model.dof_armature[d] for d, s in reflected.items())),
            damping=float(sum(s * model.dof_damping[d] for d, s in reflected.items())),
            actuators=tuple(moving),
        )

    def add_to(self, spec: mujoco.MjSpec) -> None:
        """Add the actuator to a model without the others."""
        joint = spec.joint(self.joint)
        joint.armature += self.armature
        joint.damping[0] += self.damping
        servo = spec.add_actuator(target=self.joint, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        names = {actuator.name for actuator in spec.actuators}
        servo.name = self.joint if self.joint not in names else f"{self.joint}_serial"
        if self.gains is not None:
            servo.set_to_position(kp=self.gains[0], kv=self.gains[1])
        if np.isfinite(self.torque):
            servo.forcerange = (-self.torque, self.torque)
            servo.forcelimited = mujoco.mjtLimited.mjLIMITED_TRUE


def _notes(drives: Sequence[_Drive], looped: Sequence[str], closure: Closure) -> list[str]:
    """Return what is driven directly, with which limits, and what is neglected."""
    limits = ", ".join(
        f"{drive.joint} {drive.torque:.3g} N m" for drive in drives if np.isfinite(drive.torque)
    )
    notes = [f"linkage: {len(drives)} joints of the legs driven directly: {limits or 'no limits'}"]
    if looped:
        notes.append(
            f"linkage: {len(looped)} joints of cranks and rods fixed, {len(closure.ties)} "
            "constraints removed; neglected: the motion of the rods, and the change of their "
            "transmission with the angles, which is that of bent legs"
        )
    return notes
