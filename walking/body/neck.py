"""Neck: pan and tilt of the camera's optical axis, and the joints that move it."""

from math import asin, atan2

import numpy as np

from walking.arrays import Array, Indices, Point
from walking.body import kinematics
from walking.body.tree import RobotTree
from walking.records import Record


class Neck:
    """Camera on two head joints in either order, or fixed to the trunk.

    Pan and tilt are the direction of the optical axis in the base frame: left and up positive.

    Args:
        tree: the robot.

    Attributes:
        chain: chain from the base to the camera, see `walking.body.kinematics`, and the indices of
            its joints.
    """

    def __init__(self, tree: RobotTree) -> None:
        self._lower, self._upper = tree.lower, tree.upper
        self._head = tree.head
        self._tilt_first = tree.head is not None and tree.carries(tree.head[1], tree.head[0])
        order = tree.head or ()
        moving = list(order[::-1] if self._tilt_first else order)
        self.chain: tuple[Array, Indices] = (
            tree.chain(moving, tree.camera),
            np.array(moving, dtype=np.int64),
        )
        rest = tree.posture.copy()
        rest[moving] = 0.0
        axes, origins = np.zeros((2, 3)), np.zeros((2, 3))
        kinematics.chain_joints(self.chain[0], rest[moving], axes, origins)
        pan, tilt = axes[::-1] if self._tilt_first else axes
        self._signs = float(np.sign(pan[2])), -float(np.sign(tilt[1]))
        self._rest = self.angles(rest)  # of the optical axis with the head joints at zero

    def angles(self, joint_position: Array) -> Point:
        """Return pan and tilt for joint angles (n,) [rad]."""
        (chain, moving), rotation = self.chain, np.empty((3, 3))
        kinematics.chain_end(chain, joint_position[moving], rotation, np.empty(3))
        x, y, z = rotation[:, 2].tolist()
        return atan2(y, x), asin(min(1.0, max(-1.0, z)))

    def rates(self, joint_velocity: Array) -> Point:
        """Return the rates of pan and tilt for joint rates (n,) [rad/s]."""
        if self._head is None:
            return 0.0, 0.0
        pan, tilt = joint_velocity[list(self._head)].tolist()
        return self._signs[0] * pan, self._signs[1] * tilt

    def range(self) -> Array:
        """Return lower and upper limit of pan and tilt (2, 2) [rad]."""
        if self._head is None:
            return np.column_stack([self._rest, self._rest])
        joints = list(self._head)
        ends = np.array([self._lower[joints], self._upper[joints]]) * self._signs + self._rest
        return np.sort(ends, axis=0).T

    def describe(self, record: Record) -> None:
        """Set a record `walking.records.NECK`."""
        record.movable, record.tilt_first = self._head is not None, self._tilt_first
        record.pan_joint, record.tilt_joint = self._head or (-1, -1)
        record.pan_sign, record.tilt_sign = self._signs
        record.rest_pan, record.rest_tilt = self._rest
        record.lower, record.upper = self.range().T
