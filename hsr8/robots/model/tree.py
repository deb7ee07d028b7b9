"""Kinematic tree of a robot from its compiled MuJoCo model, for the walking engine."""

from collections.abc import Mapping
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.robots.checks.mechanism import TO_JOINT
from hsr8.robots.parts.roles import Roles
from hsr8.robots.parts.skeleton import HINGE, Posed
from walking.body.tree import Frame, RobotTree
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
    """Return the tree of a robot, from its places with all driven joints at zero.

    Args:
        model: compiled model, with the sites of `parts`.
        roles: roles of its parts.
        parts: added by the normal form.
        posture: joint angles with straight legs; zero by default [rad].
        speed: maximum speed by joint, instead of that of the model [rad/s].
    """
    names = driven_joints(model, roles)
    data = Posed.at(model, {name: q for name, q in posture.items() if name not in names}).data
    joints = np.array([model.joint(name).id for name in names])
    parents, carriers = _carriers(model, roles, joints)
    anchors = np.vstack([data.xanchor[joints], np.zeros(3)])  # the last one is the base
    servo = servos_of(model)
    servos = np.array([servo[j] for j in joints.tolist()])
    limited = model.jnt_limited[joints].astype(bool)
    ranges = np.where(limited[:, None], model.jnt_range[joints], [[-UNLIMITED, UNLIMITED]])
    gear = model.actuator_gear[servos, 0]
    torque = max_torque(model, joints, servos)
    dofs = model.jnt_dofadr[joints]
    damping = model.dof_damping[dofs]
    fastest = np.divide(torque, damping, out=np.full(len(names), np.inf), where=damping > 0.0)
    bodies = [body for body in carriers if model.body_mass[body] > 0.0]

    def frame(body: int, rotation: Array, position: Array) -> Frame:
        joint = carriers[body]
        return Frame(joint, rotation.reshape(3, 3).copy(), position - anchors[joint])

    def site(name: str) -> Frame:
        k = model.site(name).id
        return frame(int(model.site_bodyid[k]), data.site_xmat[k], data.site_xpos[k])

    def pair(joints: tuple[str, str] | None) -> tuple[int, int] | None:
        return None if joints is None else (names.index(joints[0]), names.index(joints[1]))

    return RobotTree(
        names=names,
        parents=parents,
        positions=anchors[:-1] - anchors[parents],
        axes=data.xaxis[joints],
        bodies=tuple(frame(b, data.ximat[b], data.xipos[b]) for b in bodies),
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
        posture=np.array([posture.get(name, 0.0) for name in names]),
        feet=(site(parts.feet[0]), site(parts.feet[1])),
        sole=parts.sole,
        camera=site(parts.camera),
        head=pair(roles.head),
        shoulders=pair(roles.shoulders),
    )


def _carriers(
    model: mujoco.MjModel, roles: Roles, joints: Ints
) -> tuple[NDArray[np.int64], dict[int, int]]:
    """Return the driven joint above each driven joint, and above each body, -1 for the base.

    Args:
        model: compiled model.
        roles: roles of its parts.
        joints: ids of the driven joints (n,).
    """
    index = {joint: k for k, joint in enumerate(joints.tolist())}
    parents = np.full(len(joints), -1, dtype=np.int64)
    root = model.body(roles.base).id
    carriers = {root: -1}
    for body in range(root + 1, model.nbody):
        if model.body_rootid[body] != root:
            continue
        carrier = carriers[int(model.body_parentid[body])]
        first = int(model.body_jntadr[body])
        for joint in range(first, first + int(model.body_jntnum[body])):
            if joint in index:
                parents[index[joint]] = carrier
                carrier = index[joint]
        carriers[body] = carrier
    return parents, carriers


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
