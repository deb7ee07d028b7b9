"""Report of limited commands."""

import pytest

from walking.command import CommandState, HeadTarget, Limit, VelocityCommand
from walking.engine import WalkingEngine
from walking.parameters import CONTROL_PERIOD, WalkingParameters

AHEAD = HeadTarget()
LIMITS = WalkingParameters().limits
HALF_STANCE = WalkingParameters().gait.half_stance


@pytest.fixture
def engine(robot):
    return WalkingEngine(robot, WalkingParameters())


def walk(engine, body, command, seconds):
    reports = []
    for _ in range(round(seconds / CONTROL_PERIOD)):
        body.apply(engine.step(body.sense(), command, AHEAD))
        reports.append(engine.command_limits)
    return reports


def test_before_settling_zero_is_applied(engine, ideal_body):
    report = walk(engine, ideal_body, VelocityCommand(0.2), 0.1)[-1]
    assert report.limits == (Limit.SETTLING,)
    assert report.applied == VelocityCommand()


@pytest.mark.parametrize(
    ("command", "limit"),
    [
        (VelocityCommand(1.0), Limit.SPEED),
        (VelocityCommand(0.5, 0.15, 1.5), Limit.COMBINED_SPEED),
        (CommandState(forward=0.3), Limit.STEP_LENGTH),
        (CommandState(side=0.4), Limit.STEP_SIDE),
        (CommandState(side=0.02), Limit.CLEARANCE),
        (CommandState(direction=1.5), Limit.STEP_TURN),
        (CommandState(single_support=0.05), Limit.TIMING),
        (CommandState(double_support=2.0), Limit.TIMING),
        (CommandState(swing_height=0.2), Limit.SWING_HEIGHT),
    ],
)
def test_the_binding_limit_is_reported(engine, ideal_body, command, limit):
    report = walk(engine, ideal_body, command, 3.0)[-1]
    assert report.commanded == command
    assert limit in report.limits
    assert report.applied != command


def test_the_applied_command_state_is_within_the_limits(engine, ideal_body):
    applied = walk(engine, ideal_body, CommandState(0.05, 2.0, 0.3, 0.1, 0.0, 0.2), 1.0)[-1].applied
    assert applied.forward == LIMITS.step_forward
    assert applied.single_support == pytest.approx(LIMITS.min_single)
    assert applied.double_support == pytest.approx(LIMITS.max_double)
    assert applied.swing_height == LIMITS.max_swing_height
    wide = walk(engine, ideal_body, CommandState(side=0.4), 1.0)[-1].applied
    assert wide.side == pytest.approx(2.0 * HALF_STANCE + LIMITS.step_side)
