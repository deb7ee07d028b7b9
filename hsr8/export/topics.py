"""Topics of a run: name, type, source and contents of every message, in bags and live.

Each topic is made of the rows of one table of a run. A bag gives all rows at once, a live run those
of one tick.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from math import cos, isfinite, pi, sin
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from hsr8.export.cdr import (
    Contents,
    Messages,
    header,
    nanoseconds,
    pose_of,
    stamp,
    twist_of,
    uncertain_pose,
    wxyz,
    xyz,
)
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
)
from hsr8.recording.palette import of_label
from hsr8.robots.loaded import LoadedRobot
from hsr8.robots.shown import stature
from vision.camera import PinholeCamera

Array = NDArray[np.float64]
Stream = Iterator[Contents | None]
"""Fields of the message of each row; None for no message."""
Rows = Mapping[str, Any]
"""Columns of rows, a `hsr8.recording.table.Table` or the like; column ``time`` is always there."""

START = "start"
"""Source with one row: time, and pose of odom in the map before the first frame, ``start``."""
PIXELS = "pixels"
"""Source with the images of live runs, uncompressed."""
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
        messages: serializer.
        setup: constants of the run.
        latest: latest rows of each table.
        before: values of the previous row, by topic or frame.
    """

    def __init__(self, messages: Messages, setup: Setup) -> None:
        self.messages, self.setup = messages, setup
        self.latest: dict[str, Rows] = {}
        self.before: dict[str, Any] = {}

    def translate(
        self, table: str, rows: Rows
    ) -> Iterator[tuple["Topic", list[tuple[int, bytes]]]]:
        """Yield the topics of a table with times of arrival [ns] and messages.

        Args:
            table: name of the table. At one time, ``ticks`` precede ``frames``, which precede
                ``records``.
            rows: the rows that follow those of the previous call.
        """
        self.latest[table] = rows
        times = nanoseconds(rows["time"]).tolist()
        stamps = [stamp(time) for time in times]
        for topic in TOPICS:
            if topic.table == table:
                contents = zip(times, topic.contents(self, rows, stamps), strict=True)
                sent = [
                    (time, self.messages.one(topic.kind, fields))
                    for time, fields in contents
                    if fields is not None
                ]
                yield topic, sent

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
        contents: function that yields the contents of rows with their stamps.
        latched: whether later subscribers receive the last message.
    """

    name: str
    kind: str
    table: str
    columns: tuple[str, ...]
    contents: Callable[[Translator, Rows, list[Contents]], Stream]
    latched: bool = False


def _values(stamps: list[Contents], rows: Rows, *columns: str) -> Iterator[tuple[Any, ...]]:
    """Yield the stamp of each row and its values as plain numbers."""
    return zip(stamps, *(np.asarray(rows[name]).tolist() for name in columns), strict=True)


def _description(translator: Translator, rows: Rows, stamps: list[Contents]) -> Stream:
    yield from ({"data": translator.setup.urdf} for _ in stamps)


def _tf_static(translator: Translator, rows: Rows, stamps: list[Contents]) -> Stream:
    return _tf(stamps, fixed_transforms(translator.setup.robot))


def _tf_moving(translator: Translator, rows: Rows, stamps: list[Contents]) -> Stream:
    time = np.asarray(rows["time"])
    tick = np.maximum(translator.at("ticks", time), 0)
    frame = translator.at("frames", time)
    correction = np.repeat(translator.latest[START]["start"], len(time), axis=0)
    if (known := frame >= 0).any():
        frames = translator.latest["frames"]
        correction[known] = odom_in_map(frames["pose"], frames["odometry"])[frame[known]]
    joints = np.asarray(translator.latest["ticks"]["joint_position"])[tick]
    camera = rows["camera_position"], rows["camera_rotation"]
    robot = translator.setup.robot
    return _tf(stamps, moving_transforms(robot, joints, correction, rows["odometry"], camera))


def _tf(stamps: list[Contents], tf: Transforms) -> Stream:
    for time, *poses in zip(stamps, tf.positions.tolist(), tf.orientations.tolist(), strict=True):
        yield {
            "transforms": [
                {
                    "header": header(time, parent),
                    "child_frame_id": child,
                    "transform": {"translation": xyz(position), "rotation": wxyz(orientation)},
                }
                for (parent, child), position, orientation in zip(tf.frames, *poses, strict=True)
            ]
        }


def _clock(translator: Translator, rows: Rows, stamps: list[Contents]) -> Stream:
    yield from ({"clock": time} for time in stamps)


def _joint_states(translator: Translator, rows: Rows, stamps: list[Contents]) -> Stream:
    names = translator.setup.robot.joints
    for time, angles, rates in _values(stamps, rows, "joint_position", "joint_velocity"):
        yield {"header": header(time, ""), "name": names, "position": angles, "velocity": rates}


def _imu(translator: Translator, rows: Rows, stamps: list[Contents]) -> Stream:
    for time, turn, rate, force in _values(stamps, rows, "orientation", "gyro", "accelerometer"):
        yield {
            "header": header(time, INERTIAL),
            "orientation": wxyz(turn),
            "angular_velocity": xyz(rate),
            "linear_acceleration": xyz(force),
        }


def _motion(
    translator: Translator,
    rows: Rows,
    stamps: list[Contents],
    *,
    frame: str,
    columns: tuple[str, ...],
) -> Stream:
    """Yield poses in a frame, with covariance if there is one, and velocities since the last."""
    for stamp_, time, pose, *covariance in _values(stamps, rows, "time", *columns):
        earlier, before = translator.before.get(frame, (time - 1.0, pose))
        translator.before[frame] = time, pose
        rate, c, s = 1.0 / (time - earlier), cos(pose[2]), sin(pose[2])
        x, y, turn = (now - then for now, then in zip(pose, before, strict=True))
        turn = (turn + pi) % (2.0 * pi) - pi
        twist = twist_of(rate * (c * x + s * y), rate * (c * y - s * x), rate * turn)
        yield {
            "header": header(stamp_, frame),
            "child_frame_id": FOOTPRINT,
            "pose": uncertain_pose(pose, *covariance),
            "twist": {"twist": twist},
        }


def _command(translator: Translator, rows: Rows, stamps: list[Contents]) -> Stream:
    for _, command in _values(stamps, rows, "command"):
        yield twist_of(*command) if all(map(isfinite, command)) else None


def _compressed(translator: Translator, rows: Rows, stamps: list[Contents]) -> Stream:
    for time, content in zip(_captures(rows), rows["jpeg"], strict=True):
        yield {"header": header(time, CAMERA), "format": "jpeg", "data": content}


def _raw(translator: Translator, rows: Rows, stamps: list[Contents]) -> Stream:
    width, height, _ = translator.setup.camera
    size = {"height": height, "width": width, "encoding": "rgb8", "step": 3 * width}
    for time, image in zip(_captures(rows), rows["image"], strict=True):
        yield {"header": header(time, CAMERA), "data": image.tobytes(), **size}


def _camera_info(translator: Translator, rows: Rows, stamps: list[Contents]) -> Stream:
    width, height, f = translator.setup.camera
    u, v = 0.5 * width - 0.5, 0.5 * height - 0.5  # ROS: centre of the first pixel
    for time in _captures(rows):
        yield {
            "header": header(time, CAMERA),
            "height": height,
            "width": width,
            "distortion_model": "plumb_bob",
            "d": np.zeros(5),
            "k": [f, 0.0, u, 0.0, f, v, 0.0, 0.0, 1.0],
            "r": np.eye(3).ravel(),
            "p": [f, 0.0, u, 0.0, 0.0, f, v, 0.0, 0.0, 0.0, 1.0, 0.0],
        }


def _captures(rows: Rows) -> list[Contents]:
    """Return the stamps of the times at which images were taken."""
    return [stamp(time) for time in nanoseconds(rows["captured"]).tolist()]


def _belief(translator: Translator, rows: Rows, stamps: list[Contents]) -> Stream:
    for time, pose, covariance in _values(stamps, rows, "pose", "pose_covariance"):
        yield {"header": header(time, MAP), "pose": uncertain_pose(pose, covariance)}


def _goal(translator: Translator, rows: Rows, stamps: list[Contents]) -> Stream:
    """Yield the destinations that differ from the previous one."""
    for time, (x, y), heading in _values(stamps, rows, "target", "target_heading"):
        target = x, y, heading if isfinite(heading) else 0.0
        new = isfinite(x + y) and target != translator.before.get("goal")
        translator.before["goal"] = target
        yield {"header": header(time, MAP), "pose": pose_of(target)} if new else None


def _tracks(translator: Translator, rows: Rows, stamps: list[Contents]) -> Stream:
    """Yield the tracks of every frame: cylinders that replace the former ones."""
    height, tracks = translator.setup.height, rows["tracks"]
    markers: list[list[Contents]]
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
                "pose": {"position": xyz([x, y, 0.5 * height]), "orientation": {"w": 1.0}},
                "scale": xyz([2.0 * radius, 2.0 * radius, height]),
                "color": {"r": red / 255, "g": green / 255, "b": blue / 255, "a": 0.7},
            }
        )
    yield from ({"markers": some} for some in markers)


def _local_map(translator: Translator, rows: Rows, stamps: list[Contents]) -> Stream:
    """Yield the confidence of the local maps [%], which some frames have."""
    geometry = _values(stamps, rows, "map_origin", "map_cell")
    for (time, origin, cell), shades in zip(geometry, rows["local_map"], strict=True):
        yield (
            None
            if shades is None
            else {
                "header": header(time, MAP),
                "info": {
                    "map_load_time": time,
                    "resolution": cell,
                    "width": shades.shape[1],
                    "height": shades.shape[0],
                    "origin": {"position": xyz([*origin, 0.0]), "orientation": {"w": 1.0}},
                },
                "data": np.round(shades.ravel() * (100.0 / 255.0)),
            }
        )


TF, ODOMETRY = "tf2_msgs/msg/TFMessage", "nav_msgs/msg/Odometry"
CAMERA_POSE = ("camera_position", "camera_rotation")
ODOM_COLUMNS, TRUE_COLUMNS = ("odometry", "odometry_covariance"), ("robot",)
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
    Topic(
        "/odom",
        ODOMETRY,
        "records",
        ODOM_COLUMNS,
        partial(_motion, frame=ODOM, columns=ODOM_COLUMNS),
    ),
    Topic(
        "/ground_truth/odom",
        ODOMETRY,
        "records",
        TRUE_COLUMNS,
        partial(_motion, frame=MAP, columns=TRUE_COLUMNS),
    ),
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
