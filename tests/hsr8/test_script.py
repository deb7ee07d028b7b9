import numpy as np
import pytest

from hsr8.scenario.loader import load
from hsr8.script import ScriptedMission, ScriptedPlanner


class At:
    def __init__(self, time):
        self.time = time
        self.pose = np.array([0.3, -0.2, 0.5])


@pytest.fixture
def planner():
    commands = "[{duration = 2.0, forward = 0.1}, {duration = 1.0, left = 0.05, turn = -0.4}]"
    return ScriptedPlanner(load("walk", [f"mission.command={commands}"]).mission)


@pytest.mark.parametrize(
    ("time", "expected"),
    [
        (0.0, (0.1, 0.0, 0.0)),
        (1.99, (0.1, 0.0, 0.0)),
        (2.0, (0.0, 0.05, -0.4)),
        (2.99, (0.0, 0.05, -0.4)),
        (3.0, (0.0, 0.0, 0.0)),
    ],
)
def test_each_stretch_is_walked_in_turn_and_then_it_stands(planner, time, expected):
    task = ScriptedMission().update(At(time).pose)
    assert planner.plan(At(time), task).velocity.tolist() == list(expected)


def test_the_gaze_has_something_ahead():
    task = ScriptedMission().update(np.array([1.0, 2.0, np.pi / 2]))
    assert np.allclose(task.target, (1.0, 3.0))
    assert not task.done
