"""Posture of the joints that neither walk nor look, from a description, SRDF file or keyframe."""

from collections.abc import Mapping, Sequence
from math import isfinite
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np

from hsr8.errors import ModelError
from hsr8.robots.file.description import RobotDescription
from hsr8.robots.file.key_mistake import KeyMistake, require_name
from hsr8.robots.parts.roles import Roles
from hsr8.robots.parts.skeleton import HINGE, clip_to_range

COORDINATES = {0: 7, 1: 4, 2: 1, 3: 1}  # of a free, ball, slide and hinge joint in a keyframe


def stated_posture(
    description: RobotDescription, folder: Path, spec: mujoco.MjSpec
) -> dict[str, float]:
    """Angles of the posture: those of the group state or keyframe, changed by `posture` [rad].

    Args:
        description: description of the robot.
        folder: folder of the description file, to which the SRDF file is relative.
        spec: MuJoCo model as read from its file.

    Raises:
        KeyMistake: the SRDF file cannot be read, or there is no such state.
        ModelError: an angle of the SRDF file is not a number.
    """
    if description.state is None:
        return dict(description.posture)
    if description.srdf is None:
        return _keyframe(spec, description.state) | description.posture
    file = folder / description.srdf
    try:
        robot = ElementTree.fromstring(file.read_bytes())
    except (OSError, ValueError, ElementTree.ParseError) as error:
        raise KeyMistake(
            f"srdf: {str(file)!r} cannot be read: {error}; expected an SRDF file"
        ) from error
    states = {state.get("name", ""): state for state in robot.iter("group_state")}
    require_name("state", "group state", description.state, list(states), str(file))
    angles = {}
    for joint in states[description.state].iter("joint"):
        try:
            values = [float(word) for word in joint.get("value", "").split()]
        except ValueError:
            values = []
        if not values or not all(isfinite(value) for value in values):
            raise ModelError(
                f"{file}: joint '{joint.get('name')}' in the group state '{description.state}': "
                f"value, got '{joint.get('value')}'; expected an angle [rad]"
            )
        if len(values) == 1:
            angles[joint.get("name", "")] = values[0]
    return angles | description.posture


def _keyframe(spec: mujoco.MjSpec, name: str) -> dict[str, float]:
    """Return the angles of a keyframe of the model [rad].

    Raises:
        KeyMistake: the model has no such keyframe.
    """
    require_name("state", "keyframe", name, [key.name for key in spec.keys])
    qpos, at, angles = np.array(spec.key(name).qpos, float), 0, {}
    for joint in spec.joints:
        if joint.type == HINGE and at < len(qpos):
            angles[joint.name] = float(qpos[at])
        at += COORDINATES[int(joint.type)]
    return angles


def completed_posture(
    model: mujoco.MjModel, description: RobotDescription, angles: Mapping[str, float], roles: Roles
) -> tuple[dict[str, float], list[str]]:
    """Return the posture of the joints that neither walk nor look, within their limits, and notes.

    Args:
        model: compiled model.
        description: description of the robot; the angles of its key `posture` remain.
        angles: angles of `stated_posture` [rad].
        roles: roles of the robot's parts.
    """
    names = {model.joint(j).name for j in np.flatnonzero(model.jnt_type == HINGE)}
    posture, notes = {name: angle for name, angle in angles.items() if name in names}, list[str]()
    stated = description.posture
    moving = {*roles.legs[0], *roles.legs[1], *(roles.head or ())}
    for name in moving - {*stated}:
        posture.pop(name, None)
    for joint in (model.joint(int(j)) for j in np.flatnonzero(model.jnt_limited)):
        name, angle = joint.name, posture.get(joint.name, 0.0)
        if joint.type[0] != HINGE or name in moving | {*stated, *description.zero}:
            continue
        inside = clip_to_range(angle, *joint.range.tolist())
        if inside != angle:
            posture[name] = inside
            notes.append(f"posture: {name!r} {angle:.3f} -> {inside:.3f} rad, within its range")
    return posture, notes


def check_joint_names(description: RobotDescription, names: Sequence[str]) -> None:
    """Check that every joint of a description is one of the model.

    Args:
        description: description of the robot.
        names: joints of the model.

    Raises:
        KeyMistake: a key names a joint that the model lacks.
    """
    for key in ("head", "shoulders", "zero", "posture", "effort", "range", "speed", "rigid"):
        for joint in getattr(description, key) or ():
            if joint not in names and joint in RobotDescription.model_fields:
                raise KeyMistake(
                    f"{key}.{joint}: not a joint but a key of the description; expected it above "
                    "the first [table]"
                )
            require_name(key, "hinge joint", joint, names)
