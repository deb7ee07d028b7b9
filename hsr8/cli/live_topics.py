"""Live ROS 2 topics of ``hsr8 run --ros``."""

import sys
from contextlib import ExitStack
from pathlib import Path

from hsr8.cli.options import Run
from hsr8.export.topics import Setup
from hsr8.export.urdf import MESHES, urdf_of
from hsr8.robots.loaded import load_robot
from hsr8.ros.live import LiveTopics
from hsr8.ros.process import Network
from hsr8.scenario.schema import Scenario
from hsr8.simulation.drive import Drive

DESCRIPTION = "robot.urdf"  # file in the folder of the run


def live_topics(
    options: Run, scenario: Scenario, path: Path, drive: Drive | None, opened: ExitStack
) -> LiveTopics:
    """Return the topics of a run; the description of the robot is in its folder.

    Args:
        options: options of the command.
        scenario: scenario of the run.
        path: folder of the run.
        drive: receives commands; None for none.
        opened: closes the topics.

    Raises:
        UsageError: an endpoint is taken or invalid.
    """
    for verb, endpoint in (
        ("connects to", options.ros_connect),
        ("listens on", options.ros_listen),
    ):
        if endpoint is not None:
            print(f"ros: {verb} {endpoint}, without encryption or passwords", file=sys.stderr)
    robot = load_robot(scenario.robot.model)
    meshes = (path / MESHES).resolve()
    urdf = urdf_of(robot, f"file://{meshes}")
    setup = Setup.of(robot, scenario.camera.pinhole, urdf.text)
    network = Network(
        options.ros_domain,
        options.ros_connect or "",
        options.ros_listen or "",
        drive=options.ros_drive,
    )
    topics = LiveTopics(network, setup, robot, scale=scenario.world.scale, drive=drive)
    opened.enter_context(topics)
    urdf.write(path / DESCRIPTION, meshes)
    return topics
