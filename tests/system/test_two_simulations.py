"""Several simulations in one process do not affect each other."""

import sys
from threading import Thread

import mujoco
import pytest

from hsr8 import Simulation, load_scenario
from hsr8.world.model import assembly

DIFFERENT = ({}, {"robot.speed.vx": 0.1, "walking.gait.swing_height": 0.02}, {})


def scenarios():
    """Scenarios with the same robot, two of them with different parameters of its walk."""
    common = {"robot.body": "kinematic", "camera.source": "analytic", "duration": 3.0}
    return [load_scenario("quick", common | settings) for settings in DIFFERENT]


def in_turn(simulations):
    """Make one tick of each in turn."""
    for simulation in simulations:
        simulation.__enter__()
    for _ in zip(*simulations, strict=True):
        pass


def in_threads(simulations):
    """Run all at once; the interpreter switches between them as often as it can."""
    threads = [Thread(target=simulation.run) for simulation in simulations]
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    finally:
        sys.setswitchinterval(interval)


@pytest.mark.parametrize("together", [in_turn, in_threads])
def test_together_and_alone_give_the_same_states(together):
    alone = [Simulation(scenario, 3).run().state_hash for scenario in scenarios()]
    assert len(set(alone)) == 2
    simulations = [Simulation(scenario, 3) for scenario in scenarios()]
    together(simulations)
    assert [simulation.outcome().state_hash for simulation in simulations] == alone


@pytest.fixture
def handler():
    """Handler of MuJoCo's warnings that somebody else has set."""
    before = mujoco.get_mju_user_warning()

    def handle(message):
        """Take a warning."""

    mujoco.set_mju_user_warning(handle)
    yield handle
    mujoco.set_mju_user_warning(before)


def test_a_new_world_leaves_the_handler_of_warnings(handler, monkeypatch):
    scenario = scenarios()[0]
    Simulation(scenario, 0)
    assert mujoco.get_mju_user_warning() is handler

    for shapes in ("camera_spec", "visual_spec"):
        monkeypatch.setattr(assembly, shapes, lambda _robot: "not a model")
    with pytest.raises(TypeError):
        Simulation(scenario, 0)
    assert mujoco.get_mju_user_warning() is handler
