"""Footholds chained and made a reference, against the same in plain Python."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from walking.body.sole import Sole
from walking.foothold import Foothold
from walking.footsteps import foothold_kernel
from walking.footsteps.planner import YAW_TOLERANCE, FootstepPlanner
from walking.footsteps.stride import STILL
from walking.parameters import WalkingParameters

PARAMETERS = WalkingParameters()
SOLE = Sole(centre=0.01, half_length=0.05, half_width=0.03)
PLANNER = FootstepPlanner(PARAMETERS.gait, PARAMETERS.limits, SOLE)
ZMP_OFFSET = (0.01, 0.003)


def draw(seed):
    """A stance, strides, and the footholds to come."""
    rng = np.random.default_rng(seed)
    left = bool(rng.integers(2))
    support = Foothold(left, *rng.uniform(-1.0, 1.0, 3).tolist())
    velocity = tuple((rng.uniform(-1.0, 1.0, 3) * (0.4, 0.15, 1.5)).tolist())
    strides = PLANNER.strides(STILL if seed % 3 == 0 else velocity, 0.34)
    landing = PLANNER.landing(support, strides)
    return rng, support, landing, strides


def arguments(support, landing, strides, moving):
    wish, still, _, most = PLANNER.chain(strides)
    assert (wish, most) == ((strides.right, strides.left), 4)
    return support.row, landing.row, (wish, still, (0.001, YAW_TOLERANCE), 4), moving


@given(st.integers(0, 10**6), st.booleans())
def test_each_foothold_is_the_stride_of_the_one_before(seed, moving):
    _, support, landing, strides = draw(seed)
    steps, ends = foothold_kernel.sequence(*arguments(support, landing, strides, moving))
    feet = [support, *map(Foothold.from_row, steps.tolist())]
    assert feet[1] == landing
    for before, after in pairwise(feet[1:]):
        expected = PLANNER.landing(before, strides)
        assert after.left is expected.left
        assert after.row == pytest.approx(expected.row, abs=1e-12)
    assert ends == (not moving and len(steps) < 4)
    if ends:
        assert PLANNER.parallel(*feet[-2:])


@settings(max_examples=20)
@given(st.integers(0, 10**6), st.booleans())
def test_compiled_they_are_what_they_say(plainly, seed, ends):
    rng, support, landing, strides = draw(seed)
    arguments = arguments(support, landing, strides, not ends)
    steps, over = foothold_kernel.sequence(*arguments)
    plain, plainly_over = plainly(foothold_kernel, "sequence", *arguments)
    np.testing.assert_array_equal(steps, plain)
    assert over == plainly_over
    swing = Foothold(not support.left, *rng.uniform(-1.0, 1.0, 3).tolist())
    arguments = (
        swing.row,
        support.row,
        steps,
        (0.1, 0.2),
        (int(seed % 2), 30, 10, 58, 60),
        ZMP_OFFSET,
        over,
    )
    result = foothold_kernel.ramps(*arguments)
    np.testing.assert_array_equal(result, plainly(foothold_kernel, "ramps", *arguments))
    chain = arguments(support, landing, strides, not ends)[1:]
    both = foothold_kernel.plan_walk(swing.row, support.row, *chain, (0.1, 0.2), *arguments[4:6])
    np.testing.assert_array_equal(both[0], steps)
    np.testing.assert_array_equal(both[1], result)
