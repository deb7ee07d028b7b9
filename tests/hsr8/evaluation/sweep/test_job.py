"""A job in this process: outcome, metrics and folder of its run."""

import json
import os
import pickle
import signal
from dataclasses import replace

import pytest

from hsr8.errors import RecordingFailed, SimulationDiverged
from hsr8.evaluation.sweep.job import Job, complete, run_job, unfinished
from hsr8.loop import Simulation
from hsr8.recorder.run.run_reader import open_run
from hsr8.scenario.loader import load_scenario

SHORT = ("robot.body=kinematic", "camera.source=analytic", "duration=0.3")


@pytest.fixture
def job(tmp_path):
    """Job whose run meets its criteria: a walk."""
    scenario = load_scenario("walk", SHORT, 3)
    return Job(scenario, str(tmp_path / "sweep"), "hsr8 run walk --seed 3", 30.0)


@pytest.fixture(autouse=True)
def _handler():
    """Restore the handler of SIGTERM, which a job replaces in its own process."""
    handler = signal.getsignal(signal.SIGTERM)
    yield
    signal.signal(signal.SIGTERM, handler)


def result_of(job):
    result = unfinished(job)
    for part in run_job(job):
        result |= part
    return complete(job, result)


def test_the_metrics_of_the_run_folder_are_the_result(job, tmp_path):
    result = result_of(job)
    assert result["outcome"] == "passed"
    assert result["seed"] == 3
    assert "error" not in result
    run = open_run(tmp_path / "sweep" / result["run"])
    assert run.metrics().items() <= result.items()
    assert run.manifest["command"] == "hsr8 run walk --seed 3"
    alone = Simulation(job.scenario, 3).run()
    assert result["state_hash"] == alone.state_hash


def test_a_missed_goal_is_a_failure(job):
    scenario = load_scenario("quick", SHORT, 3)
    assert result_of(replace(job, scenario=scenario))["outcome"] == "failed"


def raising(error):
    def method(self, *_):
        raise error

    return method


@pytest.mark.parametrize(
    ("place", "error", "outcome", "word", "folder"),
    [
        ("loop.Simulation.step", ZeroDivisionError("oh no"), "crashed", "oh no", True),
        ("loop.Simulation.step", RecordingFailed("disk full"), "crashed", "disk full", True),
        ("loop.Simulation.step", KeyboardInterrupt(), "crashed", "interrupted", True),
        (
            "world.body.kinematic.KinematicBody.apply",
            SimulationDiverged("too fast"),
            "diverged",
            "too fast",
            True,
        ),
        ("loop.Simulation._build_robot", ValueError("no robot"), "crashed", "no robot", False),
    ],
)
def test_other_endings_are_errors(job, monkeypatch, place, error, outcome, word, folder):
    monkeypatch.setattr(f"hsr8.{place}", raising(error))
    result = result_of(job)
    assert result["outcome"] == outcome
    assert word in result["error"]
    assert (result["run"] is not None) == folder


def test_a_world_that_cannot_be_drawn_is_refused_and_leaves_no_folder(job, tmp_path):
    crowded = (*SHORT, "world.n_static=60", "world.size=[2.0,2.0]")
    result = result_of(replace(job, scenario=load_scenario("quick", crowded, 3)))
    assert result["outcome"] == "refused"
    assert "world" in result["error"]
    assert not list(tmp_path.glob("sweep/runs/*/*"))


def test_a_folder_that_cannot_be_written_is_a_refusal_with_its_reason(job, tmp_path):
    (tmp_path / "sweep").touch()
    result = result_of(job)
    assert result["outcome"] == "refused"
    assert "cannot write the run folder" in result["error"]


def test_sigterm_ends_the_run_after_the_tick_and_leaves_a_whole_folder(job, tmp_path, monkeypatch):
    step = Simulation.step

    def interrupting(self):
        if self.tick == 20:
            os.kill(os.getpid(), signal.SIGTERM)
        return step(self)

    monkeypatch.setattr(Simulation, "step", interrupting)
    result = result_of(job)
    assert (result["outcome"], result["error"]) == ("crashed", "interrupted")
    run = open_run(tmp_path / "sweep" / result["run"])
    assert run.manifest["exit_reason"] == "interrupted"
    assert len(run.ticks) == 21


@pytest.mark.parametrize(
    ("keep", "outcome", "kept"),
    [
        ("all", "passed", True),
        ("failed", "passed", False),
        ("failed", "failed", True),
        ("none", "failed", False),
        ("none", "crashed", False),
    ],
)
@pytest.mark.parametrize("crash", [False, True])
def test_run_folders_are_kept_as_requested(job, tmp_path, keep, outcome, kept, crash):
    """One with the traceback that its result names always is."""
    folder = tmp_path / "sweep" / "runs" / "quick" / "3-abc"
    folder.mkdir(parents=True)
    (folder / "metrics.json").write_text(json.dumps({}))
    if crash:
        (folder / "crash.txt").write_text("Traceback")
    job = replace(job, keep=keep)
    result = complete(job, unfinished(job) | {"outcome": outcome, "run": "runs/quick/3-abc"})
    assert folder.exists() == (kept or crash)
    assert (result["run"] is not None) == folder.exists()


def test_consent_to_plugins_travels_with_the_job(job, tmp_path):
    (tmp_path / "mine.py").write_text("class Mine:\n    def plan(self, *_):\n        return None\n")
    given = load_scenario("quick", ("plugin.planner=mine.py:Mine",))
    (tmp_path / "foreign").mkdir()
    file = tmp_path / "foreign" / "yard.toml"
    file.write_text('extends = "quick"\n[plugin]\nplanner = "../mine.py:Mine"\n')
    for scenario in (given, load_scenario(str(file))):
        copy = pickle.loads(pickle.dumps(replace(job, scenario=scenario))).scenario
        assert copy == scenario
        assert copy.plugin.untrusted == scenario.plugin.untrusted
    assert given.plugin.untrusted != scenario.plugin.untrusted
