"""A run depends on scenario and seed alone."""

import pytest

from hsr8.loop import Simulation
from hsr8.record import Listener
from hsr8.recorder.log.log_reader import Log
from hsr8.recorder.log.rerun_log import RerunLog
from hsr8.recorder.log_level import LogLevel
from hsr8.scenario.loader import load_scenario

STAND_INS = ['robot.body="kinematic"', 'camera.source="analytic"']


def final_hash(seed, settings, duration, listeners=()):
    scenario = load_scenario("course", [*settings, f"duration={duration}"])
    return Simulation(scenario, seed, listeners).run().state_hash


class Recorder(Listener):
    """A listener that records the positions of the robot."""

    def __init__(self):
        self.positions = []

    def on_record(self, record):
        self.positions.append(record.truth.robot.tolist())


class Meddler(Listener):
    """A listener that overwrites all published arrays."""

    def on_record(self, record):
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


def test_listeners_have_no_effect_on_the_run():
    alone, meddled = Recorder(), Recorder()
    final_hash(3, STAND_INS, 4.0, [alone])
    final_hash(3, STAND_INS, 4.0, [meddled, Meddler()])
    assert meddled.positions == alone.positions


def test_a_log_of_everything_changes_nothing(tmp_path):
    scenario = load_scenario("course", [*STAND_INS, "duration=3.0"])
    simulation = Simulation(scenario, 3)
    size = (scenario.camera.width, scenario.camera.height)
    for level in LogLevel:
        file = tmp_path / f"{level}.rrd"
        log = RerunLog(
            file,
            (simulation.model, simulation.humanoid, simulation.layout),
            size,
            "test",
            gaze=scenario.navigation.gaze,
            level=level,
        )
        simulation.listeners.append(log)
    assert simulation.run().state_hash == final_hash(3, STAND_INS, 3.0)
    fields = Log(file).table("/plan/field", "Arrows3D:vectors")
    assert len(fields) >= 5  # decisions of the planner


def test_another_seed_another_end():
    assert final_hash(3, STAND_INS, 1.0) != final_hash(4, STAND_INS, 1.0)


@pytest.mark.gl
def test_physics_and_pixels_repeat():
    assert final_hash(5, [], 2.0) == final_hash(5, [], 2.0)
