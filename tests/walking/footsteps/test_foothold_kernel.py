"""Chain of footholds against the planner."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
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
