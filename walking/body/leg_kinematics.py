"""Leg kinematics in closed form: hip yaw-roll-pitch, knee, ankle pitch-roll."""

from dataclasses import dataclass

from walking.body import estimation_kernel, leg_kernel
from walking.body.leg_kernel import Angles as LegAngles
from walking.body.leg_kernel import Leg
from walking.value import value


@dataclass(frozen=True, slots=True)
class LegDimensions:
    """Dimensions of a leg.

    Attributes:
        hip_x, hip_y, hip_z: centre of the hip in the base frame [m].
        thigh: hip to knee [m].
        shank: knee to ankle [m].
        ankle_height: sole to ankle [m].
    """

    hip_x: float
    hip_y: float
    hip_z: float
    thigh: float
    shank: float
    ankle_height: float

    @property
    def length(self) -> float:
        """Hip to sole along the straight leg [m]."""
        return self.thigh + self.shank + self.ankle_height

    @property
    def row(self) -> Leg:
        """Row for kernels."""
        return self.hip_x, self.hip_y, self.hip_z, self.thigh, self.shank, self.ankle_height


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
    roll: float
    pitch: float
    yaw: float


def leg_angles(leg: LegDimensions, foot: FootPose) -> tuple[LegAngles, bool]:
    """Return the joint angles for a foot pose (inverse kinematics).

    For a foot out of reach the leg is straight and the orientation of the foot is kept.

    Args:
        leg: dimensions.
        foot: pose of the foot frame in the base frame.

    Returns:
        hip yaw, roll, pitch, knee, ankle pitch, roll [rad], and whether the foot is in reach.
    """
    return leg_kernel.leg_angles(leg.row, (foot.x, foot.y, foot.z, foot.roll, foot.pitch, foot.yaw))


def foot_pose(leg: LegDimensions, angles: LegAngles) -> FootPose:
    """Return the pose of the foot for joint angles [rad] (forward kinematics)."""
    return FootPose(*estimation_kernel.foot_pose(leg.row, angles))
