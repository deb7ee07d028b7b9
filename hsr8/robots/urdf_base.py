"""Base of a URDF robot: the link that is free to move, and the turn that makes x forward, z up."""

from dataclasses import dataclass
from math import acos, degrees

import numpy as np
from numpy.typing import NDArray

from hsr8.robots.description import RobotDescription
from hsr8.robots.key_mistake import KeyMistake
from hsr8.robots.urdf_joints import Joints

Array = NDArray[np.float64]
MAX_LEFT_ANGLE, MAX_UP_ANGLE = 5.0, 20.0  # from the nearest axis of the base link [deg]
MIN_STANCE = 1e-3  # distance of the feet [m]
_AXES = ("x", "y", "z")


@dataclass(frozen=True, slots=True)
class Base:
    """Base of a robot.

    Attributes:
        link: whose origin is that of the base.
        rotation: from the directions of that link to those of the base: forward, left, up; shape
            (3, 3).
        root_pose: pose of the root link in the base, shape (4, 4) [m].
        notes: one line per derived fact.
    """

    link: str
    rotation: Array
    root_pose: Array
    notes: tuple[str, ...]


def find_base(joints: Joints, description: RobotDescription) -> Base:
    """Find the base link and its turn.

    The base is the last link that the two legs have in common and that is fixed to the root. Left
    is from the right to the left foot, up from the feet to the hips, at the angles `zero`.

    Raises:
        KeyMistake: the stated base is not fixed to the root, or the robot does not stand with its
            feet side by side below the hips.
    """
    tree, urdf = joints.tree, joints.tree.urdf
    link = description.base or _common_link(joints, description)
    if link not in urdf.links or tree.carrier(link) != urdf.root:
        raise KeyMistake(
            f"base: not fixed to the root, got '{link}'; expected the root link '{urdf.root}' or "
            "one fixed to it: leave the key out, joints between base and hips are held"
        )
    poses = tree.poses(description.zero)
    to_link = np.linalg.inv(poses[link])
    feet = [(to_link @ poses[tree.carrier(foot)])[:3, 3] for foot in description.feet]
    hips = [(to_link @ poses[urdf.joints[leg[0]].child])[:3, 3] for leg in joints.legs]
    across, upward = feet[0] - feet[1], 0.5 * (hips[0] + hips[1] - feet[0] - feet[1])
    if np.linalg.norm(across) < MIN_STANCE:
        raise KeyMistake(
            f"feet: '{description.feet[0]}' and '{description.feet[1]}' have the same "
            "position at zero angles; expected feet side by side: state `zero`"
        )
    left = _axis(joints, across, "from the right to the left foot", link, MAX_LEFT_ANGLE)
    up = _axis(joints, upward, "from the feet to the hips", link, MAX_UP_ANGLE)
    forward = np.cross(left, up)
    if not forward.any():
        raise KeyMistake(
            "zero: the feet are not side by side below the hips; expected a "
            "robot that stands: state `zero`"
        )
    rotation = np.array([forward, left, up])
    root_pose = np.eye(4)
    root_pose[:3, :3] = rotation
    notes = []
    if link != urdf.root:
        notes.append(f"base: link '{link}', fixed to the root '{urdf.root}'")
    if not np.array_equal(rotation, np.eye(3)):
        notes.append(
            f"base turned: forward is {_axis_name(forward)} of link '{link}', up its "
            f"{_axis_name(up)}"
        )
    return Base(link, rotation, root_pose @ to_link, tuple(notes))


def _common_link(joints: Joints, description: RobotDescription) -> str:
    tree = joints.tree
    left, right = (tree.path(foot) for foot in description.feet)
    link = tree.urdf.root
    for a, b in zip(left, right, strict=False):
        if a.name != b.name or tree.moves(a):
            break
        link = a.child
    return link


def _axis(joints: Joints, vector: Array, meaning: str, link: str, max_angle: float) -> Array:
    """Axis of the base link nearest to a vector, shape (3,)."""
    k = int(np.abs(vector).argmax())
    axis = np.zeros(3)
    axis[k] = np.sign(vector[k])
    angle = degrees(acos(min(1.0, float(vector @ axis) / float(np.linalg.norm(vector)))))
    if angle > max_angle:
        raise KeyMistake(
            f"zero: the direction {meaning} is "
            f"{np.round(vector, 3).tolist()} m in link '{link}', {angle:.0f} deg from its axes; "
            f"expected at most {max_angle:.0f} deg: state in `zero` the angles at which the robot "
            "stands with straight legs"
        )
    return axis


def _axis_name(axis: Array) -> str:
    k = int(np.abs(axis).argmax())
    return f"{'-' if axis[k] < 0 else ''}{_AXES[k]}"
