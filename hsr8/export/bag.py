"""A run as a rosbag2 folder: MCAP with zstd chunks, without ROS."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hsr8.errors import UsageError
from hsr8.export.cdr import Contents, Messages, header, nanoseconds, stamp
from hsr8.export.links import CAMERA, INERTIAL
from hsr8.export.transforms import (
    FOOTPRINT,
    MAP,
    ODOM,
    Transforms,
    fixed_transforms,
    moving_transforms,
    yaw_quaternions,
)
from hsr8.export.urdf import MESHES, urdf_of
from hsr8.recorder.palette import of_label
from hsr8.recorder.run.run import Run
from hsr8.recorder.table import Table
from hsr8.robots.loaded import LoadedRobot, load_robot
from hsr8.robots.shown import stature

Array = NDArray[np.float64]

PLANE = np.array([0, 1, 5])  # x, y and yaw among the six axes of ROS covariances
CYLINDER, DELETE_ALL = 3, 3  # visualization_msgs/msg/Marker


@dataclass(frozen=True, slots=True)
class Topic:
    """Messages of one topic.

    Attributes:
        name: name of the topic.
        kind: type of its messages.
        times: times of arrival (n,) [ns].
        messages: serialized (n).
        latched: whether later subscribers receive the last message.
    """

    name: str
    kind: str
    times: NDArray[np.int64]
    messages: Sequence[bytes]
    latched: bool = False


def write_bag(run: Run, folder: Path) -> int:
    """Write a run as a rosbag2 folder and return the number of messages.

    The folder also holds the robot as ``robot.urdf`` with its meshes.

    Args:
        run: run of any length.
        folder: new.

    Raises:
        UsageError: `rosbags` is not installed, or the run is empty or cannot be read.
        OSError: the folder cannot be written.
    """
    rosbag2, messages = require_rosbags()
    if not len(run.records):
        raise UsageError(f"--bag: {run.folder}: no records")
    robot = load_robot(run.scenario().robot.model)
    urdf = urdf_of(robot)
    writer = rosbag2.Writer(folder, version=9, storage_plugin=rosbag2.StoragePlugin.MCAP)
    writer.set_compression(rosbag2.CompressionMode.STORAGE, rosbag2.CompressionFormat.ZSTD)
    topics = [topic for topic in _topics(run, messages, robot, urdf.text) if len(topic.messages)]
    with writer:
        connections = [
            writer.add_connection(
                topic.name,
                topic.kind,
                typestore=messages.store,
                offered_qos_profiles=[_latched()] if topic.latched else [],
            )
            for topic in topics
        ]
        order = np.argsort(np.concatenate([topic.times for topic in topics]), kind="stable")
        lines = [
            (connection, time, message)
            for topic, connection in zip(topics, connections, strict=True)
            for time, message in zip(topic.times.tolist(), topic.messages, strict=True)
        ]
        for k in order.tolist():
            writer.write(*lines[k])
    urdf.write(folder / "robot.urdf", folder / MESHES)
    return len(lines)


def require_rosbags() -> tuple[Any, Messages]:
    """Import rosbags, which only this export needs.

    Raises:
        UsageError: it is not installed.
    """
    try:
        from rosbags import rosbag2  # noqa: PLC0415
        from rosbags.typesys import Stores, get_typestore  # noqa: PLC0415
    except ImportError as error:
        raise UsageError(f"--bag: {error}; pip install -e '.[ros]' in the checkout") from error
    return rosbag2, Messages(get_typestore(Stores.ROS2_JAZZY))


def _latched() -> Any:
    from rosbags import interfaces as ros  # noqa: PLC0415

    never = ros.QosTime(2147483647, 4294967295)
    return ros.Qos(
        ros.QosHistory.KEEP_LAST,
        1,
        ros.QosReliability.RELIABLE,
        ros.QosDurability.TRANSIENT_LOCAL,
        never,
        never,
        ros.QosLiveliness.AUTOMATIC,
        never,
        False,
    )


def _topics(run: Run, messages: Messages, robot: LoadedRobot, urdf: str) -> Iterator[Topic]:
    """Yield the topics of a run."""
    start = np.zeros(1, np.int64)
    text = messages.one("std_msgs/msg/String", {"data": urdf})
    yield Topic("/robot_description", "std_msgs/msg/String", start, [text], latched=True)
    names = run.ticks.names("joint_position")
    fixed = _tf(messages, start, fixed_transforms(robot, names))
    yield Topic("/tf_static", "tf2_msgs/msg/TFMessage", start, fixed, latched=True)
    times = nanoseconds(run.records["time"])
    moving = _tf(messages, times, moving_transforms(run, robot))
    yield Topic("/tf", "tf2_msgs/msg/TFMessage", times, moving)
    yield from _sensors(run.ticks, messages)
    yield from _motion(run.records, messages)
    yield from _camera(run, messages)
    yield from _belief(run.frames, messages, stature(robot))


def _tf(messages: Messages, times: NDArray[np.int64], tf: Transforms) -> list[bytes]:
    count = len(times)
    values = np.concatenate([tf.positions, tf.orientations], axis=2).reshape(count, -1)

    def contents(time: Contents, numbers: list[float]) -> Contents:
        return {
            "transforms": [
                {
                    "header": header(time, parent),
                    "child_frame_id": child,
                    "transform": {
                        "translation": _xyz(numbers[7 * k : 7 * k + 3]),
                        "rotation": _wxyz(numbers[7 * k + 3 : 7 * k + 7]),
                    },
                }
                for k, (parent, child) in enumerate(tf.frames)
            ]
        }

    return messages.many("tf2_msgs/msg/TFMessage", times, values, contents)


def _sensors(ticks: Table, messages: Messages) -> Iterator[Topic]:
    """Yield the topics with a message per control tick."""
    times, names = nanoseconds(ticks["time"]), ticks.names("joint_position")
    kind = "rosgraph_msgs/msg/Clock"
    empty = np.zeros((len(times), 0))
    clock = messages.many(kind, times, empty, lambda time, _: {"clock": time})
    yield Topic("/clock", kind, times, clock)
    kind, n = "sensor_msgs/msg/JointState", len(names)
    joints = np.hstack([ticks["joint_position"], ticks["joint_velocity"]])
    states = messages.many(
        kind,
        times,
        joints,
        lambda time, v: {
            "header": header(time, ""),
            "name": names,
            "position": v[:n],
            "velocity": v[n:],
        },
    )
    yield Topic("/joint_states", kind, times, states)
    kind = "sensor_msgs/msg/Imu"
    inertial = np.hstack([ticks["orientation"], ticks["gyro"], ticks["accelerometer"]])
    states = messages.many(
        kind,
        times,
        inertial,
        lambda time, v: {
            "header": header(time, INERTIAL),
            "orientation": _wxyz(v[:4]),
            "angular_velocity": _xyz(v[4:7]),
            "linear_acceleration": _xyz(v[7:]),
        },
    )
    yield Topic("/imu/data", kind, times, states)


def _motion(records: Table, messages: Messages) -> Iterator[Topic]:
    """Yield odometry, truth and command, which have a message per record."""
    time = records["time"]
    times = nanoseconds(time)
    odometry, covariance = records["odometry"], records["odometry_covariance"]
    nothing = np.zeros_like(covariance)
    for name, frame, pose, uncertainty in (
        ("/odom", ODOM, odometry, covariance),
        ("/ground_truth/odom", MAP, records["robot"], nothing),
    ):
        values = np.hstack([_pose(pose), uncertainty.reshape(-1, 9), _twist(time, pose)])
        kind = "nav_msgs/msg/Odometry"
        states = messages.many(
            kind,
            times,
            values,
            lambda stamp, v, frame=frame: {  # type: ignore[misc]
                "header": header(stamp, frame),
                "child_frame_id": FOOTPRINT,
                "pose": _pose_message(v[:15]),
                "twist": {"twist": _twist_message(v[15:])},
            },
        )
        yield Topic(name, kind, times, states)
    known = np.isfinite(records["command"]).all(axis=1)
    kind, command = "geometry_msgs/msg/Twist", records["command"][known]
    sent = messages.many(kind, times[known], command, lambda _, v: _twist_message(v))
    yield Topic("/cmd_vel", kind, times[known], sent)


def _camera(run: Run, messages: Messages) -> Iterator[Topic]:
    """Yield the images of the head camera, stamped when they were taken."""
    images, camera = run.images, run.scenario().camera.pinhole
    arrivals, captures = nanoseconds(images["time"]), nanoseconds(images["captured"]).tolist()
    kind = "sensor_msgs/msg/CompressedImage"
    pictures = [
        messages.one(
            kind, {"header": header(stamp(time), CAMERA), "format": "jpeg", "data": content}
        )
        for time, content in zip(captures, images["jpeg"], strict=True)
    ]
    yield Topic("/camera/image/compressed", kind, arrivals, pictures)
    kind, f = "sensor_msgs/msg/CameraInfo", camera.focal
    u, v = 0.5 * camera.width - 0.5, 0.5 * camera.height - 0.5  # ROS: centre of the first pixel
    intrinsics = {
        "height": camera.height,
        "width": camera.width,
        "distortion_model": "plumb_bob",
        "d": np.zeros(5),
        "k": [f, 0.0, u, 0.0, f, v, 0.0, 0.0, 1.0],
        "r": np.eye(3).ravel(),
        "p": [f, 0.0, u, 0.0, 0.0, f, v, 0.0, 0.0, 0.0, 1.0, 0.0],
    }
    infos = [
        messages.one(kind, {"header": header(stamp(time), CAMERA), **intrinsics})
        for time in captures
    ]
    yield Topic("/camera/camera_info", kind, arrivals, infos)


def _belief(frames: Table, messages: Messages, height: float) -> Iterator[Topic]:
    """Yield belief and goal, which have a message per camera frame."""
    times = nanoseconds(frames["time"])
    if not len(frames):
        return
    kind = "geometry_msgs/msg/PoseWithCovarianceStamped"
    values = np.hstack([_pose(frames["pose"]), frames["pose_covariance"].reshape(-1, 9)])
    poses = messages.many(
        kind,
        times,
        values,
        lambda stamp, v: {"header": header(stamp, MAP), "pose": _pose_message(v)},
    )
    yield Topic("/belief/pose", kind, times, poses)
    targets = np.column_stack([frames["target"], np.nan_to_num(frames["target_heading"])])
    before = np.vstack([np.full((1, 3), np.nan), targets[:-1]])
    new = np.isfinite(targets).all(axis=1) & (targets != before).any(axis=1)
    kind = "geometry_msgs/msg/PoseStamped"
    goals = messages.many(
        kind,
        times[new],
        _pose(targets[new]),
        lambda stamp, v: {"header": header(stamp, MAP), "pose": _pose_message(v)["pose"]},
    )
    yield Topic("/goal_pose", kind, times[new], goals)
    kind = "visualization_msgs/msg/MarkerArray"
    markers = _markers(frames, times.tolist(), height)
    arrays = [messages.one(kind, {"markers": some}) for some in markers]
    yield Topic("/belief/tracks", kind, times, arrays)
    kind = "nav_msgs/msg/OccupancyGrid"
    rows, maps = frames.present("local_map")
    grids = [
        messages.one(kind, _grid(frames, row, shades))
        for row, shades in zip(rows.tolist(), maps, strict=True)
    ]
    yield Topic("/belief/local_map", kind, times[rows], grids)


def _markers(frames: Table, times: list[int], height: float) -> list[list[Contents]]:
    """Return the markers of the tracks of every frame: cylinders that replace the former ones."""
    tracks = frames["tracks"]
    markers = [[{"header": header(stamp(t), MAP), "action": DELETE_ALL}] for t in times]
    columns = [tracks[name].tolist() for name in ("id", "label", "position", "radius", "motion")]
    for row, number, label, (x, y), radius, motion in zip(
        tracks.parents.tolist(), *columns, strict=True
    ):
        red, green, blue = of_label(label)
        markers[row].append(
            {
                "header": header(stamp(times[row]), MAP),
                "ns": motion,
                "id": number,
                "type": CYLINDER,
                "pose": {
                    "position": _xyz([x, y, 0.5 * height]),
                    "orientation": _wxyz([1.0, 0.0, 0.0, 0.0]),
                },
                "scale": _xyz([2.0 * radius, 2.0 * radius, height]),
                "color": {"r": red / 255, "g": green / 255, "b": blue / 255, "a": 0.7},
            }
        )
    return markers


def _grid(frames: Table, row: int, shades: NDArray[np.uint8]) -> Contents:
    """Return the confidence of a local map [%]."""
    time = stamp(int(nanoseconds(frames["time"][row])))
    x, y = frames["map_origin"][row].tolist()
    rows, columns = shades.shape
    return {
        "header": header(time, MAP),
        "info": {
            "map_load_time": time,
            "resolution": float(frames["map_cell"][row]),
            "width": columns,
            "height": rows,
            "origin": {
                "position": _xyz([x, y, 0.0]),
                "orientation": _wxyz([1.0, 0.0, 0.0, 0.0]),
            },
        },
        "data": np.round(shades.ravel() * (100.0 / 255.0)),
    }


def _pose(pose: Array) -> Array:
    """Return x, y and quaternion of poses x, y, heading (n, 3) (n, 6)."""
    return np.hstack([pose[:, :2], yaw_quaternions(pose[:, 2])])


def _pose_message(values: list[float]) -> Contents:
    """Return a pose of 6 numbers of `_pose`, with up to 9 of the covariance of x, y, yaw."""
    covariance = np.zeros((6, 6))
    if len(values) > 6:
        covariance[np.ix_(PLANE, PLANE)] = np.reshape(values[6:15], (3, 3))
    pose = {"position": _xyz([*values[:2], 0.0]), "orientation": _wxyz(values[2:6])}
    return {"pose": pose, "covariance": covariance.ravel()}


def _twist(time: Array, pose: Array) -> Array:
    """Return the velocity of poses in R (n, 3) [m/s, m/s, rad/s], of central differences."""
    if len(time) < 2:
        return np.zeros((len(time), 3))
    unwrapped = np.column_stack([pose[:, :2], np.unwrap(pose[:, 2])])
    x, y, wz = np.gradient(unwrapped, time, axis=0).T
    c, s = np.cos(pose[:, 2]), np.sin(pose[:, 2])
    return np.column_stack([c * x + s * y, c * y - s * x, wz])


def _twist_message(values: list[float]) -> Contents:
    vx, vy, wz = values
    return {"linear": _xyz([vx, vy, 0.0]), "angular": _xyz([0.0, 0.0, wz])}


def _xyz(values: Sequence[float]) -> Contents:
    return dict(zip("xyz", values, strict=True))


def _wxyz(values: Sequence[float]) -> Contents:
    return dict(zip("wxyz", values, strict=True))
