"""The closed loop: full physics and rendering once, else the fast stand-ins."""

import numpy as np
import pytest

from hsr8.scenario.loader import load_scenario
from hsr8.simulation.loop import Simulation

STAND_INS = ['robot.body="kinematic"', 'camera.source="analytic"']


def wrap(angle):
    return np.angle(np.exp(1j * angle))


@pytest.mark.gl
def test_quick_in_full_physics_through_the_camera(simulate):
    outcome, recorded, simulation = simulate("quick", body="full", camera="rendered", seed=2)
    assert outcome.exit_reason == "goal"
    assert not any(r.truth.fallen for r in recorded.records)
    end = recorded.records[-1].truth
    assert np.hypot(*(end.robot[:2] - simulation.layout.waypoints[-1])) < 0.15
    assert abs(wrap(end.robot[2] - simulation.layout.goal_heading)) < np.radians(15)
    errors = [
        f.belief.pose[:2] - r.truth.robot[:2]
        for r in recorded.records
        if (f := r.frame) is not None
    ]
    assert np.sqrt(np.mean(np.sum(np.square(errors), axis=1))) < 0.05
    assert all(f.image is not None and f.image.shape == (240, 320, 3) for f in recorded.frames)


def test_the_paper_profile_runs_too(simulate):
    outcome, recorded, _ = simulate("quick", 'navigation.profile="paper"', duration=6.0)
    assert outcome.exit_reason in {"timeout", "goal"}
    first, last = recorded.records[0].truth.robot, recorded.records[-1].truth.robot
    assert np.hypot(*(last - first)[:2]) > 0.3


@pytest.mark.parametrize(
    ("scenario", "reason"), [("course", "timeout"), ("paper", "completed")], ids=["course", "tour"]
)
def test_records_and_frames_keep_their_periods_until_the_end(simulate, scenario, reason):
    outcome, recorded, _ = simulate(scenario, duration=2.0)
    assert outcome.exit_reason == reason
    assert outcome.time == pytest.approx(2.0, abs=0.01)
    assert np.allclose(np.diff([r.time for r in recorded.records]), 0.02)
    assert np.allclose(np.diff([f.time for f in recorded.frames]), 0.06)


def test_an_interrupted_run_ends_at_once():
    with Simulation(load_scenario("quick", STAND_INS), 0) as simulation:
        for tick in simulation:
            if tick.time >= 0.5:
                simulation.interrupt()
    outcome = simulation.outcome()
    assert outcome.exit_reason == "interrupted"
    assert np.isclose(outcome.time, 0.5, atol=0.03)
