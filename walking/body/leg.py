"""Leg: a chain of six joints from the base to the foot."""

from dataclasses import dataclass
from math import asin, atan2

import numpy as np

from walking.arrays import Array, Vector
from walking.body import kinematics
from walking.body.kinematics import Pose
from walking.value import value

BEND = (-0.4, 0.8, -0.4)  # pitch of hip, knee and ankle of a slightly bent leg [rad]
STRETCH = 0.985  # maximum distance of hip and ankle relative to thigh and shank [1]


@value
class FootPose:
    """Pose of a foot frame in the base frame, R = Rz(yaw) Ry(pitch) Rx(roll).

    Attributes:
        x, y, z: position of the sole below the ankle [m].
        roll, pitch, yaw: orientation [rad].
    """

    x: float
    y: float
    z: float
    roll: float = 0.0
    pitch: float = 0.0
    yaw: float = 0.0

    @property
    def row(self) -> Pose:
        """Row for kernels."""
        return self.x, self.y, self.z, self.roll, self.pitch, self.yaw


@dataclass(frozen=True, slots=True, eq=False)
class Leg:
    """Kinematics of a leg.

    Attributes:
        chain: see `kinematics` (7, 15).
        straight: joint angles of the straight leg (6,) [rad].
        bent: joint angles of a slightly bent leg, where inverse kinematics starts (6,) [rad].
        pitching: indices of hip pitch, knee and ankle pitch among its joints.
        hip: origin of the hip pitch joint in the base frame, straight [m].
        foot: position of the foot frame in the base frame, straight [m].
        reach: see `kinematics` (7,).
    """

    chain: Array
    straight: Array
    bent: Array
    pitching: tuple[int, int, int]
    hip: Vector
    foot: Vector
    reach: Array

    @staticmethod
    def of(chain: Array, straight: Array) -> "Leg":
        """Return the leg of a chain (7, 15) that is straight at some joint angles (6,) [rad]."""
        axes, origins = np.empty((6, 3)), np.empty((6, 3))
        kinematics.chain_joints(chain, straight, axes, origins)
        first, second, third = sorted(np.argsort(-np.abs(axes[:, 1]), kind="stable")[:3].tolist())
        pitching = (first, second, third)
        bent = straight.copy()
        bent[list(pitching)] += np.array(BEND) * np.sign(axes[list(pitching), 1])
        rotation, foot = np.empty((3, 3)), np.empty(3)
        kinematics.chain_end(chain, straight, rotation, foot)
        hip, knee, ankle = origins[list(pitching)]
        stretched = STRETCH * (np.linalg.norm(knee - hip) + np.linalg.norm(ankle - knee))
        reach = np.array([*hip, *(rotation.T @ (ankle - foot)), stretched])
        hx, hy, hz = hip.tolist()
        fx, fy, fz = foot.tolist()
        return Leg(chain, straight, bent, pitching, (hx, hy, hz), (fx, fy, fz), reach)

    @property
    def length(self) -> float:
        """Hip to sole along the straight leg [m]."""
        return self.hip[2] - self.foot[2]

    @property
    def ankle(self) -> int:
        """First joint of the ankle."""
        return self.pitching[1] + 1

    def angles(self, foot: FootPose) -> tuple[Array, float]:
        """Return the joint angles for a foot pose (6,) [rad], and the remaining error [rad].

        Out of reach the error is that of the nearest pose, positions relative to the length.
        """
        angles = self.bent.copy()
        _, error = kinematics.solve(self.chain, foot.row, angles, self.length)
        return angles, error

    def pose(self, angles: Array) -> FootPose:
        """Return the pose of the foot for joint angles (6,) [rad] (forward kinematics)."""
        R, p = np.empty((3, 3)), np.empty(3)
        kinematics.chain_end(self.chain, np.asarray(angles, float), R, p)
        x, y, z = p.tolist()
        roll, pitch = atan2(R[2, 1], R[2, 2]), -asin(min(1.0, max(-1.0, R[2, 0])))
        return FootPose(x, y, z, roll, pitch, atan2(R[1, 0], R[0, 0]))

    def joints(self, angles: Array) -> tuple[Array, Array]:
        """Return axes (6, 3) and origins (6, 3) [m] of the joints in the base frame."""
        axes, origins = np.empty((6, 3)), np.empty((6, 3))
        kinematics.chain_joints(self.chain, np.asarray(angles, float), axes, origins)
        return axes, origins
