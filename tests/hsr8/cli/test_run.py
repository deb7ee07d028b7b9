import json
import os
import signal

import numpy as np
import pytest

from hsr8.cli.main import entry
from hsr8.errors import SimulationDiverged
from hsr8.recording.run import open_run
from hsr8.scenario.loader import dump
from hsr8.simulation.loop import Simulation

FAST = ["run", "quick", "--body", "kinematic", "--camera", "analytic", "--duration", "1"]


def _run(tmp_path, *more):
    return entry([*FAST, "--out", str(tmp_path), *more])


def test_json_is_the_only_output_of_a_plugin_that_prints(tmp_path, capsys):
    file = tmp_path / "talks.py"
    file.write_text(
        "import numpy as np\n"
        "from navigation.decision import MotionDecision\n"
        "class Talks:\n"
        "    def plan(self, belief, task):\n"
        "        print('hello')\n"
        "        return MotionDecision(np.zeros(3))\n"
    )
    _run(tmp_path / "runs", "--json", "--set", f"plugin.planner={file}:Talks")
    printed = capsys.readouterr()
    assert json.loads(printed.out)["collisions"] == 0
    assert "hello" in printed.err


def test_json_is_the_only_output(tmp_path, capsys):
    code = _run(tmp_path, "--json")
    printed = capsys.readouterr().out
    results = json.loads(printed)
    assert printed.count("\n") == 1
    assert code == 1  # one second is not enough for the goal
    run = open_run(tmp_path)
    assert run.metrics.items() <= results.items()
    assert results["criteria_met"] is False
    assert results["definitions"].keys() == {"success", "criteria_met"}
    assert run.manifest["exit_reason"] == results["exit_reason"] == "timeout"
    assert run.manifest["renderer"] == "analytic"
    assert run.log_file is None


def test_quiet_is_quiet(tmp_path, capsys):
    _run(tmp_path, "--quiet")
    printed = capsys.readouterr()
    assert printed.out == printed.err == ""


def test_a_run_that_meets_its_criteria_passes(tmp_path, capsys):
    assert _run(tmp_path, "--set", "criteria.goal_reached=false") == 0
    assert "; the criteria are met   (" in capsys.readouterr().out


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_leaves_a_whole_folder(tmp_path, monkeypatch, capsys, number):
    """The signal arrives during the run, which ends after the current tick."""
    step = Simulation.step

    def interrupting(self):
        if self.tick == 100:
            os.kill(os.getpid(), number)
        return step(self)

    monkeypatch.setattr(Simulation, "step", interrupting)
    handler = signal.getsignal(number)
    assert _run(tmp_path, "--json") == 130
    assert signal.getsignal(number) is handler
    results = json.loads(capsys.readouterr().out)
    assert results["exit_reason"] == "interrupted"
    assert 0.4 < results["sim_time_s"] < 0.6
    run = open_run(tmp_path)
    assert run.manifest["exit_reason"] == "interrupted"
    assert len(run.records) > 20


def test_ctrl_c_during_setup_leaves_a_whole_folder(tmp_path, monkeypatch, capsys):
    def interrupted(scenario):
        os.kill(os.getpid(), signal.SIGINT)
        return dump(scenario)

    monkeypatch.setattr("hsr8.recording.run_folder.dump", interrupted)
    assert _run(tmp_path, "--quiet") == 130
    run = open_run(tmp_path)
    assert run.manifest["exit_reason"] == run.metrics["exit_reason"] == "interrupted"


def test_a_diverged_run_is_reported_and_recorded(tmp_path, monkeypatch, capsys):
    def diverging(self, targets):
        raise SimulationDiverged("the physics diverged at tick 12")

    monkeypatch.setattr("hsr8.world.body.kinematic.KinematicBody.apply", diverging)
    assert _run(tmp_path, "--json") == 3
    printed = capsys.readouterr()
    assert "tick 12" in printed.err
    assert json.loads(printed.out)["exit_reason"] == "diverged"
    run = open_run(tmp_path)
    assert run.manifest["exit_reason"] == "diverged"
    assert run.events["kind"].tolist() == ["diverged"]
    assert np.isfinite(run.ticks["setpoint"]).all()


def test_an_internal_error_leaves_its_traceback_in_the_run_folder(tmp_path, monkeypatch, capsys):
    def broken(self):
        raise ZeroDivisionError("oh no")

    monkeypatch.setattr("hsr8.world.body.kinematic.KinematicBody.truth", broken)
    assert _run(tmp_path, "--json") == 3
    printed = capsys.readouterr()
    assert printed.out == ""
    assert "Traceback" not in printed.err
    run = open_run(tmp_path)
    assert run.manifest["exit_reason"] == "error"
    assert "ZeroDivisionError: oh no" in (run.path / "crash.txt").read_text()


def test_set_overrides_the_other_options(tmp_path, capsys):
    _run(tmp_path, "--quiet", "--set", "duration=0.4")
    assert open_run(tmp_path).metrics["sim_time_s"] == pytest.approx(0.4)
