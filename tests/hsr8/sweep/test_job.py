"""A job in this process: outcome, metrics and folder of its run."""

import os
import pickle
import signal
from dataclasses import replace

import pytest

from hsr8.errors import SimulationDiverged
from hsr8.recording.run import open_run
from hsr8.scenario.loader import load_scenario
from hsr8.simulation.loop import Simulation
from hsr8.sweep.job import Job, prune, run_job

SHORT = ("robot.body=kinematic", "camera.source=analytic", "duration=0.3")


@pytest.fixture
def job(tmp_path):
    """Job whose run meets its criteria: a walk."""
    scenario = load_scenario("walk", SHORT, 3)
    return Job(scenario, str(tmp_path / "sweep"), "runs/walk/3-1", "hsr8 run walk --seed 3", 30.0)


@pytest.fixture(autouse=True)
def _handler():
    """Restore the handler of SIGTERM, which a job replaces in its own process."""
    handler = signal.getsignal(signal.SIGTERM)
    yield
    signal.signal(signal.SIGTERM, handler)


def result_of(job):
    return prune(job, run_job(job))


def test_the_metrics_of_the_run_folder_are_the_result(job, tmp_path):
    result = result_of(job)
    assert result["outcome"] == "passed"
    assert "error" not in result
    run = open_run(tmp_path / "sweep" / result["run"])
    assert run.metrics.items() <= result.items()
    assert run.manifest["command"] == "hsr8 run walk --seed 3"
    alone = Simulation(job.scenario, 3).run()
    assert result["state_hash"] == alone.state_hash


def test_a_missed_goal_is_a_failure(job):
    scenario = load_scenario("quick", SHORT, 3)
    assert result_of(replace(job, scenario=scenario))["outcome"] == "failed"


def raising(error):
    def method(*_, **__):
        raise error

    return method


@pytest.mark.parametrize(
    ("place", "error", "outcome", "word", "folder"),
    [
        ("simulation.loop.Simulation.step", ZeroDivisionError("oh no"), "crashed", "oh no", True),
        ("simulation.loop.Simulation.step", KeyboardInterrupt(), "crashed", "interrupted", True),
        (
            "world.body.kinematic.KinematicBody.apply",
            SimulationDiverged("too fast"),
            "diverged",
            "too fast",
            True,
        ),
    ],
)
def test_other_endings_are_errors(job, monkeypatch, place, error, outcome, word, folder):
    monkeypatch.setattr(f"hsr8.{place}", raising(error))
    result = result_of(job)
    assert result["outcome"] == outcome
    assert word in result["error"]
    assert (result["run"] is not None) == folder


def test_the_traceback_of_a_simulation_that_cannot_be_built_is_in_the_folder(job, monkeypatch):
    monkeypatch.setattr("hsr8.simulation.loop.build_robot", raising(RuntimeError("no robot")))
    assert result_of(job)["outcome"] == "crashed"
    assert "no robot" in (job.path / "crash.txt").read_text()


def test_a_world_that_cannot_be_drawn_is_refused(job):
    crowded = (*SHORT, "world.n_static=60", "world.size=[2.0,2.0]")
    result = result_of(replace(job, scenario=load_scenario("quick", crowded, 3)))
    assert (result["outcome"], result["run"]) == ("refused", None)
    assert "world" in result["error"]


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
    ("keep", "success", "kept"),
    [("all", True, True), ("failed", True, False), ("failed", False, True), ("none", False, False)],
)
@pytest.mark.parametrize("crash", [False, True])
def test_runs_are_kept_as_requested(job, keep, success, kept, crash):
    """One with the traceback that its result names always is."""
    job.path.mkdir(parents=True)
    for name in ("manifest.json", "claim.json", *(["crash.txt"] if crash else [])):
        (job.path / name).touch()
    result = prune(replace(job, keep=keep), {"outcome": "passed", "success": success})
    assert (job.path / "manifest.json").exists() == (kept or crash)
    assert (job.path / "claim.json").exists()
    assert result["run"] == (job.run if kept or crash else None)


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
