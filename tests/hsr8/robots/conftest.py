"""Model of HSR-VIII."""

import pytest

from hsr8.robots.loaded import load_robot
from walking.body.robot_model import RobotModel


@pytest.fixture(scope="session")
def robot() -> RobotModel:
    return load_robot("hsr8").model
