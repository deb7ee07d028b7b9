"""Robust plans of the ZMP: inside the soles between ticks, too, and under any command."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from walking.body.sole import Sole
from walking.command import CommandState, HeadTarget, VelocityCommand
from walking.engine import WalkingEngine
from walking.foothold import Foothold
from walking.parameters import CONTROL_PERIOD, PatternParameters, WalkingParameters
from walking.pattern.dcm_pattern import dcm_reference
from walking.pattern.lipm import Lipm
from walking.pattern.pendulum import PendulumState
from walking.pattern.ramps import ZmpRamp
from walking.pattern.robust_pattern import RobustGenerator
from walking.pattern.support import support_region
from walking.phase import Phase

LIPM = Lipm(0.19)
SOLE = Sole(centre=0.01, half_length=0.0525, half_width=0.03)
PARAMETERS = PatternParameters(generator="robust")


def feet(stride, side=1.0):
    steps = []
    for k in range(6):
        left = (k % 2 == 0) == (side > 0)
        steps.append(Foothold(left, k * stride, 0.042 if left else -0.042, 0.0))
    return steps


def reference(steps, left):
    points = [(f.x + 0.01, f.y) for f in steps]
    ramps = [ZmpRamp(left, *points[0], *points[0], (steps[0], steps[0]))]
    for k in range(1, len(steps)):
        ramps.append(ZmpRamp(14, *points[k - 1], *points[k], (steps[k - 1], steps[k])))
        ramps.append(ZmpRamp(54, *points[k], *points[k], (steps[k], steps[k])))
    return ramps


def walking(steps):
    x, y = dcm_reference(LIPM, reference(steps, 54))
    w = LIPM.omega
    return PendulumState(-0.02, 0.042, w * (x + 0.02), w * (y - 0.042), 0.01, 0.042)


def run(generator, state, plans):
    path = []
    for k, steps in enumerate(plans):
        ramps = reference(steps, 54 - k)
        region = support_region(SOLE, steps[0], steps[0], 0.005)
        admitted = generator.admits(state, ramps, region)
        generator.advance(state, ramps, region)
        path.append((admitted, state.zmp_x, state.zmp_y))
    return path


def inside(path):
    region = support_region(SOLE, feet(0.0)[0], feet(0.0)[0], 0.005)
    return all(region.clip(x, y) == pytest.approx((x, y), abs=1e-12) for _, x, y in path)


def test_on_the_reference_the_plan_is_the_reference():
    steps = feet(0.05)
    path = run(RobustGenerator(LIPM, PARAMETERS, SOLE), walking(steps), [steps] * 53)
    np.testing.assert_allclose([row[1:] for row in path], [[0.01, 0.042]] * 53, atol=1e-9)


@pytest.mark.parametrize("tick", [0, 20, 35])
def test_a_new_landing_is_walked_to_exactly(tick):
    before, after = feet(0.05), feet(0.07)
    state = walking(before)
    plans = [before] * tick + [after] * (54 - tick)
    path = run(RobustGenerator(LIPM, PARAMETERS, SOLE), state, plans)
    assert all(row[0] for row in path)
    assert inside(path)
    rates = np.abs(np.diff([row[1:] for row in path], axis=0)) / CONTROL_PERIOD
    assert rates.max() < PARAMETERS.zmp_rate + 1e-9


def test_an_infeasible_landing_is_turned_down_and_the_last_plan_walked_on():
    before, after = feet(0.05), feet(0.15)
    state = walking(before)
    state.vx += 0.02
    generator = RobustGenerator(LIPM, PARAMETERS, SOLE)
    other = RobustGenerator(LIPM, PARAMETERS, SOLE)
    alone = replace(state)
    run(generator, state, [before] * 40)
    kept = run(other, alone, [before] * 48)
    late = reference(after, 14)
    region = support_region(SOLE, before[0], before[0], 0.005)
    assert not generator.admits(state, late, region)
    for k in range(40, 48):
        ramps = reference(before, 54 - k)
        generator.advance(state, ramps, region)
    assert (state.zmp_x, state.zmp_y) == pytest.approx(kept[-1][1:], abs=1e-9)


def test_what_a_forced_plan_misses_is_told_and_the_zmp_stays_in_the_sole():
    steps = feet(0.05)
    state = walking(steps)
    state.vx += 1.5
    generator = RobustGenerator(LIPM, PARAMETERS, SOLE)
    path = run(generator, state, [steps] * 30)
    assert not path[0][0]
    assert inside(path)
    own = state.x + state.vx / LIPM.omega
    assert generator.planned_dcm(state, reference(steps, 24))[0] < own - 0.05


def test_it_mirrors():
    ends = []
    for side in (1.0, -1.0):
        steps = feet(0.05, side)
        state = PendulumState(0.0, side * 0.03, 0.3, -side * 0.1, 0.01, side * 0.042)
        run_one = RobustGenerator(LIPM, PARAMETERS, SOLE)
        for k in range(30):
            ramps = reference(steps, 54 - k)
            region = support_region(SOLE, steps[0], steps[0], 0.005)
            run_one.advance(state, ramps, region)
        ends.append((state.x, side * state.y, state.zmp_x, side * state.zmp_y))
    assert ends[0] == pytest.approx(ends[1], abs=1e-9)


def hull(robot, placed, margin):
    sole = robot.sole
    corners = np.array([[1, 1], [1, -1], [-1, -1], [-1, 1]], float)
    corners = corners * [sole.half_length - margin, sole.half_width - margin] + [sole.centre, 0.0]
    points = []
    for foot in placed:
        c, s = np.cos(foot.yaw), np.sin(foot.yaw)
        points.append(corners @ np.array([[c, s], [-s, c]]) + [foot.x, foot.y])
    return ConvexHull(np.concatenate(points)).equations


def test_the_zmp_is_in_the_support_polygon_between_ticks_with_a_new_command_in_each(
    robot, ideal_body
):
    """Both ends of a tick's segment are in the polygon of that tick, so all of it is."""
    engine = WalkingEngine(robot, WalkingParameters(pattern=PARAMETERS))
    rng = np.random.default_rng(17)
    before, lost, changed = None, 0, 0
    for k in range(2400):
        gait = engine._gait
        command = VelocityCommand(*rng.uniform((-0.2, -0.1, -1.0), (0.3, 0.1, 1.0)).tolist())
        if k % 3 == 0:
            low, high = (0.18, 0.05, -0.07, 0.07, -0.3), (0.4, 0.12, 0.11, 0.12, 0.3)
            command = CommandState(*rng.uniform(low, high).tolist())
        start = (engine._pendulum.zmp_x, engine._pendulum.zmp_y)
        was = (gait.stepping, gait.support, tuple(gait.footholds), gait._tick)
        ideal_body.apply(engine.step(ideal_body.sense(), command, HeadTarget()))
        end = (engine._pendulum.zmp_x, engine._pendulum.zmp_y)
        if was[0] and before is not None:
            support = was[2][was[1]]
            double = was[3] < gait._shift.end if gait._tick else was[3] < before
            equations = hull(robot, was[2] if double else (support,), PARAMETERS.sole_margin)
            for point in (start, end):
                assert (equations[:, :2] @ point + equations[:, 2]).max() < 1e-9
        before = gait._shift.end
        lost += engine._placement._generator._plan is None
        changed += engine.command_limits.limited
    assert engine.state().step_count > 20
    assert lost == 0
    assert changed > 1000


def test_it_starts_walks_and_stops(robot, ideal_body):
    engine = WalkingEngine(robot, WalkingParameters(pattern=PARAMETERS))
    for k in range(1000):
        command = VelocityCommand(0.2, 0.0, 0.3) if k < 500 else VelocityCommand()
        ideal_body.apply(engine.step(ideal_body.sense(), command, HeadTarget()))
        assert engine._placement._generator._plan is not None
    assert engine.state().phase is Phase.STANDING
    p = engine._pendulum
    assert np.hypot(p.vx, p.vy) < 2e-3
