"""Footholds of a walk, and the ZMP reference under them."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from walking.data import Plan
from walking.parameters import PatternParameters, WalkingParameters
from walking.plan.footsteps import STILL, Foothold, foothold, is_parallel, landing_of, put
from walking.plan.gait import scheduled_zmp, stand, start, zmp_between, zmp_under
from walking.plan.reference import is_single, plan_walk
from walking.plan.timing import put_timing

LEFT, RIGHT = Foothold(True, 0.0, 0.042, 0.1), Foothold(False, 0.05, -0.042, -0.1)
DOUBLE, SINGLE, STOP = 14, 54, 60


def planned(model, tick, landing, strides, *, moving, support=LEFT, swing=RIGHT):
    """Plan from a tick of the first footstep on, with given landing, strides and timing."""
    plan = np.zeros(1, Plan)[0]
    gait, first = plan.gait, 0 if support.left else 1
    put(gait.footholds[first], support)
    put(gait.footholds[1 - first], swing)
    put_timing(gait.clock.timing, (DOUBLE, SINGLE, 0.02))
    stand(gait, model.robot)
    start(gait, first, True, model.robot)
    gait.tick = tick
    plan_walk(plan, landing, strides, moving, model.robot)
    return plan


@given(st.integers(0, 10**6), st.booleans())
def test_each_foothold_is_the_stride_of_the_one_before(model, strides_of, seed, moving):
    rng = np.random.default_rng(seed)
    support = Foothold(bool(rng.integers(2)), *rng.uniform(-1.0, 1.0, 3).tolist())
    velocity = tuple((rng.uniform(-1.0, 1.0, 3) * (0.4, 0.15, 1.5)).tolist())
    strides = strides_of(STILL if seed % 3 == 0 else velocity)
    landing = landing_of(support, strides)
    swing = Foothold(not support.left, 0.0, 0.0, 0.0)
    plan = planned(model, 0, landing, strides, moving=moving, support=support, swing=swing)
    feet = [support, *map(foothold, plan.steps[: plan.step_count])]
    assert feet[1] == landing
    for before, after in pairwise(feet[1:]):
        assert after == landing_of(before, strides)
    if plan.step_count < 4:
        assert not moving
        assert is_parallel(*feet[-2:], model.robot)


def test_the_zmp_turns_with_the_foot_and_is_ahead_of_the_ankle_and_inward(robot, make_model):
    pattern = PatternParameters(zmp_forward=0.004, zmp_inward=0.003)
    model = make_model(parameters=WalkingParameters(pattern=pattern))
    x, y = zmp_under(Foothold(True, 0.0, 0.0, 0.0), model.robot)
    assert (x, y) == pytest.approx((robot.support.centre + 0.004, -0.003))
    turned = zmp_under(Foothold(True, 1.0, 2.0, 0.5 * np.pi), model.robot)
    assert turned == pytest.approx((1.0 - y, 2.0 + x))


@pytest.mark.parametrize("moving", [True, False])
@pytest.mark.parametrize(("tick", "left"), [(DOUBLE + 24, (30,)), (DOUBLE - 5, (5, SINGLE))])
def test_it_goes_from_foot_to_foot_without_jumps(model, strides_of, moving, tick, left):
    robot, strides = model.robot, strides_of(STILL)
    plan = planned(
        model, tick, landing_of(LEFT, strides_of((0.1, 0.0, 0.0))), strides, moving=moving
    )
    ramps, count = plan.ramps[: plan.ramp_count], int(plan.step_count)
    steps = [LEFT, *map(foothold, plan.steps[:count])]
    now = scheduled_zmp(plan.gait, robot) if len(left) == 2 else zmp_under(LEFT, robot)
    assert (ramps[0].ax, ramps[0].ay) == now
    assert all((a.bx, a.by) == (b.ax, b.ay) for a, b in pairwise(ramps))
    assert count == (4 if moving else 2)
    end = zmp_under(steps[-1], robot) if moving else zmp_between(*steps[-2:], robot)
    assert (ramps[-1].bx, ramps[-1].by) == end
    rest = [STOP] if not moving else [DOUBLE, SINGLE]
    assert ramps["ticks"].tolist() == [*left, *[DOUBLE, SINGLE] * (count - 1), *rest]
    assert all(is_single(r) for r in ramps if (r.ax, r.ay) == (r.bx, r.by))
    assert all(foothold(a.loading) == foothold(b.unloading) for a, b in pairwise(ramps))


def test_standing_the_zmp_goes_between_the_feet(model, make_walk, strides_of):
    plan = make_walk((LEFT, RIGHT)).plan
    plan.gait.tick -= 3
    plan_walk(plan, RIGHT, strides_of(STILL), False, model.robot)
    (ramp,) = plan.ramps[: plan.ramp_count]
    assert ramp.ticks == 3
    assert (ramp.bx, ramp.by) == zmp_between(LEFT, RIGHT, model.robot)
    assert plan.step_count == 0
