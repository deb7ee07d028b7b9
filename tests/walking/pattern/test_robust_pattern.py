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
from walking.pattern.dcm_pattern import DcmGenerator, dcm_reference
from walking.pattern.lipm import Lipm
from walking.pattern.pendulum import PendulumState
from walking.pattern.ramps import ZmpRamp
from walking.pattern.robust_pattern import RobustGenerator
from walking.pattern.support import support_region

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


def test_an_infeasible_landing_is_rejected_and_the_last_plan_continued():
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


def test_after_a_push_the_dcm_error_is_reported_and_the_zmp_stays_in_the_sole():
    steps = feet(0.05)
    state = walking(steps)
    state.vx += 1.5
    generator = RobustGenerator(LIPM, PARAMETERS, SOLE)
    path = run(generator, state, [steps] * 30)
    assert not path[0][0]
    assert inside(path)
    own = state.x + state.vx / LIPM.omega
    assert generator.planned_dcm(state, reference(steps, 24))[0] < own - 0.05


def test_zmp_is_in_the_support_polygon_between_ticks_with_a_new_command_in_each(
    robot, ideal_body, monkeypatch
):
    """Both ends of a tick's segment are in the polygon of that tick, so all of it is."""
    engine = WalkingEngine(robot, WalkingParameters(pattern=PARAMETERS))
    unplanned = []  # ticks without a plan: about one in 30,000
    track = DcmGenerator.advance
    monkeypatch.setattr(
        DcmGenerator, "advance", lambda self, *rest: (unplanned.append(1), track(self, *rest))[1]
    )
    rng = np.random.default_rng(17)
    before, changed = None, 0
    for k in range(2400):
        command = VelocityCommand(*rng.uniform((-0.2, -0.1, -1.0), (0.3, 0.1, 1.0)).tolist())
        if k % 3 == 0:
            low, high = (0.18, 0.05, -0.07, 0.07, -0.3), (0.4, 0.12, 0.11, 0.12, 0.3)
            command = CommandState(*rng.uniform(low, high).tolist())
        ideal_body.apply(engine.step(ideal_body.sense(), command, HeadTarget()))
        state = engine.state()
        assert state.balance.zmp_depth > PARAMETERS.sole_margin - 1e-9
        if before is not None:
            # The previous ZMP, moved with the support foot as odometry measures it.
            support = 0 if state.footsteps[0].left else 1
            (x, y, _, yaw), (u, v, _, was) = (s.balance.feet[support] for s in (state, before))
            turn = np.exp(1j * (yaw - was))
            start = complex(x, y) + turn * (complex(*before.zmp) - complex(u, v))
            equations = ConvexHull(state.balance.support).equations
            outside = (equations[:, :2] @ [start.real, start.imag] + equations[:, 2]).max()
            assert outside < -PARAMETERS.sole_margin + 1e-9
        before = state
        changed += engine.command_limits.limited
    assert state.step_count > 20
    assert changed > 1000
    assert len(unplanned) <= 1
