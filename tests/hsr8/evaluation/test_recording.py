import gc
import weakref

import pytest

import hsr8
from hsr8.evaluation.recording import Recording
from hsr8.evaluation.registry import METRICS, Metric
from hsr8.loop import Simulation
from hsr8.recorder.columns import Column, Row
from hsr8.recorder.rows import TABLES
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
    folder = RunFolder(path, simulation.scenario, ("test",), "analytic")
    with Recording(simulation, folder) as recording:
        for tick in simulation:
            recording.append(tick)
    assert recording.run().exit_reason == "timeout"
    return model


@pytest.mark.usefixtures("uncollected")
def test_a_finished_run_is_freed_without_garbage_collection(tmp_path):
    first, second = tmp_path / "first", tmp_path / "second"
    first.mkdir()
    second.mkdir()
    recorded(first)  # kernels that are compiled during a run keep a reference to it
    assert recorded(second)() is None


def test_a_new_column_and_a_new_metric_are_one_entry_each(monkeypatch, tmp_path):
    row = TABLES["ticks"]
    gyro = Column("sensors.gyro", "the gyro again", "rad/s", (3,), name="again")
    monkeypatch.setitem(TABLES, "ticks", Row(row.text, *row.columns, gyro))
    of = Metric("max_gyro_radps", "", of=lambda run: float(abs(run.ticks["again"]).max()))
    monkeypatch.setitem(METRICS, of.name, of)
    settings = {"robot.body": "kinematic", "camera.source": "analytic", "duration": 0.3}
    for out in (None, tmp_path):
        run = hsr8.run("quick", settings=settings, out=out)
        assert run.metrics["max_gyro_radps"] == abs(run.ticks["gyro"]).max()
        assert run.unit("ticks.again") == "rad/s"
