"""Kinematic tree of a URDF file in which some joints are held at an angle.

A *carrier* is the root or the child of a moving joint; a link behind a fixed or held joint moves
with its carrier.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from hsr8.robots.urdf_elements import TURNING, Joint
from hsr8.robots.urdf_file import Urdf

Array = NDArray[np.float64]


def joint_pose(joint: Joint, angle: float) -> Array:
    """Pose of the child of a joint in its parent.

    Args:
        joint: joint of any type.
        angle: [rad or m].

    Returns:
        Shape (4, 4) [m].
    """
    motion = np.eye(4)
    if joint.type in TURNING:
        motion[:3, :3] = Rotation.from_rotvec(angle * joint.axis).as_matrix()
    elif joint.type == "prismatic":
        motion[:3, 3] = angle * joint.axis
    product: Array = joint.pose @ motion
    return product


@dataclass(frozen=True, slots=True)
class Tree:
    """Tree of a URDF file.

    Attributes:
        urdf: links and joints.
        held: joints that do not move, with their angle [rad or m].
    """

    urdf: Urdf
    held: Mapping[str, float]

    def moves(self, joint: Joint) -> bool:
        """Return whether a joint is free to move."""
        return joint.type in TURNING and joint.name not in self.held

    def path(self, link: str) -> list[Joint]:
        """Joints from the root down to a link, fixed and held ones included."""
        joints = []
        while link in self.urdf.above:
            joint = self.urdf.above[link]
            joints.append(joint)
            link = joint.parent
        return joints[::-1]

    def moving_path(self, link: str) -> list[str]:
        """Names of the moving joints from the root down to a link."""
        return [joint.name for joint in self.path(link) if self.moves(joint)]

    def carrier(self, link: str) -> str:
        """Return the carrier of a link."""
        for joint in self.path(link)[::-1]:
            if self.moves(joint):
                break
            link = joint.parent
        return link

    def group(self, carrier: str) -> Iterator[tuple[str, Array]]:
        """Yield the links that move with a carrier, with their pose in it, shape (4, 4) [m]."""
        yield from self._group(carrier, np.eye(4))

    def _group(self, link: str, pose: Array) -> Iterator[tuple[str, Array]]:
        yield link, pose
        for joint in self.urdf.below(link):
            if not self.moves(joint):
                angle = self.held.get(joint.name, 0.0)
                yield from self._group(joint.child, pose @ joint_pose(joint, angle))

    def poses(self, angles: Mapping[str, float]) -> dict[str, Array]:
        """Pose of every link in the root.

        Args:
            angles: of moving joints, 0 where missing [rad].

        Returns:
            Shape (4, 4) [m], by link.
        """
        poses = {self.urdf.root: np.eye(4)}
        pending = [self.urdf.root]
        while pending:
            link = pending.pop()
            for joint in self.urdf.below(link):
                angle = self.held.get(joint.name, angles.get(joint.name, 0.0))
                poses[joint.child] = poses[link] @ joint_pose(joint, angle)
                pending.append(joint.child)
        return poses
