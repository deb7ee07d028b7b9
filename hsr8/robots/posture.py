"""Posture of the joints that neither walk nor look: from a description and its SRDF file."""

from collections.abc import Collection, Sequence
from math import isfinite
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np

from hsr8.errors import ModelError
from hsr8.robots.description import RobotDescription
from hsr8.robots.key_mistake import KeyMistake, require_name
from hsr8.robots.roles import Roles
from hsr8.robots.skeleton import HINGE

LIMIT_MARGIN = 0.02  # distance of a clipped angle from its limit, by the range [1]


def stated_posture(description: RobotDescription, folder: Path) -> dict[str, float]:
    """Angles of the posture, those of the SRDF file completed by the key ``posture`` [rad].

    Args:
        description: of the robot.
        folder: of the description file, to which the SRDF file is relative.

    Raises:
        KeyMistake: the SRDF file cannot be read, or has no such group state.
        ModelError: an angle of the SRDF file is not a number.
    """
    if description.srdf is None or description.state is None:
        return dict(description.posture)
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


def clip_to_range(angle: float, lower: float, upper: float) -> float:
    """Return an angle that is inside its range; one outside moves in by 2 % of the range [rad]."""
    if lower <= angle <= upper:
        return angle
    margin = LIMIT_MARGIN * (upper - lower)
    return min(max(angle, lower + margin), upper - margin)


def completed_posture(
    model: mujoco.MjModel, description: RobotDescription, stated: Collection[str], roles: Roles
) -> tuple[dict[str, float], list[str]]:
    """Return the posture of the joints that neither walk nor look, within their limits, and notes.

    Args:
        model: compiled.
        description: of the robot in terms of the model, with the angles of its SRDF file.
        stated: joints of the key `posture`, whose angles remain.
        roles: of the robot's parts.
    """
    posture, notes = dict(description.posture), []
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
        description: of the robot.
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
