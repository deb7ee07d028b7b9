"""Robots that many tests read and none changes."""

from collections.abc import Iterator

import pytest

from hsr8.robots.inspection import inspect, load_inspected
from hsr8.robots.loaded import LoadedRobot, load_robot
from tests.hsr8.robots.small_humanoid import SmallHumanoid
from tests.hsr8.robots.small_urdf import SmallUrdf, built
from tests.hsr8.robots.unrehearsed import unrehearsed_robots
from walking.body.robot_model import RobotModel


@pytest.fixture(scope="session")
def robot() -> RobotModel:
    return load_robot("hsr8").model


@pytest.fixture(scope="session")
def plain(tmp_path_factory) -> LoadedRobot:
    """The small MJCF robot without changes, with its guessed description."""
    file = tmp_path_factory.mktemp("plain") / "small.xml"
    file.write_text(SmallHumanoid().xml())
    with unrehearsed_robots():
        return load_inspected(inspect(str(file)))[1]


@pytest.fixture(scope="session")
def small_robot(tmp_path_factory) -> LoadedRobot:
    """The small URDF robot without changes."""
    with unrehearsed_robots():
        return built(SmallUrdf().element(), tmp_path_factory.mktemp("small"))


@pytest.fixture(autouse=True)
def unrehearsed() -> Iterator[None]:
    with unrehearsed_robots():
        yield
