"""Reading of a robot's model file, MJCF or URDF."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.robots.description import RobotDescription
from hsr8.robots.key_mistake import KeyMistake
from hsr8.robots.mjcf import read_mjcf
from hsr8.robots.models import reading_models
from hsr8.robots.posture import check_joint_names, stated_posture
from hsr8.robots.skeleton import HINGE
from hsr8.robots.urdf import convert

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class RawModel:
    """Model of a file, before the normal form.

    Attributes:
        spec: MuJoCo model.
        description: of the robot, in terms of the model.
        notes: derived facts, a line each.
    """

    spec: mujoco.MjSpec
    description: RobotDescription
    notes: tuple[str, ...]


def read_model(file: Path, description: RobotDescription, folder: Path) -> RawModel:
    """Read a model.

    Args:
        file: MJCF or URDF file.
        description: of the robot.
        folder: of the description file.

    Raises:
        KeyMistake: a key of the description is wrong.
        ModelError: the file is wrong, or the robot cannot be converted.
    """
    if file.suffix.lower() == ".urdf":
        converted = convert(file, description, folder)
        _set_ranges(converted.spec, converted.description.range)
        return RawModel(converted.spec, converted.description, converted.notes)
    if description.packages:
        raise KeyMistake("packages: got an MJCF file, which has none; expected a URDF file")
    angles = stated_posture(description, folder)
    with reading_models(str(file)):
        spec = read_mjcf(file, description.feet[0])
    check_joint_names(description, [j.name for j in spec.joints if j.type == HINGE])
    for name in dict.fromkeys(description.rigid):
        _make_rigid(spec, name, (angles | description.zero).get(name, 0.0))
    _set_ranges(spec, description.range)
    names = {joint.name for joint in spec.joints}
    known = {"posture": angles, "zero": description.zero}
    known |= {"effort": description.effort, "speed": description.speed}
    stated = {key: {n: v for n, v in table.items() if n in names} for key, table in known.items()}
    notes = [f"{len(description.rigid)} joints made rigid"] if description.rigid else []
    return RawModel(spec, description.model_copy(update={**stated, "rigid": ()}), tuple(notes))


def _set_ranges(spec: mujoco.MjSpec, ranges: Mapping[str, tuple[float, float]]) -> None:
    """Set the limits of joints that are not rigid [rad]."""
    for name, limits in ranges.items():
        joint = spec.joint(name)
        if joint is not None:
            joint.range = np.degrees(limits) if spec.compiler.degree else limits
            joint.limited = mujoco.mjtLimited.mjLIMITED_TRUE


def _make_rigid(spec: mujoco.MjSpec, name: str, angle: float) -> None:
    """Remove a hinge joint and its actuators; its body keeps the place of an angle [rad]."""
    joint = spec.joint(name)
    body = joint.parent
    turned, carried, moved = np.empty(4), np.empty(4), np.empty(3)
    mujoco.mju_axisAngle2Quat(turned, np.asarray(joint.axis, float), angle)
    anchor = np.asarray(joint.pos, float)
    mujoco.mju_rotVecQuat(moved, anchor, turned)
    shift = np.empty(3)
    mujoco.mju_rotVecQuat(shift, anchor - moved, np.asarray(body.quat, float))
    mujoco.mju_mulQuat(carried, np.asarray(body.quat, float), turned)
    body.pos, body.quat = np.asarray(body.pos, float) + shift, carried
    for servo in [a for a in spec.actuators if a.target == name]:
        spec.delete(servo)
    spec.delete(joint)
