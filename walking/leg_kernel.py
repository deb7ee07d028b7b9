"""Kinematics of the legs and what is built on them in every control tick, compiled.

A leg is given by the numbers of `LegDimensions`, in their order [m].
"""

from math import acos, asin, atan2, cos, hypot, sin

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Point = tuple[float, float]
Vector = tuple[float, float, float]
Leg = tuple[float, float, float, float, float, float]
Pose = tuple[float, float, float, float, float, float]
"""Of a foot in the base frame: x, y, z [m], roll, pitch, yaw [rad]."""

Angles = tuple[float, float, float, float, float, float]
"""Hip yaw, roll, pitch, knee, ankle pitch, roll [rad]."""

Foot = tuple[float, float, float, float]
"""Reference of a foot in the plan frame: x, y [m], yaw [rad], height [m]."""

STILL_TILT = 1e-6  # tilt of a foot that counts as none [rad]


@njit(cache=True)
def leg_angles(leg: Leg, foot: Pose) -> tuple[Angles, bool]:
    """Joint angles that put the foot where it is asked to be, and whether it is in reach.

    The three hip axes meet in one point and so do the two ankle axes, hence the inverse is
    analytic: the direction from ankle to hip in the foot's frame gives the ankle roll, the
    distance gives the knee, the rest is an Euler decomposition at the hip.
    """
    hip_x, hip_y, hip_z, l1, l2, h = leg
    x, y, z, roll, pitch, yaw = foot
    cr, sr = cos(roll), sin(roll)
    cp, sp = cos(pitch), sin(pitch)
    cy, sy = cos(yaw), sin(yaw)
    # Columns of R_BF.
    xx, xy, xz = cy * cp, sy * cp, -sp
    yx, yy, yz = cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr
    zx, zy, zz = cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr
    dx = hip_x - x - h * zx
    dy = hip_y - y - h * zy
    dz = hip_z - z - h * zz
    # Ankle to hip in the foot frame.
    rx = xx * dx + xy * dy + xz * dz
    ry = yx * dx + yy * dy + yz * dz
    rz = zx * dx + zy * dy + zz * dz
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


@njit(cache=True)
def pose(
    position: Array,
    tilts: Array,
    feet: tuple[Foot, Foot],
    which: tuple[int, int],
    com: Point,
    head: Point,
    tilt: Point,
    law: tuple[float, float, float, float, float],
    build: Vector,
    legs: tuple[Leg, Leg],
) -> Vector:
    """Set the joints of legs and head, and swing the arms.

    A foot in the air stays level with the floor although the trunk is not.

    Args:
        position: joint angles of the ready posture, to be those of this tick (26,) [rad].
        tilts: roll and pitch by which either foot makes up for the trunk's, brought up to date
            (2, 2) [rad].
        feet: references of the left and of the right foot.
        which: index of the support foot, and of the foot in the air, -1 for none.
        com: where the body's mass centre is meant to be, x, y in the plan frame [m].
        head: pan and tilt [rad].
        tilt: measured roll and pitch of the trunk [rad].
        law: share of the tilt taken out of the foot [1], tilt that is ignored [rad], pull and
            decay per tick [1], height of the base above the floor [m].
        build: mass centre ahead of the base [m]; shoulder pitch per distance between the feet
            [rad/m] and its limit [rad].
        legs: left and right.

    Returns:
        the pelvis: x, y [m], heading [rad] in the plan frame.
    """
    pelvis = pelvis_of(feet, com, build[0])
    apart = _pose_legs(position, tilts, feet, which, pelvis, tilt, law, legs)
    swing = arm_swing(apart, build[1], build[2])
    position[12], position[13] = head
    position[14] += swing
    position[20] -= swing
    return pelvis


@njit(cache=True)
def pelvis_of(feet: tuple[Foot, Foot], com: Point, ahead: float) -> Vector:
    """Pelvis that has the mass centre `ahead` of it at `com`, between the feet's directions."""
    yaw = 0.5 * (feet[0][2] + feet[1][2])
    return com[0] - ahead * cos(yaw), com[1] - ahead * sin(yaw), yaw


@njit(cache=True)
def arm_swing(apart: float, gain: float, limit: float) -> float:
    """Shoulder pitch of the left arm away from the ready posture; the right one mirrors it.

    The arms swing against the legs.

    Args:
        apart: left foot ahead of the right foot along the heading [m].
        gain: pitch per distance [rad/m].
        limit: largest pitch [rad].

    Returns:
        backward positive [rad].
    """
    return min(limit, max(-limit, gain * apart))


@njit(cache=True)
def _pose_legs(
    position: Array,
    tilts: Array,
    feet: tuple[Foot, Foot],
    which: tuple[int, int],
    pelvis: Vector,
    tilt: Point,
    law: tuple[float, float, float, float, float],
    legs: tuple[Leg, Leg],
) -> float:
    """Set the joints of the legs; how far the left foot is ahead of the right one [m]."""
    c, s = cos(pelvis[2]), sin(pelvis[2])
    gain, zone, pull, decay, base = law
    support = feet[which[0]]
    for index in range(2):
        own = tilts[index]
        for axis in range(2):
            if index == which[1]:
                excess = max(0.0, tilt[axis] - zone) + min(0.0, tilt[axis] + zone)
                own[axis] += pull * (gain * excess - own[axis])
            elif own[axis] != 0.0:
                own[axis] *= decay
                if abs(own[axis]) < STILL_TILT:
                    own[axis] = 0.0
        x, y, yaw, height = feet[index]
        roll, pitch = own[0], own[1]
        if roll != 0.0 or pitch != 0.0:
            ax, ay = x - support[0], y - support[1]
            height += pitch * (c * ax + s * ay) - roll * (c * ay - s * ax)
        dx, dy, turned = x - pelvis[0], y - pelvis[1], yaw - pelvis[2]
        cf, sf = cos(turned), sin(turned)
        foot = (
            c * dx + s * dy,
            c * dy - s * dx,
            height - base,
            -(cf * roll + sf * pitch),
            -(cf * pitch - sf * roll),
            turned,
        )
        angles, _ = leg_angles(legs[index], foot)
        for joint in range(6):
            position[6 * index + joint] = angles[joint]
    return c * (feet[0][0] - feet[1][0]) + s * (feet[0][1] - feet[1][1])
