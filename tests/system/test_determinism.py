"""A run depends on scenario and seed alone."""

import pytest

from hsr8.loop import Simulation
from hsr8.recorder.log.log_reader import Log
from hsr8.recorder.log.rerun_log import RerunLog
from hsr8.recorder.log_level import LogLevel
from hsr8.recorder.record import Listener
from hsr8.scenario.loader import load_scenario

STAND_INS = ['robot.body="kinematic"', 'camera.source="analytic"']


def final_hash(seed, settings, duration, listeners=()):
    scenario = load_scenario("course", [*settings, f"duration={duration}"])
    return Simulation(scenario, seed, listeners).run().state_hash


class Meddler(Listener):
    """A listener that does what it can to what it is given."""

    def on_record(self, record):
        record.truth.qpos[:] = 0.0
        record.truth.robot[:] = 1e3
        record.truth.obstacle_positions[:] = 0.0
        if record.frame is not None:
            record.frame.belief.pose.copy()


def test_same_seed_same_end_whoever_listens():
    assert final_hash(3, STAND_INS, 4.0) == final_hash(3, STAND_INS, 4.0, [Meddler()])


def test_a_log_of_everything_changes_nothing(tmp_path):
    scenario = load_scenario("course", [*STAND_INS, "duration=3.0"])
    simulation = Simulation(scenario, 3)
    size = (scenario.camera.width, scenario.camera.height)
    for level in LogLevel:
        file = tmp_path / f"{level}.rrd"
        log = RerunLog(
            file,
            simulation.model,
            simulation.layout,
            size,
            "test",
            gaze=scenario.navigation.gaze,
            level=level,
        )
        simulation.listeners.append(log)
    assert simulation.run().state_hash == final_hash(3, STAND_INS, 3.0)
    fields = Log([file]).table("/plan/field", "Arrows3D:vectors")
    assert len(fields) >= 5  # what the planner was asked for


def test_another_seed_another_end():
    assert final_hash(3, STAND_INS, 1.0) != final_hash(4, STAND_INS, 1.0)


@pytest.mark.gl
def test_physics_and_pixels_repeat():
    assert final_hash(5, [], 2.0) == final_hash(5, [], 2.0)
