"""The compiled kinematics of a tick against the same in plain Python and in numpy."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from walking import leg_kernel

LEGS = ((0.0, 0.037, -0.02, 0.1, 0.1, 0.03), (0.0, -0.037, -0.02, 0.1, 0.1, 0.03))
LAW = (0.7, 0.019, 0.3, 0.85, 0.22)
SEEDS = st.integers(0, 10**6)


def draw(seed):
    rng = np.random.default_rng(seed)
    feet = tuple(
        (*rng.uniform(-0.05, 0.05, 2).tolist(), rng.uniform(-0.3, 0.3), abs(rng.normal(0.0, 0.01)))
        for _ in LEGS
    )
    return rng, feet


@settings(max_examples=30)
@given(SEEDS)
def test_compiled_the_posture_is_what_it_says(plainly, seed):
    rng, feet = draw(seed)
    which = (seed % 2, int(rng.integers(-1, 2)))
    com, head = (tuple(rng.uniform(-0.02, 0.02, 2).tolist()) for _ in range(2))
    tilts, tilt = rng.normal(0.0, 0.01, (2, 2)), tuple(rng.normal(0.0, 0.05, 2).tolist())
    outcomes = []
    for call in (leg_kernel.pose, lambda *a: plainly(leg_kernel, "pose", *a)):
        position, own = np.zeros(26), tilts.copy()
        build = (0.004, 2.0, 0.35)
        pelvis = call(position, own, feet, which, com, head, tilt, LAW, build, LEGS)
        outcomes.append([*position, *own.ravel(), *pelvis])
    np.testing.assert_allclose(*outcomes, rtol=0.0, atol=1e-12)


@given(st.floats(-1.0, 1.0))
def test_the_swing_of_the_arms_is_odd_and_limited(apart):
    swing = leg_kernel.arm_swing(apart, 2.0, 0.35)
    assert swing == -leg_kernel.arm_swing(-apart, 2.0, 0.35)
    assert abs(swing) <= 0.35


def test_the_left_arm_goes_back_when_the_left_foot_is_ahead():
    assert leg_kernel.arm_swing(0.05, 2.0, 0.35) > 0.0
