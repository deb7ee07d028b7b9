"""Kinematic tree of a robot from its compiled MuJoCo model, for the walking engine."""

from collections.abc import Mapping
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.robots.checks.mechanism import TO_JOINT
from hsr8.robots.parts.roles import Roles
from hsr8.robots.parts.skeleton import HINGE, matrix_of
from walking.body.tree import Frame, RobotTree, turn
from walking.model import Sole

Array = NDArray[np.float64]
Ints = NDArray[np.integer]

UNLIMITED = np.pi  # range of a joint without limits, to either side [rad]


@dataclass(frozen=True, slots=True, eq=False)
class Parts:
    """Frames that the normal form adds to a robot.

    Attributes:
        feet: site below each ankle.
        sole: rectangle of each sole.
        camera: site of the camera: x right, y down, z forward.
    """

    feet: tuple[str, str]
    sole: Sole
    camera: str


def driven_joints(model: mujoco.MjModel, roles: Roles) -> tuple[str, ...]:
    """Return the hinge joints with an actuator: legs first, then the others in model order."""
    legs = (*roles.legs[0], *roles.legs[1])
    driven = servos_of(model)
    others = [
        model.joint(j).name
        for j in range(model.njnt)
        if model.jnt_type[j] == HINGE and j in driven and _on_robot(model, j, roles)
    ]
    return (*legs, *(name for name in others if name not in legs))


def tree_of(
    model: mujoco.MjModel,
    roles: Roles,
    parts: Parts,
    posture: Mapping[str, float],
    speed: Mapping[str, float],
) -> RobotTree:
    """Return the tree of a robot.

    Args:
        model: compiled model, with the sites of `parts`.
        roles: roles of its parts.
        parts: added by the normal form.
        posture: joint angles with straight legs; zero by default [rad].
        speed: maximum speed by joint, instead of that of the model [rad/s].
    """
    return _Builder(model, roles, posture).tree(parts, speed)


class _Builder:
    """Walks through the bodies of a model and lumps them onto the driven joints."""

    def __init__(self, model: mujoco.MjModel, roles: Roles, posture: Mapping[str, float]) -> None:
        self._model, self._roles, self._posture = model, roles, posture
        self._names = driven_joints(model, roles)
        self._index = {model.joint(name).id: k for k, name in enumerate(self._names)}
        n = len(self._names)
        self._parents = np.full(n, -1, dtype=np.int64)
        self._rotations, self._positions = np.zeros((n, 3, 3)), np.zeros((n, 3))
        self._axes = np.zeros((n, 3))
        self._carriers: dict[int, Frame] = {}  # frame of every body
        base = model.body(roles.base).id
        for body in range(base, model.nbody):
            if model.body_rootid[body] == model.body_rootid[base] and body >= base:
                self._carriers[body] = self._carried(body, base)

    def _carried(self, body: int, base: int) -> Frame:
        """Return the frame of a body on the driven joint that moves it; store its own joints."""
        model = self._model
        if body == base:
            return Frame(-1, np.eye(3), np.zeros(3))
        parent = self._carriers[int(model.body_parentid[body])]
        rotation = parent.rotation @ matrix_of(model.body_quat[body])
        position = parent.position + parent.rotation @ model.body_pos[body]
        joint = parent.joint
        first = int(model.body_jntadr[body])
        for j in range(first, first + int(model.body_jntnum[body])):
            axis, anchor = model.jnt_axis[j], model.jnt_pos[j]
            zero = float(model.qpos0[model.jnt_qposadr[j]])
            if j in self._index:
                k = self._index[j]
                self._parents[k], self._axes[k] = joint, axis
                self._rotations[k] = rotation @ turn(axis, -zero)
                self._positions[k] = position + rotation @ anchor
                joint, rotation, position = k, np.eye(3), -anchor
                continue
            angle = self._posture.get(model.joint(j).name, zero) - zero
            if model.jnt_type[j] != HINGE:
                position = position + rotation @ (axis * angle)
                continue
            held = turn(axis, angle)
            position = position + rotation @ (anchor - held @ anchor)
            rotation = rotation @ held
        return Frame(joint, rotation, position)

    def _site(self, name: str) -> Frame:
        model = self._model
        site = model.site(name).id
        body = self._carriers[int(model.site_bodyid[site])]
        rotation = body.rotation @ matrix_of(model.site_quat[site])
        return Frame(body.joint, rotation, body.position + body.rotation @ model.site_pos[site])

    def tree(self, parts: Parts, speed: Mapping[str, float]) -> RobotTree:
        model, names = self._model, self._names
        joints = np.array([model.joint(name).id for name in names])
        dofs = model.jnt_dofadr[joints]
        servo = servos_of(model)
        servos = np.array([servo[j] for j in joints.tolist()])
        limited = model.jnt_limited[joints].astype(bool)
        ranges = np.where(limited[:, None], model.jnt_range[joints], [[-UNLIMITED, UNLIMITED]])
        gear = model.actuator_gear[servos, 0]
        torque = max_torque(model, joints, servos)
        damping = model.dof_damping[dofs]
        fastest = np.divide(torque, damping, out=np.full(len(names), np.inf), where=damping > 0.0)
        bodies = [b for b, mass in enumerate(model.body_mass) if mass > 0.0 and b in self._carriers]

        def pair(joints: tuple[str, str] | None) -> tuple[int, int] | None:
            return None if joints is None else (names.index(joints[0]), names.index(joints[1]))

        return RobotTree(
            names=names,
            parents=self._parents,
            rotations=self._rotations,
            positions=self._positions,
            axes=self._axes,
            bodies=tuple(self._mass_frame(b) for b in bodies),
            masses=model.body_mass[bodies],
            inertias=model.body_inertia[bodies],
            lower=ranges[:, 0].copy(),
            upper=ranges[:, 1].copy(),
            stiffness=gear * model.actuator_gainprm[servos, 0],
            servo_damping=-gear * model.actuator_biasprm[servos, 2],
            joint_damping=damping,
            armature=model.dof_armature[dofs],
            effort=torque,
            speed=np.array([speed.get(n, s) for n, s in zip(names, fastest, strict=True)]),
            posture=np.array([self._posture.get(name, 0.0) for name in names]),
            feet=(self._site(parts.feet[0]), self._site(parts.feet[1])),
            sole=parts.sole,
            camera=self._site(parts.camera),
            head=pair(self._roles.head),
            shoulders=pair(self._roles.shoulders),
        )

    def _mass_frame(self, body: int) -> Frame:
        model, frame = self._model, self._carriers[body]
        rotation = frame.rotation @ matrix_of(model.body_iquat[body])
        return Frame(frame.joint, rotation, frame.position + frame.rotation @ model.body_ipos[body])


def max_torque(model: mujoco.MjModel, joints: Ints, servos: Ints) -> Array:
    """Return the maximum torque of servos (n,) on joints (n,), infinite without limit [N m].

    Of limits that differ by direction, the smaller one counts.
    """
    forces, torques = (
        np.abs(limits).min(axis=1)
        for limits in (model.actuator_forcerange[servos], model.jnt_actfrcrange[joints])
    )
    servo = np.where(model.actuator_forcelimited[servos], forces, np.inf)
    joint = np.where(model.jnt_actfrclimited[joints], torques, np.inf)
    torque: Array = np.minimum(np.abs(model.actuator_gear[servos, 0]) * servo, joint)
    return torque


def servos_of(model: mujoco.MjModel) -> dict[int, int]:
    """Return the actuator of each joint that has one; those of tendons move no joint directly."""
    on_joint = np.flatnonzero(np.isin(model.actuator_trntype, TO_JOINT))
    return {int(model.actuator_trnid[a, 0]): int(a) for a in on_joint}


def _on_robot(model: mujoco.MjModel, joint: int, roles: Roles) -> bool:
    base = model.body(roles.base).id
    return bool(model.body_rootid[model.jnt_bodyid[joint]] == model.body_rootid[base])
