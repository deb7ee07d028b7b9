"""Frames of a run as the robot believes them: map, odom, base_footprint and its links."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from hsr8.export.links import CAMERA, Link, about, inverse, product, rotated

Array = NDArray[np.float64]

MAP, ODOM, FOOTPRINT = "map", "odom", "base_footprint"


@dataclass(frozen=True, slots=True, eq=False)
class Transforms:
    """Poses of frames in their parents.

    Attributes:
        frames: names of parent and child of each transform.
        positions: positions of the children (n, transforms, 3) [m].
        orientations: quaternions w-x-y-z of the children (n, transforms, 4) [1].
    """

    frames: tuple[tuple[str, str], ...]
    positions: Array
    orientations: Array


@dataclass(frozen=True, eq=False)
class Robot:
    """Links and joints of a robot.

    Attributes:
        links: links, parents first.
        held: angles of the joints that walking does not move [rad].
        joints: names of the measured joints.
    """

    links: tuple[Link, ...]
    held: Mapping[str, float]
    joints: tuple[str, ...]


def fixed_transforms(robot: Robot) -> Transforms:
    """Return the transforms of the links that no measured joint moves (1, transforms, ...)."""
    links = [link for link in robot.links if link.parent and link.joint not in robot.joints]
    return _of_links(links, robot.held, {}, 1)


def moving_transforms(
    robot: Robot, joints: Array, correction: Array, odometry: Array, camera: tuple[Array, Array]
) -> Transforms:
    """Return the transforms at n times, at least one.

    The frame map is W, base_footprint is R. The pose of the base follows from that of the camera.

    Args:
        robot: links and joints.
        joints: measured angles of the joints of the robot (n, joints) [rad].
        correction: pose of odom in the map (n, 3) [m, m, rad].
        odometry: pose of R in odom (n, 3) [m, m, rad].
        camera: believed position (n, 3) [m] and rotation (n, 3, 3) of the camera in R.
    """
    angles, held = dict(zip(robot.joints, joints.T, strict=True)), robot.held
    moved = _of_links(
        [k for k in robot.links if k.parent and k.joint in angles], held, angles, len(joints)
    )
    base = _base(robot.links, held, angles, *camera)
    to_root = [_planar(correction), _planar(odometry), base]
    root = next(link.name for link in robot.links if not link.parent)
    return Transforms(
        ((MAP, ODOM), (ODOM, FOOTPRINT), (FOOTPRINT, root), *moved.frames),
        np.concatenate([np.stack([p for p, _ in to_root], axis=1), moved.positions], axis=1),
        np.concatenate([np.stack([q for _, q in to_root], axis=1), moved.orientations], axis=1),
    )


def _of_links(
    links: Sequence[Link], held: Mapping[str, float], angles: dict[str, Array], count: int
) -> Transforms:
    poses = [_pose(link, held, angles, count) for link in links]
    return Transforms(
        tuple((link.parent, link.name) for link in links),
        np.array([position for position, _ in poses]).reshape(-1, count, 3).swapaxes(0, 1),
        np.array([turn for _, turn in poses]).reshape(-1, count, 4).swapaxes(0, 1),
    )


def _pose(
    link: Link, held: Mapping[str, float], angles: dict[str, Array], count: int
) -> tuple[Array, Array]:
    """Return position (n, 3) [m] and orientation (n, 4) of a link in its parent."""
    angle = angles.get(link.joint, np.full(count, held.get(link.joint, 0.0)))
    position, turn = link.position, link.orientation
    if link.kind == "prismatic":
        position = position + rotated(turn, angle[:, None] * link.axis)
    elif link.kind != "fixed":
        turn = product(turn, about(link.axis, angle))
    return np.broadcast_to(position, (count, 3)), np.broadcast_to(turn, (count, 4))


def _base(
    links: Sequence[Link],
    held: Mapping[str, float],
    angles: dict[str, Array],
    camera_position: Array,
    camera_rotation: Array,
) -> tuple[Array, Array]:
    """Return the pose of the base in R from that of the camera in R."""
    count = len(camera_position)
    by_name = {link.name: link for link in links}
    position, turn = np.zeros((count, 3)), np.tile([1.0, 0.0, 0.0, 0.0], (count, 1))
    link = by_name[CAMERA]
    while link.parent:
        offset, step = _pose(link, held, angles, count)
        position, turn = offset + rotated(step, position), product(step, turn)
        link = by_name[link.parent]
    camera = Rotation.from_matrix(camera_rotation).as_quat(scalar_first=True)
    orientation = product(camera, inverse(turn))
    return camera_position - rotated(orientation, position), orientation


def odom_in_map(pose: Array, odometry: Array) -> Array:
    """Return the pose of odom in the map (n, 3) [m, m, rad].

    Args:
        pose: pose of R in the map (n, 3) [m, m, rad].
        odometry: pose of R in odom (n, 3) [m, m, rad].
    """
    yaw = pose[:, 2] - odometry[:, 2]
    c, s = np.cos(yaw), np.sin(yaw)
    x, y = odometry[:, 0], odometry[:, 1]
    return np.stack([pose[:, 0] - c * x + s * y, pose[:, 1] - s * x - c * y, yaw], axis=1)


def _planar(pose: Array) -> tuple[Array, Array]:
    """Return position and orientation of a pose x, y, heading (n, 3)."""
    return np.pad(pose[:, :2], ((0, 0), (0, 1))), about(np.array([0.0, 0.0, 1.0]), pose[:, 2])
