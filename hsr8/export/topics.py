"""Topics of a run: name, type, source and contents of every message, in bags and live.

Each topic is made of the rows of one table of a run. A bag gives all rows at once, a live run those
of one tick.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from hsr8.export.cdr import Contents, Messages, Stamps, header, nanoseconds, stamp
from hsr8.export.links import CAMERA, INERTIAL, Link, links_of, model_of
from hsr8.export.transforms import (
    FOOTPRINT,
    MAP,
    ODOM,
    Robot,
    Transforms,
    fixed_transforms,
    moving_transforms,
    odom_in_map,
    yaw_quaternions,
)
from hsr8.recorder.palette import of_label
from hsr8.robots.loaded import LoadedRobot
from hsr8.robots.shown import stature
from vision.camera import PinholeCamera

Array = NDArray[np.float64]
Rows = Mapping[str, Any]
"""Columns of rows, a `hsr8.recorder.table.Table` or the like; column ``time`` is always there."""

START = "start"
"""Source with one row: time, and pose of odom in the map before the first frame, ``start``."""
PIXELS = "pixels"
"""Source with the images of live runs, uncompressed."""
PLANE = np.array([0, 1, 5])  # x, y and yaw among the six axes of ROS covariances
CYLINDER, DELETE_ALL = 3, 3  # visualization_msgs/msg/Marker


@dataclass(frozen=True)
class Setup:
    """Constants of a run.

    Attributes:
        urdf: description of the robot.
        robot: links and joints of the robot.
        height: height of the robot [m].
        camera: width and height of an image and focal length [pixel].
    """

    urdf: str
    robot: Robot
    height: float
    camera: tuple[int, int, float]

    @classmethod
    def of(cls, robot: LoadedRobot, camera: PinholeCamera, urdf: str) -> Self:
        """Return the constants of a run of a robot."""
        links: list[Link] = links_of(model_of(robot))
        lens = camera.width, camera.height, camera.focal
        parts = Robot(tuple(links), robot.held, robot.model.names)
        return cls(urdf, parts, stature(robot), lens)


class Translator:
    """Translator of rows into messages.

    Args:
        messages: serializer.
        setup: constants of the run.

    Attributes:
        latest: latest rows of each table.
    """

    def __init__(self, messages: Messages, setup: Setup) -> None:
        self.messages, self.setup = messages, setup
        self.latest: dict[str, Rows] = {}
        self._before: dict[str, tuple[Array, Array]] = {}

    def translate(self, table: str, rows: Rows) -> Iterator[tuple["Topic", Stamps, list[bytes]]]:
        """Yield the topics of a table with the times of arrival (n,) [ns] and the messages (n).

        Args:
            table: name of the table. At one time, ``ticks`` precede ``frames``, which precede
                ``records``.
            rows: the rows that follow those of the previous call.
        """
        self.latest[table] = rows
        for topic in TOPICS:
            if topic.table == table:
                times, sent = topic.messages(self, topic.kind, rows)
                yield topic, times, sent

    def before(self, name: str, times: Array, values: Array) -> tuple[Array, Array]:
        """Return the row before each row: times (n,) and values (n, k); NaN before the first."""
        nothing = np.full(1, np.nan), np.full((1, values.shape[1]), np.nan)
        time, value = self._before.get(name, nothing)
        if len(times):
            self._before[name] = times[-1:], values[-1:]
        return np.concatenate([time, times[:-1]]), np.concatenate([value, values[:-1]])

    def at(self, table: str, times: Array) -> NDArray[np.intp]:
        """Return the latest row of a table not after each time (n,) [s]; -1 before the first."""
        if not len(known := self.latest.get(table, {}).get("time", ())):
            return np.full(len(times), -1)
        return np.searchsorted(known, times + 1e-9, "right") - 1


@dataclass(frozen=True, slots=True)
class Topic:
    """Topic.

    Attributes:
        name: name of the topic.
        kind: type of its messages.
        table: table that has a row for each message, `START` or `PIXELS`.
        columns: columns of that table, except the time.
        messages: function that returns times of arrival (n,) [ns] and messages (n) of rows.
        latched: whether later subscribers receive the last message.
    """

    name: str
    kind: str
    table: str
    columns: tuple[str, ...]
    messages: Callable[[Translator, str, Rows], tuple[Stamps, list[bytes]]]
    latched: bool = False


def _description(translator: Translator, kind: str, rows: Rows) -> tuple[Stamps, list[bytes]]:
    text = translator.messages.one(kind, {"data": translator.setup.urdf})
    return nanoseconds(rows["time"]), [text]


def _tf_static(translator: Translator, kind: str, rows: Rows) -> tuple[Stamps, list[bytes]]:
    times = nanoseconds(rows["time"])
    return times, _tf(translator.messages, kind, times, fixed_transforms(translator.setup.robot))


def _tf_moving(translator: Translator, kind: str, rows: Rows) -> tuple[Stamps, list[bytes]]:
    time = np.asarray(rows["time"])
    tick = np.maximum(translator.at("ticks", time), 0)
    frame = translator.at("frames", time)
    correction = np.repeat(translator.latest[START]["start"], len(time), axis=0)
    if (known := frame >= 0).any():
        frames = translator.latest["frames"]
        poses = odom_in_map(np.asarray(frames["pose"]), np.asarray(frames["odometry"]))
        correction[known] = poses[frame[known]]
    joints = np.asarray(translator.latest["ticks"]["joint_position"])[tick]
    camera = rows["camera_position"], rows["camera_rotation"]
    moving = moving_transforms(translator.setup.robot, joints, correction, rows["odometry"], camera)
    return (times := nanoseconds(time)), _tf(translator.messages, kind, times, moving)


def _tf(messages: Messages, kind: str, times: Stamps, tf: Transforms) -> list[bytes]:
    values = np.concatenate([tf.positions, tf.orientations], axis=2).reshape(len(times), -1)

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

    return messages.many(kind, times, values, contents)


def _clock(translator: Translator, kind: str, rows: Rows) -> tuple[Stamps, list[bytes]]:
    times = nanoseconds(rows["time"])
    empty = np.zeros((len(times), 0))
    return times, translator.messages.many(kind, times, empty, lambda time, _: {"clock": time})


def _joint_states(translator: Translator, kind: str, rows: Rows) -> tuple[Stamps, list[bytes]]:
    times, names = nanoseconds(rows["time"]), translator.setup.robot.joints
    n = len(names)

    def contents(time: Contents, v: list[float]) -> Contents:
        return {"header": header(time, ""), "name": names, "position": v[:n], "velocity": v[n:]}

    values = np.hstack([rows["joint_position"], rows["joint_velocity"]])
    return times, translator.messages.many(kind, times, values, contents)


def _imu(translator: Translator, kind: str, rows: Rows) -> tuple[Stamps, list[bytes]]:
    times = nanoseconds(rows["time"])

    def contents(time: Contents, v: list[float]) -> Contents:
        return {
            "header": header(time, INERTIAL),
            "orientation": _wxyz(v[:4]),
            "angular_velocity": _xyz(v[4:7]),
            "linear_acceleration": _xyz(v[7:]),
        }

    values = np.hstack([rows["orientation"], rows["gyro"], rows["accelerometer"]])
    return times, translator.messages.many(kind, times, values, contents)


def _odometry(translator: Translator, kind: str, rows: Rows) -> tuple[Stamps, list[bytes]]:
    covariance = np.reshape(rows["odometry_covariance"], (-1, 9))
    return _motion(translator, kind, rows, rows["odometry"], frame=ODOM, covariance=covariance)


def _truth(translator: Translator, kind: str, rows: Rows) -> tuple[Stamps, list[bytes]]:
    covariance = np.zeros((len(rows["time"]), 9))
    return _motion(translator, kind, rows, rows["robot"], frame=MAP, covariance=covariance)


def _motion(
    translator: Translator, kind: str, rows: Rows, pose: Array, *, frame: str, covariance: Array
) -> tuple[Stamps, list[bytes]]:
    """Return poses in a frame with their covariance (n, 9) and velocity."""
    time = np.asarray(rows["time"])
    times = nanoseconds(time)

    def contents(stamp: Contents, v: list[float]) -> Contents:
        return {
            "header": header(stamp, frame),
            "child_frame_id": FOOTPRINT,
            "pose": _pose_message(v[:15]),
            "twist": {"twist": _twist_message(v[15:])},
        }

    twist = _twist(time, pose, *translator.before(frame, time, pose))
    values = np.hstack([_pose(pose), covariance, twist])
    return times, translator.messages.many(kind, times, values, contents)


def _command(translator: Translator, kind: str, rows: Rows) -> tuple[Stamps, list[bytes]]:
    known = np.isfinite(rows["command"]).all(axis=1)
    times, command = nanoseconds(rows["time"])[known], rows["command"][known]
    sent = translator.messages.many(kind, times, command, lambda _, v: _twist_message(v))
    return times, sent


def _compressed(translator: Translator, kind: str, rows: Rows) -> tuple[Stamps, list[bytes]]:
    return nanoseconds(rows["time"]), [
        translator.messages.one(
            kind, {"header": header(stamp(time), CAMERA), "format": "jpeg", "data": content}
        )
        for time, content in zip(_captures(rows), rows["jpeg"], strict=True)
    ]


def _raw(translator: Translator, kind: str, rows: Rows) -> tuple[Stamps, list[bytes]]:
    width, height, _ = translator.setup.camera
    size = {"height": height, "width": width, "encoding": "rgb8", "step": 3 * width}
    return nanoseconds(rows["time"]), [
        translator.messages.one(
            kind, {"header": header(stamp(time), CAMERA), "data": image.tobytes(), **size}
        )
        for time, image in zip(_captures(rows), rows["image"], strict=True)
    ]


def _camera_info(translator: Translator, kind: str, rows: Rows) -> tuple[Stamps, list[bytes]]:
    width, height, f = translator.setup.camera
    u, v = 0.5 * width - 0.5, 0.5 * height - 0.5  # ROS: centre of the first pixel
    intrinsics = {
        "height": height,
        "width": width,
        "distortion_model": "plumb_bob",
        "d": np.zeros(5),
        "k": [f, 0.0, u, 0.0, f, v, 0.0, 0.0, 1.0],
        "r": np.eye(3).ravel(),
        "p": [f, 0.0, u, 0.0, 0.0, f, v, 0.0, 0.0, 0.0, 1.0, 0.0],
    }
    return nanoseconds(rows["time"]), [
        translator.messages.one(kind, {"header": header(stamp(time), CAMERA), **intrinsics})
        for time in _captures(rows)
    ]


def _captures(rows: Rows) -> list[int]:
    """Return the times at which images were taken [ns]."""
    captures: list[int] = nanoseconds(rows["captured"]).tolist()
    return captures


def _belief(translator: Translator, kind: str, rows: Rows) -> tuple[Stamps, list[bytes]]:
    times = nanoseconds(rows["time"])
    values = np.hstack([_pose(rows["pose"]), np.reshape(rows["pose_covariance"], (-1, 9))])

    def contents(stamp: Contents, v: list[float]) -> Contents:
        return {"header": header(stamp, MAP), "pose": _pose_message(v)}

    return times, translator.messages.many(kind, times, values, contents)


def _goal(translator: Translator, kind: str, rows: Rows) -> tuple[Stamps, list[bytes]]:
    """Return the destinations that differ from the previous one."""
    targets = np.column_stack([rows["target"], np.nan_to_num(rows["target_heading"])])
    _, before = translator.before("goal", np.asarray(rows["time"]), targets)
    new = np.isfinite(targets).all(axis=1) & (targets != before).any(axis=1)
    times = nanoseconds(rows["time"])[new]

    def contents(stamp: Contents, v: list[float]) -> Contents:
        return {"header": header(stamp, MAP), "pose": _pose_message(v)["pose"]}

    return times, translator.messages.many(kind, times, _pose(targets[new]), contents)


def _tracks(translator: Translator, kind: str, rows: Rows) -> tuple[Stamps, list[bytes]]:
    """Return the tracks of every frame: cylinders that replace the former ones."""
    height, times, tracks = translator.setup.height, nanoseconds(rows["time"]), rows["tracks"]
    stamps = [stamp(time) for time in times.tolist()]
    markers = [[{"header": header(time, MAP), "action": DELETE_ALL}] for time in stamps]
    columns = [tracks[name].tolist() for name in ("id", "label", "position", "radius", "motion")]
    for row, number, label, (x, y), radius, motion in zip(
        tracks.parents.tolist(), *columns, strict=True
    ):
        red, green, blue = of_label(label)
        markers[row].append(
            {
                "header": header(stamps[row], MAP),
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
    return times, [translator.messages.one(kind, {"markers": some}) for some in markers]


def _local_map(translator: Translator, kind: str, rows: Rows) -> tuple[Stamps, list[bytes]]:
    """Return the confidence of the local maps [%], which some frames have."""
    times = nanoseconds(rows["time"])
    maps = [(row, shades) for row, shades in enumerate(rows["local_map"]) if shades is not None]
    grids = []
    for row, shades in maps:
        time = stamp(int(times[row]))
        x, y = rows["map_origin"][row].tolist()
        origin = {"position": _xyz([x, y, 0.0]), "orientation": _wxyz([1.0, 0.0, 0.0, 0.0])}
        info = {
            "map_load_time": time,
            "resolution": float(rows["map_cell"][row]),
            "width": shades.shape[1],
            "height": shades.shape[0],
            "origin": origin,
        }
        percent = np.round(shades.ravel() * (100.0 / 255.0))
        grid = {"header": header(time, MAP), "info": info, "data": percent}
        grids.append(translator.messages.one(kind, grid))
    return times[[row for row, _ in maps]], grids


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


def _twist(time: Array, pose: Array, earlier: Array, before: Array) -> Array:
    """Return the velocity since the poses before, in R (n, 3) [m/s, m/s, rad/s]; zero at first."""
    x, y, turn = (pose - before).T
    turn = (turn + np.pi) % (2.0 * np.pi) - np.pi
    c, s = np.cos(pose[:, 2]), np.sin(pose[:, 2])
    moved = np.column_stack([c * x + s * y, c * y - s * x, turn])
    return np.nan_to_num(moved / (time - earlier)[:, None])


def _twist_message(values: list[float]) -> Contents:
    vx, vy, wz = values
    return {"linear": _xyz([vx, vy, 0.0]), "angular": _xyz([0.0, 0.0, wz])}


def _xyz(values: Sequence[float]) -> Contents:
    return dict(zip("xyz", values, strict=True))


def _wxyz(values: Sequence[float]) -> Contents:
    return dict(zip("wxyz", values, strict=True))


TF, ODOMETRY = "tf2_msgs/msg/TFMessage", "nav_msgs/msg/Odometry"
CAMERA_POSE = ("camera_position", "camera_rotation")
TARGET, GRID = ("target", "target_heading"), ("local_map", "map_origin", "map_cell")
BELIEF = ("pose", "pose_covariance", "odometry")
TOPICS = (
    Topic("/robot_description", "std_msgs/msg/String", START, (), _description, latched=True),
    Topic("/tf_static", TF, START, (), _tf_static, latched=True),
    Topic("/tf", TF, "records", ("odometry", *CAMERA_POSE), _tf_moving),
    Topic("/clock", "rosgraph_msgs/msg/Clock", "ticks", (), _clock),
    Topic(
        "/joint_states",
        "sensor_msgs/msg/JointState",
        "ticks",
        ("joint_position", "joint_velocity"),
        _joint_states,
    ),
    Topic(
        "/imu/data",
        "sensor_msgs/msg/Imu",
        "ticks",
        ("orientation", "gyro", "accelerometer"),
        _imu,
    ),
    Topic("/odom", ODOMETRY, "records", ("odometry", "odometry_covariance"), _odometry),
    Topic("/ground_truth/odom", ODOMETRY, "records", ("robot",), _truth),
    Topic("/cmd_vel", "geometry_msgs/msg/Twist", "records", ("command",), _command),
    Topic("/camera/image", "sensor_msgs/msg/Image", PIXELS, ("captured", "image"), _raw),
    Topic(
        "/camera/image/compressed",
        "sensor_msgs/msg/CompressedImage",
        "images",
        ("captured", "jpeg"),
        _compressed,
    ),
    Topic(
        "/camera/camera_info",
        "sensor_msgs/msg/CameraInfo",
        "images",
        ("captured",),
        _camera_info,
    ),
    Topic(
        "/belief/pose",
        "geometry_msgs/msg/PoseWithCovarianceStamped",
        "frames",
        BELIEF,
        _belief,
    ),
    Topic("/goal_pose", "geometry_msgs/msg/PoseStamped", "frames", TARGET, _goal),
    Topic("/belief/tracks", "visualization_msgs/msg/MarkerArray", "frames", ("tracks",), _tracks),
    Topic("/belief/local_map", "nav_msgs/msg/OccupancyGrid", "frames", GRID, _local_map),
)
"""Topics of a run."""
