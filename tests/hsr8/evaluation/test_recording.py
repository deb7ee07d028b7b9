import gc
import weakref

import pytest

from hsr8.evaluation.recording import record
from hsr8.loop import Simulation
from hsr8.recorder.run.run_folder import RunFolder
from hsr8.scenario.loader import load_scenario


@pytest.fixture
def uncollected():
    """Only unreferenced objects are freed."""
    gc.disable()
    yield
    gc.enable()


def recorded(path):
    """Weak reference to the model of a finished run."""
    settings = ['robot.body="kinematic"', 'camera.source="analytic"', "duration=1.2"]
    simulation = Simulation(load_scenario("quick", settings), 1)
    model = weakref.ref(simulation.model)
    record(simulation, RunFolder(path, simulation.scenario, ("test",), "analytic"))
    return model


@pytest.mark.usefixtures("uncollected")
def test_a_finished_run_is_freed_without_garbage_collection(tmp_path):
    first, second = tmp_path / "first", tmp_path / "second"
    first.mkdir()
    second.mkdir()
    recorded(first)  # kernels that are compiled during a run keep a reference to it
    assert recorded(second)() is None
