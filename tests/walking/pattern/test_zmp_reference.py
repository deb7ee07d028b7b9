"""ZMP reference: under the support foot, without jumps."""

from itertools import pairwise

import numpy as np
import pytest

from walking.body.sole import Sole
from walking.foothold import Foothold
from walking.footsteps import foothold_kernel
from walking.footsteps.stride import Timing
from walking.parameters import PatternParameters, WalkingParameters
from walking.pattern.ramps import Ramps
from walking.pattern.zmp_reference import ZmpReference

SOLE = Sole(centre=0.01, half_length=0.05, half_width=0.03)
REFERENCE = ZmpReference(WalkingParameters(), SOLE)
LEFT, RIGHT = Foothold(True, 0.0, 0.042, 0.1), Foothold(False, 0.05, -0.042, -0.1)
TIMING = Timing(14, 54, 0.025)


def test_it_turns_with_the_foot():
    x, y = REFERENCE.under(Foothold(True, 0.0, 0.0, 0.0))
    assert REFERENCE.under(Foothold(True, 1.0, 2.0, 1.5707963267948966)) == pytest.approx(
        (1.0 - y, 2.0 + x)
    )


def plan_walk(steps, *, ends, zmp=(0.0, 0.0), left=(0, 30)):
    table = np.array([step.row for step in steps])
    ticks = (*left, TIMING.double, TIMING.single, REFERENCE.stop)
    zmp_offset = REFERENCE.zmp_offset
    return Ramps(foothold_kernel.ramps(RIGHT.row, LEFT.row, table, zmp, ticks, zmp_offset, ends))


@pytest.mark.parametrize("ends", [False, True])
@pytest.mark.parametrize("left", [(0, 30), (5, 54)])
def test_it_goes_from_foot_to_foot_without_jumps(ends, left):
    steps = [RIGHT, Foothold(True, 0.1, 0.042, 0.0), Foothold(False, 0.1, -0.042, 0.0)]
    ramps = plan_walk(steps, ends=ends, zmp=(0.01, 0.02), left=left)
    start = (0.01, 0.02) if left[0] else REFERENCE.under(LEFT)
    assert (ramps[0].ax, ramps[0].ay) == start
    assert all((a.bx, a.by) == (b.ax, b.ay) for a, b in pairwise(ramps))
    end = REFERENCE.between(*steps[1:]) if ends else REFERENCE.under(steps[-1])
    assert (ramps[-1].bx, ramps[-1].by) == end
    rest = (2 if ends else 3) * 68 + (REFERENCE.stop if ends else 0)
    assert sum(r.ticks for r in ramps) == sum(left) + rest
    assert all(r.feet[0] is r.feet[1] for r in ramps if (r.ax, r.ay) == (r.bx, r.by))
    assert all(a.feet[1] == b.feet[0] for a, b in pairwise(ramps))


def test_under_a_foot_it_is_ahead_of_the_ankle_and_inward():
    pattern = PatternParameters(zmp_forward=0.004, zmp_inward=0.003)
    reference = ZmpReference(WalkingParameters(pattern=pattern), SOLE)
    assert reference.under(Foothold(True, 0.0, 0.0, 0.0)) == pytest.approx((0.014, -0.003))


def test_each_step_takes_its_double_and_its_single_support():
    ramps = plan_walk([RIGHT], ends=False)
    assert [r.ticks for r in ramps] == [30, 14, 54]
    assert ramps[0].feet == (LEFT, LEFT)
    assert ramps[1].feet == (LEFT, RIGHT)
    assert ramps.goal == REFERENCE.under(LEFT)
    last = plan_walk([RIGHT], ends=True, zmp=(0.0, 0.01), left=(3, 54))
    assert [r.ticks for r in last] == [3, 54, REFERENCE.stop]
    assert last[0].feet == (RIGHT, LEFT)
    assert last[2].feet == (LEFT, RIGHT)
