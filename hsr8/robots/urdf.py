"""Conversion of a URDF file to a MuJoCo model with a free base, x forward and z up."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray

from hsr8.robots.description import RobotDescription
from hsr8.robots.mesh_points import package_folders
from hsr8.robots.posture import check_joint_names, clip_to_range, stated_posture
from hsr8.robots.urdf_base import find_base
from hsr8.robots.urdf_compare import compare_with_file
from hsr8.robots.urdf_file import read_urdf
from hsr8.robots.urdf_joints import MAX_EFFORT, MAX_SPEED, Joints, joint_range, sort_joints, stated
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
        spec: the model; the base stands on z = 0 at zero angles.
        base: body with the free joint.
        feet: bodies of the left and the right foot.
        soles: left and right sole, relative to the origins of the feet in the directions of the
            base at the angles `zero`.
        posture: angles of the joints other than those of the legs, where not zero [rad].
        effort: maximum torque of each joint that states one [N m].
        speed: maximum speed of each joint that states one [rad/s].
        notes: one line per derived fact.
    """

    spec: mujoco.MjSpec
    base: str
    feet: tuple[str, str]
    soles: tuple[Sole, Sole]
    posture: dict[str, float]
    effort: dict[str, float]
    speed: dict[str, float]
    notes: tuple[str, ...]


def convert(file: Path, description: RobotDescription, folder: Path) -> Converted:
    """Convert a URDF file.

    Args:
        file: URDF file.
        description: its feet, and whatever the file does not state.
        folder: of the description file; SRDF file and package folders are relative to it.

    Raises:
        ModelError: the robot cannot be converted; the message has the element, the reason and the
            remedy.
    """
    urdf = read_urdf(file)
    moving = [j.name for j in urdf.joints.values() if j.type != "fixed"]
    check_joint_names(description, moving, file)
    packages = package_folders(description.packages, folder)
    stated_angles = stated_posture(description, folder)
    joints = sort_joints(urdf, description, stated_angles)
    base = find_base(joints, description)
    spec = mujoco.MjSpec()
    geoms = GeomBuilder(spec, file, packages)
    soles, sole_notes = find_soles(joints, base, description, geoms)
    posture, posture_notes = _posture(joints, stated_angles)
    effort, speed, limit_notes = _limits(joints, description)
    builder = ModelBuilder(joints, base, description, soles, effort)
    model = builder.build(spec, geoms)
    compare_with_file(model, file, base.link, base.rotation, joints.tree.held)
    left, right = (joints.tree.carrier(foot) for foot in description.feet)
    poses = joints.tree.poses(description.zero)
    origins = [-(base.root_pose @ poses[foot])[:3, 3] for foot in (left, right)]
    return Converted(
        spec=spec,
        base=base.link,
        feet=(left, right),
        soles=(soles[0].shifted(origins[0]), soles[1].shifted(origins[1])),
        posture=posture,
        effort=effort,
        speed=speed,
        notes=(
            *joints.notes,
            *base.notes,
            *sole_notes,
            *posture_notes,
            *limit_notes,
            *builder.notes,
            *geoms.notes(),
        ),
    )


def _posture(
    joints: Joints, stated_angles: Mapping[str, float]
) -> tuple[dict[str, float], list[str]]:
    """Nonzero angles of the moving joints outside the legs, and notes on clipped ones."""
    angles, notes = {}, []
    legs = {*joints.legs[0], *joints.legs[1]}
    for joint in joints.tree.urdf.joints.values():
        if not joints.tree.moves(joint) or joint.name in legs:
            continue
        lower, upper = joint_range(joint)
        desired = stated_angles.get(joint.name, 0.0)
        angle = clip_to_range(desired, lower, upper)
        if angle != desired:
            notes.append(
                f"posture: '{joint.name}' clipped from {desired:.3f} to {angle:.3f} rad, its range "
                f"is {lower:.3f} .. {upper:.3f}"
            )
        if angle != 0.0:
            angles[joint.name] = angle
    return angles, notes


def _limits(
    joints: Joints, description: RobotDescription
) -> tuple[dict[str, float], dict[str, float], list[str]]:
    """Maximum torque and speed of the joints that state them, and a note on the others."""
    moving = [j for j in joints.tree.urdf.joints.values() if joints.tree.moves(j)]
    effort = {j.name: j.effort for j in moving if stated(j.effort, MAX_EFFORT)}
    speed = {j.name: j.speed for j in moving if stated(j.speed, MAX_SPEED)}
    names = {joint.name for joint in moving}
    effort |= {name: value for name, value in description.effort.items() if name in names}
    speed |= {name: value for name, value in description.speed.items() if name in names}
    notes = []
    for key, values in (("effort", effort), ("speed", speed)):
        silent = [j.name for j in moving if j.name not in values]
        if silent:
            more = " ..." if len(silent) > 6 else ""
            notes.append(
                f"{key} of {len(silent)} joints is not stated and not limited: "
                f"{', '.join(silent[:6])}{more}"
            )
    return effort, speed, notes
