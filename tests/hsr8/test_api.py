import numpy as np
import pytest

import hsr8
from hsr8.errors import RenderingUnavailable, ScenarioError, UsageError
from hsr8.recording.run import open_run
from navigation.belief.belief import Belief
from navigation.decision import GazeDecision, MotionDecision

STAND_INS = {"robot.body": "kinematic", "camera.source": "analytic", "duration": 1.0}


class Idle:
    """Stands and looks ahead."""

    def plan(self, belief, task):
        return MotionDecision(np.zeros(3))

    def choose(self, belief, task, motion):
        return GazeDecision(0.0, 0.0)


def test_nothing_is_written_by_default(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = hsr8.run("quick", seed=3, settings=STAND_INS)
    assert list(tmp_path.iterdir()) == []
    assert result.path is None
    assert (result.exit_reason, result.criteria_met) == ("timeout", False)


def test_the_folder_names_custom_planner_and_gaze(tmp_path):
    result = hsr8.run("quick", settings=STAND_INS, out=tmp_path, planner=Idle(), gaze=Idle())
    called = f"hsr8.run(planner={__name__}.Idle, gaze={__name__}.Idle)"
    assert open_run(result.path).manifest["command"] == called


def test_seeds_may_come_from_numpy(tmp_path):
    drawn = np.random.default_rng(0).integers(100, size=1)[0]
    result = hsr8.run("quick", seed=drawn, settings=STAND_INS, out=tmp_path)
    assert open_run(result.path).seed == drawn
    with pytest.raises(ScenarioError, match="expected an integer"):
        hsr8.run("quick", seed=-1)


def test_ctrl_c_ends_the_loop_around_a_run_and_leaves_its_folder(tmp_path):
    class Stops(Idle):
        def plan(self, belief, task):
            if belief.time > 0.3:
                raise KeyboardInterrupt
            return super().plan(belief, task)

    with pytest.raises(KeyboardInterrupt):
        hsr8.run("quick", settings=STAND_INS, out=tmp_path, planner=Stops())
    run = open_run(tmp_path)
    assert run.manifest["exit_reason"] == run.metrics["exit_reason"] == "interrupted"
    assert 0.3 < run.records["time"][-1] < 1.0


@pytest.mark.gl
@pytest.mark.parametrize(("kept", "period"), [("full", 1), ("standard", 3)])
def test_images_are_kept_by_their_setting_with_or_without_a_log(tmp_path, kept, period):
    settings = {"robot.body": "kinematic", "duration": 0.4, "recorder.images": kept}
    for log in (False, True):
        out = tmp_path / str(log) if period == 3 or log else None
        run = hsr8.run("quick", settings=settings, out=out, log=log)
        assert run.images["index"].tolist() == [*run.frames["index"][::period]]


def test_a_log_without_a_folder_is_refused():
    with pytest.raises(UsageError, match="log: needs a folder"):
        hsr8.run("quick", settings=STAND_INS, log=True)


def test_without_opengl_no_folder_is_left(tmp_path, monkeypatch):
    def none():
        raise RenderingUnavailable("no OpenGL")

    monkeypatch.setattr("hsr8.driver.require_gl", none)
    with pytest.raises(RenderingUnavailable):
        hsr8.run("quick", out=tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_criteria_met():
    settings = STAND_INS | {"criteria.goal_reached": False}
    assert hsr8.run("quick", settings=settings).criteria_met


def test_the_public_names_are_listed():
    assert set(hsr8.__all__) <= set(dir(hsr8))
    assert all(hasattr(hsr8, name) for name in dir(hsr8))


def test_a_plugin_needs_no_other_import():
    assert hsr8.MotionDecision is MotionDecision
    assert hsr8.GazeDecision is GazeDecision
    assert hsr8.Belief is Belief
    errors = {name for name, kind in vars(hsr8.errors).items() if isinstance(kind, type)}
    assert errors <= set(hsr8.__all__)


def test_the_runs_of_a_folder_are_listed_from_the_oldest_to_the_newest(tmp_path):
    assert hsr8.runs(tmp_path) == []
    settings = STAND_INS | {"duration": 0.1}
    folders = [hsr8.run("quick", seed=k, settings=settings, out=tmp_path).folder for k in (3, 1, 2)]
    damaged = tmp_path / "quick" / "9-000000"
    damaged.mkdir()
    (damaged / "manifest.json").write_text("{")
    for folder in (tmp_path, tmp_path / "quick"):
        assert [run.path for run in hsr8.runs(folder)] == folders
    assert [run.path for run in hsr8.runs(folders[0])] == folders[:1]
    with pytest.raises(hsr8.UsageError, match="no such folder"):
        hsr8.runs(tmp_path / "missing")
