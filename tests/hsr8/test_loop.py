import numpy as np
import pytest

from hsr8.decisions import GazeController, MotionPlanner
from hsr8.errors import RenderingUnavailable
from hsr8.loop import Simulation
from hsr8.scenario.loader import load_scenario
from navigation.decision import GazeDecision, MotionDecision

STAND_INS = ['robot.body="kinematic"', 'camera.source="analytic"']


def quick(duration=1.0):
    return load_scenario("quick", [*STAND_INS, f"duration={duration}"])


class Spin:
    """Motion planner that turns in place."""

    def plan(self, belief, task):
        return MotionDecision(velocity=np.array([0.0, 0.0, 0.8]))


class Stare:
    """Gaze planner that looks to the left."""

    def choose(self, belief, task, motion):
        return GazeDecision(pan=0.7, tilt=-0.2)


def test_tick_by_tick_is_the_same_run():
    at_once = Simulation(quick(), 4).run()
    with Simulation(quick(), 4) as simulation:
        ticks = list(simulation)
    assert simulation.outcome() == at_once
    assert [tick.number for tick in ticks] == list(range(201))
    records = [tick.record for tick in ticks if tick.record is not None]
    assert [record.tick for record in records] == list(range(0, 201, 4))
    assert [second.tick for tick in ticks for second in tick.seconds] == [0, 200, 201]
    assert all(np.isfinite(tick.setpoint).all() for tick in ticks)


def test_a_run_left_early_has_an_exit_reason(monkeypatch):
    with Simulation(quick(), 4) as simulation:
        simulation.step()
    assert simulation.exit_reason == "interrupted"
    simulation = Simulation(quick(), 4)
    with pytest.raises(ZeroDivisionError), simulation:
        raise ZeroDivisionError
    assert simulation.exit_reason == "error"

    def none(*_):
        raise RenderingUnavailable("no OpenGL")

    monkeypatch.setattr("hsr8.loop.RenderedCamera", none)
    simulation = Simulation(load_scenario("quick"), 4)
    with pytest.raises(RenderingUnavailable):
        simulation.run()
    assert simulation.exit_reason == "error"


def test_steps_outside_a_run_are_an_error():
    simulation = Simulation(quick(0.05), 4)
    with pytest.raises(RuntimeError, match="with simulation"):
        simulation.step()
    with pytest.raises(RuntimeError, match="has not ended"):
        simulation.outcome()
    simulation.run()
    with pytest.raises(RuntimeError, match="has ended"):
        simulation.step()


def test_a_given_planner_and_gaze_replace_those_of_the_scenario():
    spin: MotionPlanner = Spin()
    stare: GazeController = Stare()
    record = None
    with Simulation(quick(4.0), 4, planner=spin, gaze=stare) as simulation:
        for tick in simulation:
            record = tick.record or record
    assert record.head.pan == 0.7
    assert record.command.velocity == (0.0, 0.0, 0.8)
    assert np.hypot(*(record.truth.robot[:2] - simulation.layout.start[:2])) < 0.15
    assert abs(record.truth.robot[2] - simulation.layout.start[2]) > 1.0
