"""Closed-form kinematics of one leg: hip yaw-roll-pitch, knee, ankle pitch-roll.

The three hip axes meet in one point and so do the two ankle axes, hence the inverse is
analytic: the direction from ankle to hip in the foot's frame gives the ankle roll, the
distance gives the knee, the rest is an Euler decomposition at the hip. Scalars on purpose:
a leg costs a few microseconds.
"""

from dataclasses import dataclass
from math import acos, asin, atan2, cos, hypot, sin

from walking.value import value

LegAngles = tuple[float, float, float, float, float, float]
Vector = tuple[float, float, float]


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
    """Joint angles that put the foot where it is asked to be.

    A foot out of reach is approached as far as the leg goes, its orientation kept.

    Args:
        leg: dimensions.
        foot: pose of the foot frame in the base frame.

    Returns:
        hip yaw, roll, pitch, knee, ankle pitch, roll [rad], and whether the foot is in reach.
    """
    cr, sr = cos(foot.roll), sin(foot.roll)
    cp, sp = cos(foot.pitch), sin(foot.pitch)
    cy, sy = cos(foot.yaw), sin(foot.yaw)
    # Columns of R_BF.
    xx, xy, xz = cy * cp, sy * cp, -sp
    yx, yy, yz = cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr
    zx, zy, zz = cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr
    h = leg.ankle_height
    dx = leg.hip_x - foot.x - h * zx
    dy = leg.hip_y - foot.y - h * zy
    dz = leg.hip_z - foot.z - h * zz
    # Ankle to hip in the foot frame.
    rx = xx * dx + xy * dy + xz * dz
    ry = yx * dx + yy * dy + yz * dz
    rz = zx * dx + zy * dy + zz * dz
    l1, l2 = leg.thigh, leg.shank
    cosine = (rx * rx + ry * ry + rz * rz - l1 * l1 - l2 * l2) / (2.0 * l1 * l2)
    reachable = -1.0 <= cosine <= 1.0
    knee = acos(min(1.0, max(-1.0, cosine)))
    ankle_roll = atan2(ry, rz)
    ankle_pitch = atan2(-l1 * sin(knee), l2 + l1 * cos(knee)) - atan2(rx, hypot(ry, rz))
    # R_BF Rx(-ankle_roll) Ry(-knee - ankle_pitch) = Rz(yaw) Rx(roll) Ry(pitch) of the hip.
    cf, sf = cos(ankle_roll), sin(ankle_roll)
    cg, sg = cos(knee + ankle_pitch), sin(knee + ankle_pitch)
    mx, my, mz = cf * yx - sf * zx, cf * yy - sf * zy, cf * yz - sf * zz
    nz = sf * yz + cf * zz
    hip_roll = asin(min(1.0, max(-1.0, mz)))
    hip_yaw = atan2(-mx, my)
    hip_pitch = atan2(-(cg * xz + sg * nz), cg * nz - sg * xz)
    return (hip_yaw, hip_roll, hip_pitch, knee, ankle_pitch, ankle_roll), reachable


def foot_pose(leg: LegDimensions, angles: LegAngles) -> FootPose:
    """Pose of the foot frame in the base frame for given joint angles [rad]."""
    a, b, c, d, e, f = angles
    ca, sa, cb, sb, cf, sf = cos(a), sin(a), cos(b), sin(b), cos(f), sin(f)
    t, g = c + d, c + d + e
    cg, sg = cos(g), sin(g)
    h = leg.ankle_height
    x = -leg.thigh * sin(c) - leg.shank * sin(t) - h * cf * sg
    z = -leg.thigh * cos(c) - leg.shank * cos(t) - h * cf * cg
    y = h * sf
    y, z = y * cb - z * sb, y * sb + z * cb
    # Foot axes x and, for the roll, the z components of y and z.
    ux, uy, uz = cg, sg * sb, -sg * cb
    return FootPose(
        x=leg.hip_x + ca * x - sa * y,
        y=leg.hip_y + sa * x + ca * y,
        z=leg.hip_z + z,
        roll=atan2(cf * sb + sf * cb * cg, -sf * sb + cf * cb * cg),
        pitch=asin(min(1.0, max(-1.0, -uz))),
        yaw=atan2(sa * ux + ca * uy, ca * ux - sa * uy),
    )


def support_torques(
    leg: LegDimensions, angles: LegAngles, point: Vector, force: Vector
) -> LegAngles:
    """Joint torques by which a massless leg hands a force of the floor on to the base.

    Args:
        leg: dimensions.
        angles: joint angles [rad].
        point: where the floor pushes, in the base frame [m].
        force: of the floor on the foot, in the base frame [N].

    Returns:
        torque of each joint [N m].
    """
    a, b, c, d, e, _ = angles
    ca, sa, cb, sb = cos(a), sin(a), cos(b), sin(b)
    sg, cg = sin(c + d + e), cos(c + d + e)
    fx, fy, fz = force
    # Arms of the force about hip, knee and ankle.
    hx, hy, hz = point[0] - leg.hip_x, point[1] - leg.hip_y, point[2] - leg.hip_z
    along, down = -leg.thigh * sin(c), -leg.thigh * cos(c)
    kx, ky, kz = hx - ca * along - sa * sb * down, hy - sa * along + ca * sb * down, hz - cb * down
    along, down = along - leg.shank * sin(c + d), down - leg.shank * cos(c + d)
    ax, ay, az = hx - ca * along - sa * sb * down, hy - sa * along + ca * sb * down, hz - cb * down
    # Common pitch axis, and the axis of the ankle roll.
    px, py, pz = -sa * cb, ca * cb, sb
    rx, ry, rz = ca * cg - sa * sg * sb, sa * cg + ca * sg * sb, -sg * cb
    mx, my, mz = hy * fz - hz * fy, hz * fx - hx * fz, hx * fy - hy * fx
    nx, ny, nz = ay * fz - az * fy, az * fx - ax * fz, ax * fy - ay * fx
    return (
        -mz,
        -ca * mx - sa * my,
        -px * mx - py * my - pz * mz,
        -px * (ky * fz - kz * fy) - py * (kz * fx - kx * fz) - pz * (kx * fy - ky * fx),
        -px * nx - py * ny - pz * nz,
        -rx * nx - ry * ny - rz * nz,
    )
