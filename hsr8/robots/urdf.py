"""Conversion of a URDF file to a MuJoCo model with a free base, x forward and z up."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.robots.description import CameraMount, RobotDescription
from hsr8.robots.key_mistake import KeyMistake, require_name
from hsr8.robots.mesh_points import package_folders
from hsr8.robots.posture import check_joint_names, stated_posture
from hsr8.robots.urdf_base import find_base
from hsr8.robots.urdf_compare import compare_with_file
from hsr8.robots.urdf_file import read_urdf
from hsr8.robots.urdf_joints import MAX_EFFORT, MAX_SPEED, Joints, sort_joints, stated
from hsr8.robots.urdf_model import ModelBuilder
from hsr8.robots.urdf_shapes import GeomBuilder
from hsr8.robots.urdf_soles import Sole, find_soles

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Converted:
    """Robot of a URDF file as a MuJoCo model without actuators.

    Links behind fixed or held joints are part of the body that carries them, which has the name of
    the child link of its joint.

    Attributes:
        spec: the model; the base stands on z = 0 at the angles `zero`.
        description: of the robot, in terms of the model: its feet, base and camera are bodies,
            effort and speed are complete, and its soles are those of the model.
        feet: bodies of the left and the right foot.
        soles: left and right sole, relative to the origins of the feet in the directions of the
            base at the angles `zero`.
        notes: one line per derived fact.
    """

    spec: mujoco.MjSpec
    description: RobotDescription
    feet: tuple[str, str]
    soles: tuple[Sole, Sole]
    notes: tuple[str, ...]


def convert(file: Path, description: RobotDescription, folder: Path) -> Converted:
    """Convert a URDF file.

    Args:
        file: URDF file.
        description: its feet, and whatever the file does not state.
        folder: of the description file; SRDF file and package folders are relative to it.

    Raises:
        KeyMistake: a key of the description is wrong.
        ModelError: the robot cannot be converted; the message has the element, the reason and the
            remedy.
    """
    if description.servo == "own":
        raise KeyMistake(
            "servo: a URDF file has no servos, got 'own'; expected 'rule', the default"
        )
    urdf = read_urdf(file).with_ranges(description.range)
    moving = [j.name for j in urdf.joints.values() if j.type != "fixed"]
    check_joint_names(description, moving)
    packages = package_folders(description.packages, folder)
    stated_angles = stated_posture(description, folder)
    joints = sort_joints(urdf, description, stated_angles)
    base = find_base(joints, description)
    spec = mujoco.MjSpec()
    geoms = GeomBuilder(spec, file, packages)
    soles, sole_notes = find_soles(joints, base, description, geoms)
    effort, speed, limit_notes = _limits(joints, description)
    builder = ModelBuilder(joints, base, description, soles, effort)
    model = builder.build(spec, geoms)
    compare_with_file(model, file, base.link, base.rotation, joints.tree.held)
    left, right = (joints.tree.carrier(foot) for foot in description.feet)
    poses = joints.tree.poses(description.zero)
    positions = {link: (base.root_pose @ pose)[:3, 3] for link, pose in poses.items()}
    adapted = description.model_copy(
        update={
            "feet": (left, right),
            "base": base.link,
            "sole": None,
            "zero": {name: v for name, v in description.zero.items() if name in joints.names},
            "posture": {name: v for name, v in stated_angles.items() if name in joints.names},
            "srdf": None,
            "state": None,
            "camera": _camera(joints, description, positions),
            "effort": effort,
            "speed": speed,
            "rigid": (),
        }
    )
    return Converted(
        spec=spec,
        description=adapted,
        feet=(left, right),
        soles=(soles[0].shifted(-positions[left]), soles[1].shifted(-positions[right])),
        notes=(
            *joints.notes,
            *base.notes,
            *sole_notes,
            *limit_notes,
            *builder.notes,
            *geoms.notes(),
        ),
    )


def _camera(
    joints: Joints, description: RobotDescription, positions: Mapping[str, Array]
) -> CameraMount | None:
    """Mount of the camera on a body of the model, where the description names a link."""
    mount, tree = description.camera, joints.tree
    if mount is None:
        return None
    if isinstance(mount, str):
        raise KeyMistake(
            f"camera: a URDF file has no cameras, got {mount!r}; expected a link as "
            "{body, position, tilt_deg}"
        )
    require_name("camera.body", "link", mount.body, list(positions))
    carrier = tree.carrier(mount.body)
    at = positions[mount.body] - positions[carrier] + mount.position
    x, y, z = at.tolist()
    return mount.model_copy(update={"body": carrier, "position": (x, y, z)})


def _limits(
    joints: Joints, description: RobotDescription
) -> tuple[dict[str, float], dict[str, float], list[str]]:
    """Maximum torque and speed of the joints that state them, and a note on the others."""
    effort = {j.name: j.effort for j in joints.moving if stated(j.effort, MAX_EFFORT)}
    speed = {j.name: j.speed for j in joints.moving if stated(j.speed, MAX_SPEED)}
    effort |= {name: value for name, value in description.effort.items() if name in joints.names}
    speed |= {name: value for name, value in description.speed.items() if name in joints.names}
    notes = []
    for key, values in (("effort", effort), ("speed", speed)):
        silent = [j.name for j in joints.moving if j.name not in values]
        if silent:
            more = " ..." if len(silent) > 6 else ""
            notes.append(
                f"{key} of {len(silent)} joints is not stated and not limited: "
                f"{', '.join(silent[:6])}{more}"
            )
    return effort, speed, notes
