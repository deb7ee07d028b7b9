"""A run depends on scenario and seed alone: not on its observers, its process or its neighbours."""

import shlex
import sys
from threading import Thread

import pytest

import hsr8
from hsr8.cli.main import entry
from hsr8.recording.difference import first_cell
from hsr8.recording.rows import TABLES
from hsr8.recording.verification import recompute
from hsr8.sweep.folder import SweepFolder

STAND_INS = {"robot.body": "kinematic", "camera.source": "analytic", "duration": 2.0}
WORDS = ["--body", "kinematic", "--camera", "analytic", "--quiet"]
DIFFERENT = ({}, {"robot.speed.vx": 0.1, "walking.gait.swing_height": 0.02}, {})


def simulation(seed=3, settings=STAND_INS, scenario="course"):
    return hsr8.Simulation(hsr8.load_scenario(scenario, settings), seed)


def state(run):
    return run.metrics["state_hash"]


@pytest.fixture(scope="module")
def alone():
    """A run without observers."""
    return simulation().run()


def test_a_seed_repeats_its_run_and_another_seed_is_another_run(alone):
    assert simulation().run() == alone
    assert simulation(4).run().state_hash != alone.state_hash


@pytest.mark.gl
def test_physics_and_pixels_repeat():
    settings = {"duration": 1.5}
    assert simulation(5, settings).run() == simulation(5, settings).run()


def meddle(record):
    """Overwrite all published arrays."""
    record.truth.qpos[:] = 0.0
    record.truth.robot[:] = 1e3
    record.truth.obstacle_positions[:] = 0.0
    if record.frame is not None:
        frame = record.frame
        for array in (frame.motion.velocity, frame.task.target):
            with pytest.raises(ValueError, match="read-only"):
                array[:] = 9.0
        frame.gaze.gaze_map[:] = 9.0
        frame.belief.pose[:] = 9.0
        for track in frame.belief.tracks:
            track.position[:] = 9.0


def test_published_arrays_have_no_effect_on_the_run():
    """The belief is part of the hash, so the positions of the robot are compared."""
    paths = []
    for act in (lambda record: None, meddle):
        path = []
        with simulation() as run:
            for tick in run:
                if tick.record is not None:
                    path.append(tick.record.truth.robot.tolist())
                    act(tick.record)
        paths.append(path)
    assert paths[0] == paths[1]


def test_a_situation_that_is_read_and_not_decided_changes_nothing(alone):
    with simulation() as driven:
        while driven.exit_reason is None:
            assert driven.perceive() is driven.perceive()
            driven.step()
    assert driven.outcome() == alone


def test_a_run_in_memory_is_that_on_disk_with_and_without_a_log(alone, tmp_path, monkeypatch):
    stored = hsr8.run("course", seed=3, settings=STAND_INS, out=tmp_path, log=True)
    monkeypatch.setattr("tempfile.mkdtemp", lambda *_, **__: pytest.fail("a temporary folder"))
    kept = hsr8.run("course", seed=3, settings=STAND_INS)
    assert state(kept) == state(stored) == alone.state_hash
    assert kept.scenario() == stored.scenario()
    for key in ("rows", "libraries"):
        assert kept.manifest[key] == stored.manifest[key]
    for name, row in TABLES.items():
        one, other = getattr(kept, name), getattr(stored, name)
        assert one.arrow.schema.equals(other.arrow.schema, check_metadata=True)
        assert [*one] == [*other] == [column.name for column in row.columns]
        assert first_cell(one, other, ignored=("walking_time",)) is None
    assert all(stage.equal for stage in recompute(kept))


@pytest.mark.gl
def test_a_video_and_a_log_change_nothing_and_render_draws_the_video_again(tmp_path):
    short = STAND_INS | {"duration": 0.4}
    words = [*WORDS, "--duration", "0.4", "--log", "--video", "--out", str(tmp_path)]
    assert entry(["run", "course", "--seed", "3", *words]) == 1
    run = hsr8.open_run(tmp_path)
    assert state(run) == simulation(settings=short).run().state_hash
    assert entry(["render", str(run.path), "--out", str(tmp_path / "again.mp4"), "--quiet"]) == 0
    for suffix in (".mp4", ".png"):
        drawn, again = run.path / f"video{suffix}", tmp_path / f"again{suffix}"
        assert drawn.read_bytes() == again.read_bytes()


def test_scenario_and_command_of_a_folder_repeat_its_run(tmp_path):
    settings = STAND_INS | {"world.n_static": 3}
    run = hsr8.run("quick", seed=9, settings=settings, out=tmp_path / "first")
    assert state(hsr8.run(run.scenario_file)) == state(run)
    words = shlex.split(run.manifest["command"])[1:]
    entry([*words, "--quiet", "--out", str(tmp_path / "again")])
    assert state(hsr8.open_run(tmp_path / "again")) == state(run)


def test_the_runs_of_a_sweep_in_processes_of_their_own_are_single_runs(tmp_path):
    words = ["--seeds", "3:5", "--workers", "2", *WORDS, "--duration", "1"]
    assert entry(["sweep", "course", *words, "--out", str(tmp_path / "s")]) == 1
    for result in SweepFolder.read(tmp_path / "s").results():
        single = simulation(result["seed"], STAND_INS | {"duration": 1.0}).run()
        assert result["state_hash"] == single.state_hash


def in_turn(simulations):
    """Make one tick of each in turn."""
    for one in simulations:
        one.__enter__()
    for _ in zip(*simulations, strict=True):
        pass


def in_threads(simulations):
    """Run all at once; the interpreter switches between them as often as it can."""
    threads = [Thread(target=one.run) for one in simulations]
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
def test_simulations_in_one_process_do_not_affect_each_other(together):
    """Robots are shared, parameters of their walks differ."""

    def simulations():
        return [
            simulation(3, STAND_INS | {"duration": 1.2} | changes, "quick") for changes in DIFFERENT
        ]

    separate = [one.run().state_hash for one in simulations()]
    assert len(set(separate)) == 2
    several = simulations()
    together(several)
    assert [one.outcome().state_hash for one in several] == separate
