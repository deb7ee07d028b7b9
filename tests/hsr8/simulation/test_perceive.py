"""Decisions of a user loop between the halves of a tick, compared with those of plugins."""

from contextlib import ExitStack
from math import nan, sin

import numpy as np
import pytest

from hsr8.errors import UsageError
from hsr8.scenario.loader import load_scenario
from hsr8.simulation.loop import Simulation
from navigation.decision import GazeDecision, MotionDecision

FAST = ['robot.body="kinematic"', 'camera.source="analytic"', "duration=1.5"]


class Scripted:
    """Planner and gaze that follow the clock."""

    def plan(self, belief, task):
        return MotionDecision(velocity=np.array([0.1, 0.02, 0.4 * sin(belief.time)]))

    def choose(self, belief, task, motion):
        return GazeDecision(pan=sin(3.0 * belief.time), tilt=-0.4)


@pytest.fixture
def simulation():
    with ExitStack() as stack:
        yield lambda name="quick", settings=FAST: stack.enter_context(
            Simulation(load_scenario(name, settings), 4)
        )


def frames_of(ticks):
    records = [tick.record for tick in ticks if tick.record is not None]
    return [record.frame for record in records if record.frame is not None]


@pytest.mark.parametrize(
    "settings", [FAST, [*FAST, "camera.latency_ms=30"], FAST[1:]], ids=["fast", "latency", "full"]
)
def test_decisions_of_a_loop_are_those_of_a_plugin(simulation, settings):
    scripted = Scripted()
    native = Simulation(load_scenario("quick", settings), 4, planner=scripted, gaze=scripted)
    with native:
        expected = list(native)
    ticks, driven = [], simulation(settings=settings)
    while driven.exit_reason is None:
        if (situation := driven.perceive()) is not None:
            gaze = scripted.choose(situation.belief, None, None)
            driven.look(gaze.pan, gaze.tilt)
            if situation.motion_due:
                driven.command(*scripted.plan(situation.belief, None).velocity)
        ticks.append(driven.step())
    assert driven.outcome() == native.outcome()
    for ours, theirs in zip(frames_of(ticks), frames_of(expected), strict=True):
        assert (ours.gaze.pan, ours.gaze.tilt) == (theirs.gaze.pan, theirs.gaze.tilt)
        assert np.array_equal(ours.motion.velocity, theirs.motion.velocity)


def test_a_decision_is_replaced_only_while_it_is_pending(simulation):
    driven = simulation()
    with pytest.raises(RuntimeError, match=r"look: the tick has not begun; expected perceive\(\)"):
        driven.look(0.0, 0.0)
    while (situation := driven.perceive()) is None or situation.motion_due:
        if situation is None:
            with pytest.raises(RuntimeError, match="look: no decision is pending"):
                driven.look(0.0, 0.0)
        driven.step()
    with pytest.raises(RuntimeError, match="command: no motion is due"):
        driven.command(0.1, 0.0, 0.0)
    driven.look(0.5, -0.2)
    driven.step()
    with pytest.raises(RuntimeError, match="look: the tick has not begun"):
        driven.look(0.0, 0.0)


def test_values_are_checked(simulation):
    driven = simulation()
    while driven.perceive() is None:
        driven.step()
    with pytest.raises(UsageError, match="look: tilt must be a finite number, got float nan"):
        driven.look(0.0, nan)
    with pytest.raises(UsageError, match="command: wz must be a finite number, got str 'left'"):
        driven.command(0.1, 0.0, "left")


def test_a_walk_takes_no_command(simulation):
    driven = simulation("walk", FAST)
    driven.perceive()
    with pytest.raises(UsageError, match=r"mission\.kind = 'walk'"):
        driven.command(0.1, 0.0, 0.0)
