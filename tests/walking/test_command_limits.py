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


def test_acceleration_binds_until_the_speed_is_reached(engine, ideal_body):
    command = VelocityCommand(0.2)
    reports = walk(engine, ideal_body, command, 2.0)
    assert any(Limit.ACCELERATION in r.limits and r.applied.vx < 0.2 for r in reports)
    assert not any(Limit.ACCELERATION in r.limits for r in reports[-50:])
    assert any(not r.limited and r.applied == command for r in reports[-50:])


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


def test_a_footstep_within_all_limits_is_applied_as_commanded(engine, ideal_body):
    command = CommandState(0.3, 0.08, 0.06, 0.09, 0.05, 0.02)
    reports = walk(engine, ideal_body, command, 3.0)
    assert sum(not r.limited for r in reports) > 100
    assert all(r.applied == command for r in reports if not r.limited)


def test_nothing_is_altered_by_standing_until_the_body_has_settled(engine, ideal_body):
    assert not any(r.limited for r in walk(engine, ideal_body, VelocityCommand(), 1.0))


def test_a_frozen_landing_is_reported(engine, ideal_body):
    walk(engine, ideal_body, VelocityCommand(0.1), 2.0)
    frozen = 0
    for k in range(200):
        step = CommandState(forward=0.06 * (k % 2))
        frozen += Limit.LANDING_FROZEN in walk(engine, ideal_body, step, CONTROL_PERIOD)[0].limits
    assert 10 < frozen < 150
    assert engine.state().command_limits == engine.command_limits
