"""A run depends on scenario and seed alone."""

import pytest

import hsr8
from hsr8.scenario.loader import load_scenario
from hsr8.simulation.loop import Simulation

STAND_INS_BY_KEY = {"robot.body": "kinematic", "camera.source": "analytic"}
STAND_INS = [f'{key}="{value}"' for key, value in STAND_INS_BY_KEY.items()]


def final_hash(seed, settings, duration, on_record=lambda record: None):
    scenario = load_scenario("course", [*settings, f"duration={duration}"])
    with Simulation(scenario, seed) as simulation:
        for tick in simulation:
            if tick.record is not None:
                on_record(tick.record)
    return simulation.outcome().state_hash


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


def test_the_same_seed_repeats_a_run():
    assert final_hash(3, STAND_INS, 2.0) == final_hash(3, STAND_INS, 2.0)


def test_what_is_published_has_no_effect_on_the_run():
    """The belief is part of the hash, so the positions of the robot are compared."""
    alone, meddled = [], []

    def meddling(record):
        meddled.append(record.truth.robot.tolist())
        meddle(record)

    final_hash(3, STAND_INS, 4.0, lambda record: alone.append(record.truth.robot.tolist()))
    final_hash(3, STAND_INS, 4.0, meddling)
    assert meddled == alone


@pytest.mark.parametrize("log", [False, True])
def test_records_and_log_change_nothing(tmp_path, log):
    settings = {**STAND_INS_BY_KEY, "duration": 3.0}
    result = hsr8.run("course", seed=3, settings=settings, out=tmp_path, log=log)
    assert result.metrics["state_hash"] == final_hash(3, STAND_INS, 3.0)


def test_another_seed_another_end():
    assert final_hash(3, STAND_INS, 1.0) != final_hash(4, STAND_INS, 1.0)


@pytest.mark.gl
def test_physics_and_pixels_repeat():
    assert final_hash(5, [], 2.0) == final_hash(5, [], 2.0)
