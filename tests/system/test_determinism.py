"""A run depends on scenario and seed alone."""

import pytest

from hsr8.loop import Simulation
from hsr8.scenario.loader import load

STAND_INS = ['robot.body="kinematic"', 'camera.source="analytic"']


def final_hash(seed, settings, duration, listeners=()):
    scenario = load("course", [*settings, f"duration={duration}"])
    return Simulation(scenario, seed, listeners).run().state_hash


class Meddler:
    """A listener that does what it can to what it is given."""

    def on_record(self, record):
        record.truth.qpos[:] = 0.0
        record.truth.robot[:] = 1e3
        record.truth.obstacle_positions[:] = 0.0
        if record.frame is not None:
            record.frame.belief.pose.copy()

    def on_event(self, time, kind, text):
        pass

    def close(self, exit_reason):
        pass


def test_same_seed_same_end_whoever_listens():
    assert final_hash(3, STAND_INS, 4.0) == final_hash(3, STAND_INS, 4.0, [Meddler()])


def test_another_seed_another_end():
    assert final_hash(3, STAND_INS, 1.0) != final_hash(4, STAND_INS, 1.0)


@pytest.mark.gl
def test_physics_and_pixels_repeat():
    assert final_hash(5, [], 2.0) == final_hash(5, [], 2.0)
