"""The engine under explicit footsteps that change at any tick."""

from itertools import pairwise

import numpy as np
import pytest

from walking.command import CommandState, HeadTarget, VelocityCommand
from walking.engine import WalkingEngine
from walking.foothold import Foothold
from walking.footsteps.planner import FootstepPlanner
from walking.footsteps.stride import Strides, Timing
from walking.gait.gait import Gait
from walking.gait.swing_foot_kernel import HEIGHT
from walking.parameters import CONTROL_PERIOD, WalkingParameters
from walking.phase import Phase

AHEAD = HeadTarget()
PARAMETERS = WalkingParameters()


def random_state(rng):
    low = (0.18, 0.03, -0.07, 0.07, -0.3, 0.015)
    high = (0.45, 0.15, 0.11, 0.13, 0.3, 0.035)
    return CommandState(*rng.uniform(low, high).tolist())


def walk(engine, body, command_of, seconds):
    steps, positions = [], []
    for k in range(round(seconds / CONTROL_PERIOD)):
        before = engine._gait.completed
        targets = engine.step(body.sense(), command_of(k), AHEAD)
        body.apply(targets)
        positions.append(targets.position)
        if engine._gait.completed > before:
            gait = engine._gait
            steps.append((k, gait.footholds[1 - gait.support], gait.footholds[gait.support]))
    return steps, np.array(positions)


def test_footsteps_are_those_of_the_command_state(robot, ideal_body):
    command = CommandState(0.3, 0.1, 0.07, 0.1, 0.0, 0.03)
    engine = WalkingEngine(robot, PARAMETERS)
    steps, _ = walk(engine, ideal_body, lambda _k: command, 5.0)
    for (before, _, _), (now, support, landing) in pairwise(steps[2:]):
        assert now - before == round(0.4 / CONTROL_PERIOD)
        c, s = np.cos(support.yaw), np.sin(support.yaw)
        dx, dy = landing.x - support.x, landing.y - support.y
        assert c * dx + s * dy == pytest.approx(0.07, abs=5e-3)
        assert abs(c * dy - s * dx) == pytest.approx(0.1, abs=5e-3)


def test_a_direction_turns_every_footstep(robot, ideal_body):
    engine = WalkingEngine(robot, PARAMETERS)
    steps, _ = walk(engine, ideal_body, lambda _k: CommandState(direction=0.15), 5.0)
    turns = [landing.yaw - support.yaw for _, support, landing in steps[2:]]
    assert turns == pytest.approx([0.15] * len(turns), abs=0.03)


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


def test_mirrored_command_states_give_mirrored_footsteps(robot):
    planner = FootstepPlanner(PARAMETERS.gait, PARAMETERS.limits, robot.sole)
    strides, _ = planner.explicit(CommandState(forward=0.05, direction=0.2), 0.0)
    other, _ = planner.explicit(CommandState(forward=0.05, direction=-0.2), 0.0)
    x, y, turned = strides.left
    assert other.right == pytest.approx((x, -y, -turned))


@pytest.mark.parametrize("forward", [-0.05, 0.1])
@pytest.mark.parametrize("direction", [-0.1, 0.0, 0.1])
def test_strides_and_timing_are_read_back_as_the_command_state(robot, forward, direction):
    planner = FootstepPlanner(PARAMETERS.gait, PARAMETERS.limits, robot.sole)
    command = CommandState(0.3, 0.1, forward, 0.13, direction, 0.02)
    strides, bound = planner.explicit(command, 0.0)
    timing, late = planner.timing(command)
    assert not bound
    assert not late
    read = planner.command_state(strides, timing)
    for name in ("single_support", "double_support", "forward", "side", "direction"):
        assert getattr(read, name) == pytest.approx(getattr(command, name))


@pytest.fixture
def gait(robot):
    planner = FootstepPlanner(PARAMETERS.gait, PARAMETERS.limits, robot.sole)
    h = PARAMETERS.gait.half_stance
    gait = Gait(PARAMETERS, planner, (Foothold(True, 0.0, h, 0.0), Foothold(False, 0.0, -h, 0.0)))
    gait.start(0)
    return gait


def tick(gait):
    still = Strides(right=(0.0, -0.084, 0.0), left=(0.0, 0.084, 0.0))
    gait.plan(gait.landing, still, moving=True)
    gait.advance(moving=True)


@pytest.mark.parametrize("single", [40, 90])
@pytest.mark.parametrize("phase", [0.1, 0.4, 0.7])
def test_single_support_stretched_or_cut_in_mid_swing_keeps_the_foot_smooth(gait, single, phase):
    while gait.swing_phase < phase:
        tick(gait)
    heights, held = [float(gait.feet[1, HEIGHT])], gait.swing_phase
    gait.retime(Timing(14, single, 0.025))
    assert gait.swing_phase == held
    while gait.completed == 0:
        tick(gait)
        heights.append(float(gait.feet[1, HEIGHT]))
    assert np.abs(np.diff(heights)).max() < 0.008
    assert heights[-1] == 0.0


def test_a_frozen_landing_keeps_its_time(gait):
    while gait.swing_phase < 0.85:
        tick(gait)
    left = gait.ticks_left
    assert not gait.retime(Timing(14, 100, 0.025))
    assert gait.ticks_left == left


def test_a_double_support_under_way_changes_its_length(gait):
    while gait.completed == 0:
        tick(gait)
    for _ in range(5):
        tick(gait)
    weight, origin = gait.right_weight, gait.zmp
    assert gait.retime(Timing(30, 54, 0.025))
    assert gait.right_weight == pytest.approx(weight)
    assert gait.zmp == pytest.approx(origin)
    for _ in range(25):
        assert gait.double
        tick(gait)
    assert not gait.double
