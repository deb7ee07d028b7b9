"""Kinematics of chains of joints (legs, head), and of the whole tree in one pass.

A chain of k joints is an array (k + 1, 15): of each joint the fixed rotation (9, row by row) and
translation (3) of its frame in that of the joint before, then its axis (3); the last row is the
frame at the end of the chain, with no axis. The first row is relative to the base.
"""

from dataclasses import dataclass
from math import asin, atan2, cos, sin, sqrt
from typing import NamedTuple

import numpy as np

from compilation import compiled
from compilation.record import Records
from walking.model import Link
from walking.plane import Array, Indices, Vector, clamp

Matrix = tuple[float, float, float, float, float, float, float, float, float]
"""Rotation, row by row."""

MOVE, AXIS = 9, 12  # first columns of translation and axis, after those of the rotation
CONVERGED = 1e-11  # error of a solved pose [rad], positions relative to the length of the leg
MAX_ITERATIONS = 20
MAX_STEP = 0.4  # change of a joint in one iteration [rad]
MIN_DAMPING, MAX_DAMPING = 1e-14, 1e-3  # of the normal equations, near and far from the solution
MIN_PIVOT = 1e-18  # of their Cholesky factor
BEND = (-0.4, 0.8, -0.4)  # pitch of hip, knee and ankle of a slightly bent leg [rad]
STRETCH = 0.985  # maximum distance of hip and ankle relative to thigh and shank [1]


@compiled
def times(a: Matrix, b: Matrix) -> Matrix:
    """Return the product of two rotations."""
    return (
        a[0] * b[0] + a[1] * b[3] + a[2] * b[6],
        a[0] * b[1] + a[1] * b[4] + a[2] * b[7],
        a[0] * b[2] + a[1] * b[5] + a[2] * b[8],
        a[3] * b[0] + a[4] * b[3] + a[5] * b[6],
        a[3] * b[1] + a[4] * b[4] + a[5] * b[7],
        a[3] * b[2] + a[4] * b[5] + a[5] * b[8],
        a[6] * b[0] + a[7] * b[3] + a[8] * b[6],
        a[6] * b[1] + a[7] * b[4] + a[8] * b[7],
        a[6] * b[2] + a[7] * b[5] + a[8] * b[8],
    )


@compiled
def rotated(a: Matrix, x: float, y: float, z: float) -> Vector:
    """Return a rotated vector."""
    return (
        a[0] * x + a[1] * y + a[2] * z,
        a[3] * x + a[4] * y + a[5] * z,
        a[6] * x + a[7] * y + a[8] * z,
    )


@compiled
def about(x: float, y: float, z: float, angle: float) -> Matrix:
    """Return the rotation about a unit axis by an angle [rad]."""
    c, s = cos(angle), sin(angle)
    d = 1.0 - c
    return (
        c + d * x * x,
        d * x * y - s * z,
        d * x * z + s * y,
        d * x * y + s * z,
        c + d * y * y,
        d * y * z - s * x,
        d * x * z - s * y,
        d * y * z + s * x,
        c + d * z * z,
    )


@compiled
def rotation_of(row: Array) -> Matrix:
    """Return the rotation in the first nine columns of a row."""
    return row[0], row[1], row[2], row[3], row[4], row[5], row[6], row[7], row[8]


@compiled
def put_pose(row: Array, rotation: Matrix, position: Vector) -> None:
    """Set a row to a rotation, row by row, and a position (12,) [m]."""
    for k in range(9):
        row[k] = rotation[k]
    row[MOVE], row[MOVE + 1], row[MOVE + 2] = position


@compiled
def inclined(roll: float, pitch: float) -> Matrix:
    """Return the attitude R_RB of a trunk with roll and pitch [rad]."""
    cr, sr, cp, sp = cos(roll), sin(roll), cos(pitch), sin(pitch)
    return cp, sp * sr, sp * cr, 0.0, cr, -sr, -sp, cp * sr, cp * cr


@compiled
def chain_pose(chain: Array, angles: Array, axes: Array, origins: Array) -> tuple[Matrix, Vector]:
    """Return rotation and position [m] of the end of a chain (forward kinematics).

    Args:
        chain: chain of k joints (k + 1, 15).
        angles: angles of the joints (k,) [rad].
        axes: axes of the joints, set (k, 3).
        origins: origins of the joints, set (k, 3) [m].
    """
    R = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
    px, py, pz = 0.0, 0.0, 0.0
    for k in range(chain.shape[0]):
        row = chain[k]
        dx, dy, dz = rotated(R, row[MOVE], row[MOVE + 1], row[MOVE + 2])
        px, py, pz = px + dx, py + dy, pz + dz
        R = times(R, rotation_of(row))
        if k < angles.shape[0]:
            x, y, z = row[AXIS], row[AXIS + 1], row[AXIS + 2]
            axes[k, 0], axes[k, 1], axes[k, 2] = rotated(R, x, y, z)
            origins[k, 0], origins[k, 1], origins[k, 2] = px, py, pz
            R = times(R, about(x, y, z, angles[k]))
    return R, (px, py, pz)


@compiled
def tree_pass(links: Records[Link], order: Indices, angles: Array, poses: Array) -> Vector:
    """Set the poses of all links and return the centre of mass [m], both in the base frame.

    Args:
        links: links of the robot, the base last (n + 1,).
        order: joints and their parents, parents first (n, 2).
        angles: joint angles (n,) [rad].
        poses: rotation, row by row, and position of each link, set; the last is the base
            (n + 1, 12) [m].
    """
    last = links.size - 1
    base = links[last]
    mass, mx, my, mz = base.mass, base.moment_x, base.moment_y, base.moment_z
    for k in range(12):
        poses[last, k] = 1.0 if k in (0, 4, 8) else 0.0
    for k in range(last):
        joint, parent = order[k, 0], order[k, 1]
        link, pose, before = links[joint], poses[joint], poses[parent]
        P = rotation_of(before)
        dx, dy, dz = rotated(P, link.x, link.y, link.z)
        x, y, z = before[MOVE] + dx, before[MOVE + 1] + dy, before[MOVE + 2] + dz
        R = times(P, about(link.axis_x, link.axis_y, link.axis_z, angles[joint]))
        put_pose(pose, R, (x, y, z))
        m, (cx, cy, cz) = link.mass, rotated(R, link.moment_x, link.moment_y, link.moment_z)
        mass += m
        mx, my, mz = mx + m * x + cx, my + m * y + cy, mz + m * z + cz
    return mx / mass, my / mass, mz / mass


@compiled
def frame_pose(pose: Array, link: Array, frame: Array) -> None:
    """Set the pose in the base frame of a frame on a link.

    Args:
        pose: rotation, row by row, and position, set (12,) [m].
        link: pose of the link, see `tree_pass` (12,) [m].
        frame: pose of the frame on the link (12,) [m].
    """
    R = rotation_of(link)
    dx, dy, dz = rotated(R, frame[MOVE], frame[MOVE + 1], frame[MOVE + 2])
    position = (link[MOVE] + dx, link[MOVE + 1] + dy, link[MOVE + 2] + dz)
    put_pose(pose, times(R, rotation_of(frame)), position)


class FootPose(NamedTuple):
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


@compiled
def solve_leg(
    leg: Array, foot: FootPose, angles: Array, length: float, axes: Array, origins: Array
) -> tuple[int, float]:
    """Find the joint angles of a leg for a foot pose (inverse kinematics) by Newton's method.

    Far from the solution, and for a foot out of reach, the steps are damped (Levenberg-Marquardt).

    Args:
        leg: chain (7, 15).
        foot: pose of its end.
        angles: first guess, set to the solution (6,) [rad].
        length: length of the leg, relative to which errors of position count [m].
        axes: axes of the joints, set (6, 3).
        origins: origins of the joints, set (6, 3) [m].

    Returns:
        iterations, and remaining error [rad].
    """
    x, y, z, roll, pitch, yaw = foot
    T = times(
        times(about(0.0, 0.0, 1.0, yaw), about(0.0, 1.0, 0.0, pitch)),
        about(1.0, 0.0, 0.0, roll),
    )
    J, A, e, step = np.empty((6, 6)), np.empty((6, 6)), np.empty(6), np.empty(6)
    error = 0.0
    for iteration in range(MAX_ITERATIONS):
        R, p = chain_pose(leg, angles, axes, origins)
        e[0], e[1], e[2] = (x - p[0]) / length, (y - p[1]) / length, (z - p[2]) / length
        # Half the sum of the cross products of the axes of R and T: the sine of the error.
        e[3] = e[4] = e[5] = 0.0
        for k in range(3):
            e[3] += 0.5 * (R[3 + k] * T[6 + k] - R[6 + k] * T[3 + k])
            e[4] += 0.5 * (R[6 + k] * T[k] - R[k] * T[6 + k])
            e[5] += 0.5 * (R[k] * T[3 + k] - R[3 + k] * T[k])
        square = 0.0
        for k in range(6):
            square += e[k] * e[k]
        error = sqrt(square)
        if error < CONVERGED:
            return iteration, error
        for k in range(6):
            ax, ay, az = axes[k, 0], axes[k, 1], axes[k, 2]
            dx, dy, dz = p[0] - origins[k, 0], p[1] - origins[k, 1], p[2] - origins[k, 2]
            J[0, k] = (ay * dz - az * dy) / length
            J[1, k] = (az * dx - ax * dz) / length
            J[2, k] = (ax * dy - ay * dx) / length
            J[3, k], J[4, k], J[5, k] = ax, ay, az
        _least_squares(J, e, MAX_DAMPING * min(1.0, square) + MIN_DAMPING, A, step)
        for k in range(6):
            angles[k] += clamp(step[k], MAX_STEP)
    return MAX_ITERATIONS, error


@compiled
def _least_squares(J: Array, e: Array, damping: float, A: Array, step: Array) -> None:
    """Set `step` (6,) to the solution of (JᵀJ + damping) step = Jᵀe by Cholesky; A is scratch."""
    for i in range(6):
        step[i] = 0.0
        for m in range(6):
            step[i] += J[m, i] * e[m]
        for j in range(i + 1):
            total = damping if i == j else 0.0
            for m in range(6):
                total += J[m, i] * J[m, j]
            for m in range(j):
                total -= A[i, m] * A[j, m]
            A[i, j] = total / A[j, j] if j < i else sqrt(max(total, MIN_PIVOT))
    for i in range(6):
        for m in range(i):
            step[i] -= A[i, m] * step[m]
        step[i] /= A[i, i]
    for i in range(5, -1, -1):
        for m in range(i + 1, 6):
            step[i] -= A[m, i] * step[m]
        step[i] /= A[i, i]


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
        rotation, foot = chain_pose(chain, straight, axes, origins)
        first, second, third = sorted(np.argsort(-np.abs(axes[:, 1]), kind="stable")[:3].tolist())
        pitching = (first, second, third)
        bent = straight.copy()
        bent[list(pitching)] += np.array(BEND) * np.sign(axes[list(pitching), 1])
        hip, knee, ankle = origins[list(pitching)]
        stretched = STRETCH * (np.linalg.norm(knee - hip) + np.linalg.norm(ankle - knee))
        reach = np.array([*hip, *(np.reshape(rotation, (3, 3)).T @ (ankle - foot)), stretched])
        hx, hy, hz = hip.tolist()
        return Leg(chain, straight, bent, pitching, (hx, hy, hz), foot, reach)

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
        axes, origins = np.empty((6, 3)), np.empty((6, 3))
        _, error = solve_leg(self.chain, foot, angles, self.length, axes, origins)
        return angles, error

    def pose(self, angles: Array) -> FootPose:
        """Return the pose of the foot for joint angles (6,) [rad] (forward kinematics)."""
        axes, origins = np.empty((6, 3)), np.empty((6, 3))
        R, p = chain_pose(self.chain, np.asarray(angles, float), axes, origins)
        roll, pitch = atan2(R[7], R[8]), -asin(clamp(R[6], 1.0))
        return FootPose(*p, roll, pitch, atan2(R[3], R[0]))

    def joints(self, angles: Array) -> tuple[Array, Array]:
        """Return axes (6, 3) and origins (6, 3) [m] of the joints in the base frame."""
        axes, origins = np.empty((6, 3)), np.empty((6, 3))
        chain_pose(self.chain, np.asarray(angles, float), axes, origins)
        return axes, origins
