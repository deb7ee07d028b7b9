"""Footholds of a walk, and the ZMP reference under them."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from walking.foothold import Foothold, foothold, put
from walking.footsteps import STILL, is_parallel, landing_of
from walking.parameters import PatternParameters, WalkingParameters
from walking.records import FOOTHOLD, RAMP
from walking.reference import (
    chain_footholds,
    is_single,
    reference_ramps,
    zmp_between,
    zmp_under,
)

LEFT, RIGHT = Foothold(True, 0.0, 0.042, 0.1), Foothold(False, 0.05, -0.042, -0.1)
STEPS = (RIGHT, Foothold(True, 0.1, 0.042, 0.0), Foothold(False, 0.1, -0.042, 0.0))
DOUBLE, SINGLE, STOP = 14, 54, 60


@given(st.integers(0, 10**6), st.booleans())
def test_each_foothold_is_the_stride_of_the_one_before(model, strides_of, seed, moving):
    rng = np.random.default_rng(seed)
    support = Foothold(bool(rng.integers(2)), *rng.uniform(-1.0, 1.0, 3).tolist())
    velocity = tuple((rng.uniform(-1.0, 1.0, 3) * (0.4, 0.15, 1.5)).tolist())
    strides, steps = strides_of(STILL if seed % 3 == 0 else velocity), np.zeros(4, FOOTHOLD)
    landing = landing_of(support, strides)
    count, ends = chain_footholds(steps, support, landing, strides, moving, model.robot)
    feet = [support, *map(foothold, steps[:count])]
    assert feet[1] == landing
    for before, after in pairwise(feet[1:]):
        assert after == landing_of(before, strides)
    assert ends == (not moving and count < 4)
    if ends:
        assert is_parallel(*feet[-2:], model.robot)


def test_the_zmp_turns_with_the_foot_and_is_ahead_of_the_ankle_and_inward(robot, make_model):
    pattern = PatternParameters(zmp_forward=0.004, zmp_inward=0.003)
    model = make_model(parameters=WalkingParameters(pattern=pattern))
    x, y = zmp_under(Foothold(True, 0.0, 0.0, 0.0), model.robot)
    assert (x, y) == pytest.approx((robot.support.centre + 0.004, -0.003))
    turned = zmp_under(Foothold(True, 1.0, 2.0, 0.5 * np.pi), model.robot)
    assert turned == pytest.approx((1.0 - y, 2.0 + x))


def reference(model, steps, *, ends, zmp=(0.0, 0.0), left=(0, 30)):
    records, ramps = np.zeros(4, FOOTHOLD), np.zeros(10, RAMP)
    for record, step in zip(records, steps, strict=False):
        put(record, step)
    ticks = (*left, DOUBLE, SINGLE, STOP)
    rest = (records, len(steps), ends, zmp, ticks, model.robot)
    return ramps[: reference_ramps(ramps, RIGHT, LEFT, *rest)]


@pytest.mark.parametrize("ends", [False, True])
@pytest.mark.parametrize("left", [(0, 30), (5, 54)])
def test_it_goes_from_foot_to_foot_without_jumps(model, ends, left):
    ramps = reference(model, STEPS, ends=ends, zmp=(0.01, 0.02), left=left)
    under = zmp_under(LEFT, model.robot)
    assert (ramps[0].ax, ramps[0].ay) == ((0.01, 0.02) if left[0] else under)
    assert all((a.bx, a.by) == (b.ax, b.ay) for a, b in pairwise(ramps))
    end = zmp_under(STEPS[-1], model.robot)
    if ends:
        end = zmp_between(*STEPS[1:], model.robot)
    assert (ramps[-1].bx, ramps[-1].by) == end
    rest = 2 * (DOUBLE + SINGLE) + STOP if ends else 3 * (DOUBLE + SINGLE)
    assert ramps["ticks"].sum() == sum(left) + rest
    assert all(is_single(r) for r in ramps if (r.ax, r.ay) == (r.bx, r.by))
    assert all(foothold(a.loading) == foothold(b.unloading) for a, b in pairwise(ramps))


def test_each_step_takes_its_double_and_its_single_support(model):
    ramps = reference(model, [RIGHT], ends=False)
    assert ramps["ticks"].tolist() == [30, DOUBLE, SINGLE]
    assert [foothold(ramps[1].unloading), foothold(ramps[1].loading)] == [LEFT, RIGHT]
    last = reference(model, [RIGHT], ends=True, zmp=(0.0, 0.01), left=(3, 54))
    assert last["ticks"].tolist() == [3, 54, STOP]
    assert [foothold(last[0].unloading), foothold(last[0].loading)] == [RIGHT, LEFT]
