import gc
import weakref

import pytest

from hsr8.evaluation.recording import Recording
from hsr8.loop import Simulation
from hsr8.recorder.run.manifest import Manifest
from hsr8.scenario.loader import load_scenario


@pytest.fixture
def uncollected():
    """Nothing is freed but what nobody holds."""
    gc.disable()
    yield
    gc.enable()


def recorded(path):
    """A weak reference to the model of a run that is over."""
    settings = ['robot.body="kinematic"', 'camera.source="analytic"', "duration=1.2"]
    simulation = Simulation(load_scenario("quick", settings), 1)
    model = weakref.ref(simulation.model)
    recording = Recording(simulation)
    manifest = Manifest.now("quick", 1, ("test",), "analytic")
    recording.into(path, manifest)
    recording.run()
    return model


@pytest.mark.usefixtures("uncollected")
def test_a_run_that_is_over_is_gone_without_a_collection(tmp_path):
    first, second = tmp_path / "first", tmp_path / "second"
    first.mkdir()
    second.mkdir()
    recorded(first)  # kernels that are compiled on the way hold on to the run they began in
    assert recorded(second)() is None
