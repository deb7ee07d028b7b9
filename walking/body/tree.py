"""Kinematic tree of a robot: the body as the walking engine receives it."""

from dataclasses import dataclass

import numpy as np

from walking.model import Sole
from walking.plane import Array, Indices

LEG_JOINTS = ("hip_yaw", "hip_roll", "hip_pitch", "knee", "ankle_pitch", "ankle_roll")
ARM_JOINTS = ("shoulder_pitch", "shoulder_roll", "elbow_yaw", "elbow_pitch", "wrist_yaw", "gripper")
HEAD_JOINTS = ("head_pan", "head_tilt")
JOINT_NAMES: tuple[str, ...] = (
    *(f"l_{name}" for name in LEG_JOINTS),
    *(f"r_{name}" for name in LEG_JOINTS),
    *HEAD_JOINTS,
    *(f"l_{name}" for name in ARM_JOINTS),
    *(f"r_{name}" for name in ARM_JOINTS),
)
"""Joints of HSR-VIII, in the order of its arrays."""

LEFT_LEG, RIGHT_LEG = slice(0, 6), slice(6, 12)  # of every robot, in every array


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """Frame fixed to a part of the robot.

    Attributes:
        joint: index of the joint that moves it, -1 for the base.
        rotation: orientation in the frame of that joint (3, 3).
        position: origin in the frame of that joint (3,) [m].
    """

    joint: int
    rotation: Array
    position: Array


@dataclass(frozen=True, slots=True, eq=False)
class RobotTree:
    """Joints, masses, servos and roles of a robot.

    The base frame has x forward and z up in the ready posture. Joints are ordered: six of the left
    leg, six of the right leg, each hip first, then all others, parents before children. In every
    array they have this order. The frame of a joint is at its axis and, with all joints at zero,
    parallel to the base.

    Attributes:
        names: names of the joints (n,).
        parents: index of the joint that carries each joint, -1 for the base (n,).
        positions: positions of the joint frames in those of their parents (n, 3) [m].
        axes: axes of rotation, in the joint frames (n, 3).
        bodies: frames of the centres of mass of all bodies, along their principal axes (m,).
        masses: masses of the bodies (m,) [kg].
        inertias: principal moments of inertia of the bodies (m, 3) [kg m²].
        lower, upper: joint limits (n,) [rad].
        stiffness: stiffness of each servo (n,) [N m/rad].
        servo_damping: damping of each servo (n,) [N m s/rad].
        joint_damping: damping of each joint (n,) [N m s/rad].
        armature: armature of each joint (n,) [kg m²].
        effort: maximum torque, infinite if unknown (n,) [N m].
        speed: maximum speed, infinite if unknown (n,) [rad/s].
        posture: angles with straight legs and the other joints as while walking (n,) [rad].
        feet: frames on the floor below the left and the right ankle, x forward, in that posture.
        sole: rectangle of each sole in the foot frame.
        camera: right, down and forward axes of the camera.
        head: pan and tilt joint; None of a robot without a movable head.
        shoulders: left and right shoulder pitch joint; None without arms.
    """

    names: tuple[str, ...]
    parents: Indices
    positions: Array
    axes: Array
    bodies: tuple[Frame, ...]
    masses: Array
    inertias: Array
    lower: Array
    upper: Array
    stiffness: Array
    servo_damping: Array
    joint_damping: Array
    armature: Array
    effort: Array
    speed: Array
    posture: Array
    feet: tuple[Frame, Frame]
    sole: Sole
    camera: Frame
    head: tuple[int, int] | None = None
    shoulders: tuple[int, int] | None = None

    def carries(self, one: int, other: int) -> bool:
        """Return whether a joint carries another one."""
        return one in self.path(int(self.parents[other]))

    def path(self, joint: int) -> list[int]:
        """Return the joints from the base to a joint, itself included."""
        path = []
        while joint >= 0:
            path.append(joint)
            joint = int(self.parents[joint])
        return path[::-1]

    def chain(self, joints: list[int], end: Frame) -> Array:
        """Return the chain of some joints to a frame, see `kinematics` (k + 1, 15).

        All other joints between base and frame keep their angle of the posture.

        Args:
            joints: moving joints, base first.
            end: frame at the end.
        """
        rows, rotation, position = [], np.eye(3), np.zeros(3)
        for joint in self.path(end.joint):
            position = position + rotation @ self.positions[joint]
            if joint in joints:
                rows.append([*rotation.ravel(), *position, *self.axes[joint]])
                rotation, position = np.eye(3), np.zeros(3)
            else:
                rotation = rotation @ turn(self.axes[joint], float(self.posture[joint]))
        position = position + rotation @ end.position
        rows.append([*(rotation @ end.rotation).ravel(), *position, 0.0, 0.0, 0.0])
        return np.array(rows)

    def links(self) -> tuple[Array, Indices]:
        """Return the links as arrays, see `kinematics.tree_pass`.

        Returns:
            Links: position of each joint in the frame of its parent [m], its axis, mass [kg] and
            first moment [kg m] of its link in its frame; the last row is the base (n + 1, 10).
            Order: joints and their parents, parents first, n for the base (n, 2).
        """
        n = len(self.names)
        links = np.zeros((n + 1, 10))
        links[:n, :3], links[:n, 3:6] = self.positions, self.axes
        for body, mass in zip(self.bodies, self.masses, strict=True):
            links[body.joint, 6] += mass
            links[body.joint, 7:] += mass * body.position
        joints = sorted(range(n), key=lambda joint: len(self.path(joint)))
        parents = self.parents[joints] % (n + 1)  # the base, -1, becomes n
        return links, np.column_stack([joints, parents])


def turn(axis: Array, angle: float) -> Array:
    """Return the rotation (3, 3) about a unit axis (3,) by an angle [rad]."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    rotation: Array = np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross
    return rotation
