"""A run as a rosbag2 folder: MCAP with zstd chunks, without ROS."""

from pathlib import Path
from typing import Any

import numpy as np

from hsr8.errors import UsageError
from hsr8.export.cdr import Messages
from hsr8.export.topics import START, TOPICS, Setup, Translator
from hsr8.export.transforms import odom_in_map
from hsr8.export.urdf import MESHES, urdf_of
from hsr8.recording.run import Run
from hsr8.robots.loaded import load_robot

READ = ("ticks", "frames", "records", "images")  # tables in the order that a translator needs


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
    rosbag2, serializer = require_rosbags()
    if not len(run.records):
        raise UsageError(f"--bag: {run.folder}: no records")
    scenario = run.scenario()
    robot = load_robot(scenario.robot.model)
    urdf = urdf_of(robot)
    first = odom_in_map(run.frames["pose"][:1], run.frames["odometry"][:1])
    start = {"time": np.zeros(1), "start": first if len(first) else np.zeros((1, 3))}
    translator = Translator(serializer, Setup.of(robot, scenario.camera.pinhole, urdf.text))
    sources = {START: start, **{name: getattr(run, name) for name in READ}}
    sent = {
        topic: messages
        for table, rows in sources.items()
        if len(rows["time"])
        for topic, messages in translator.translate(table, rows)
        if messages
    }
    topics = [topic for topic in TOPICS if topic in sent]
    writer = rosbag2.Writer(folder, version=9, storage_plugin=rosbag2.StoragePlugin.MCAP)
    writer.set_compression(rosbag2.CompressionMode.STORAGE, rosbag2.CompressionFormat.ZSTD)
    with writer:
        connections = [
            writer.add_connection(
                topic.name,
                topic.kind,
                typestore=serializer.store,
                offered_qos_profiles=[_latched()] if topic.latched else [],
            )
            for topic in topics
        ]
        lines = [
            (time, connection, message)
            for topic, connection in zip(topics, connections, strict=True)
            for time, message in sent[topic]
        ]
        for time, connection, message in sorted(lines, key=lambda line: line[0]):
            writer.write(connection, time, message)
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
