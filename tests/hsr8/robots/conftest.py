"""Robots that many tests read and none changes."""

import pytest

from hsr8.robots.loaded import LoadedRobot, load_robot
from tests.hsr8.robots.small_urdf import SmallUrdf, built
from walking.body.robot_model import RobotModel


@pytest.fixture(scope="session")
def robot() -> RobotModel:
    return load_robot("hsr8").model


@pytest.fixture(scope="session")
def small_robot(tmp_path_factory) -> LoadedRobot:
    """The small URDF robot without changes."""
    return built(SmallUrdf().element(), tmp_path_factory.mktemp("small"))
