"""Neck: pan and tilt of the camera's optical axis, and the joints that move it."""

from math import asin, atan2, cos, sin

import numpy as np

from walking.arrays import Array, Point
from walking.body import kinematics_kernel
from walking.body.tree import RobotTree


class Neck:
    """Camera on two head joints in either order, or fixed to the trunk.

    Pan and tilt are the direction of the optical axis in the base frame: left and up positive.

    Args:
        tree: the robot.
    """

    def __init__(self, tree: RobotTree) -> None:
        self._lower, self._upper = tree.lower, tree.upper
        self._head = tree.head
        self._tilt_first = tree.head is not None and tree.carries(tree.head[1], tree.head[0])
        order = tree.head or ()
        self._moving = list(order[::-1] if self._tilt_first else order)
        self._chain = tree.chain(self._moving, tree.camera)
        rest = tree.posture.copy()
        rest[self._moving] = 0.0
        axes, origins = np.zeros((2, 3)), np.zeros((2, 3))
        kinematics_kernel.chain_joints(self._chain, rest[self._moving], axes, origins)
        pan, tilt = axes[::-1] if self._tilt_first else axes
        self._signs = float(np.sign(pan[2])), -float(np.sign(tilt[1]))
        self._rest = self.angles(rest)  # of the optical axis with the head joints at zero

    def camera_pose(self, joint_position: Array) -> tuple[Array, Array]:
        """Return rotation R_BC (3, 3) and position p_BC (3,) [m] of the camera."""
        rotation, position = np.empty((3, 3)), np.empty(3)
        moving = joint_position[self._moving]
        kinematics_kernel.chain_end(self._chain, moving, rotation, position)
        return rotation, position

    def angles(self, joint_position: Array) -> Point:
        """Return pan and tilt for joint angles (n,) [rad]."""
        x, y, z = self.camera_pose(joint_position)[0][:, 2].tolist()
        return atan2(y, x), asin(min(1.0, max(-1.0, z)))

    def rates(self, joint_velocity: Array) -> Point:
        """Return the rates of pan and tilt for joint rates (n,) [rad/s]."""
        if self._head is None:
            return 0.0, 0.0
        pan, tilt = joint_velocity[list(self._head)].tolist()
        return self._signs[0] * pan, self._signs[1] * tilt

    def joints(self, pan: float, tilt: float) -> Point:
        """Return the angles of pan and tilt joint, within their range, for pan and tilt [rad]."""
        if self._head is None:
            return 0.0, 0.0
        if self._tilt_first:
            # The pan joint turns about a tilted axis: it alone moves the optical axis sideways.
            flat = cos(self._rest[1])
            side = asin(min(1.0, max(-1.0, cos(tilt) * sin(pan) / flat)))
            raised = atan2(sin(tilt), cos(tilt) * cos(pan))
            pan, tilt = side, raised - atan2(sin(self._rest[1]), flat * cos(side)) + self._rest[1]
        first, second = self._head
        return (
            self._within(first, self._signs[0] * (pan - self._rest[0])),
            self._within(second, self._signs[1] * (tilt - self._rest[1])),
        )

    def range(self) -> Array:
        """Return lower and upper limit of pan and tilt (2, 2) [rad]."""
        if self._head is None:
            return np.column_stack([self._rest, self._rest])
        joints = list(self._head)
        ends = np.array([self._lower[joints], self._upper[joints]]) * self._signs + self._rest
        return np.sort(ends, axis=0).T

    def _within(self, joint: int, angle: float) -> float:
        return float(min(self._upper[joint], max(self._lower[joint], angle)))
