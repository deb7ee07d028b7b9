"""The engine under explicit footsteps that change at any tick."""

from itertools import pairwise

import numpy as np
import pytest

from walking.command import CommandState, HeadTarget, VelocityCommand
from walking.engine import WalkingEngine
from walking.parameters import CONTROL_PERIOD, WalkingParameters
from walking.state import Phase

AHEAD = HeadTarget()
PARAMETERS = WalkingParameters()


def random_state(rng):
    low = (0.18, 0.03, -0.07, 0.07, -0.3, 0.015)
    high = (0.45, 0.15, 0.11, 0.13, 0.3, 0.035)
    return CommandState(*rng.uniform(low, high).tolist())


def walk(engine, body, command_of, seconds):
    steps, positions, count = [], [], 0
    for k in range(round(seconds / CONTROL_PERIOD)):
        targets = engine.step(body.sense(), command_of(k), AHEAD)
        body.apply(targets)
        positions.append(targets.position)
        state = engine.state()
        if state.step_count > count:
            count, landing = state.step_count, state.footsteps[0]
            steps.append((k, state.balance.feet[1 if landing.left else 0], landing))
    return steps, np.array(positions)


def test_footsteps_are_those_of_the_command_state(robot, ideal_body):
    command = CommandState(0.3, 0.1, 0.07, 0.1, 0.0, 0.03)
    engine = WalkingEngine(robot, PARAMETERS)
    steps, _ = walk(engine, ideal_body, lambda _k: command, 5.0)
    for (before, _, _), (now, support, landing) in pairwise(steps[2:]):
        assert now - before == round(0.4 / CONTROL_PERIOD)
        c, s = np.cos(support[3]), np.sin(support[3])
        dx, dy = landing.x - support[0], landing.y - support[1]
        assert c * dx + s * dy == pytest.approx(0.07, abs=5e-3)
        assert abs(c * dy - s * dx) == pytest.approx(0.1, abs=5e-3)


def test_a_new_command_state_at_every_tick_keeps_the_joints_smooth(robot, ideal_body):
    rng = np.random.default_rng(3)
    engine = WalkingEngine(robot, PARAMETERS)
    steps, positions = walk(engine, ideal_body, lambda _k: random_state(rng), 12.0)
    assert len(steps) > 15
    assert (positions >= robot.lower - 1e-9).all()
    assert (positions <= robot.upper + 1e-9).all()
    assert np.abs(np.diff(positions, axis=0)).max() / CONTROL_PERIOD < 25.0


def test_a_velocity_may_follow_a_command_state_and_stop_it(robot, ideal_body):
    def command(k):
        return CommandState(forward=0.06) if k < 500 else VelocityCommand()

    engine = WalkingEngine(robot, PARAMETERS)
    steps, _ = walk(engine, ideal_body, command, 5.0)
    assert steps[-1][0] > 500
    assert engine.state().phase is Phase.STANDING
