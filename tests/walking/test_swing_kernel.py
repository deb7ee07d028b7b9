"""The compiled reaction of the legs against the same in plain Python."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from walking import swing_kernel


@settings(max_examples=30)
@given(st.integers(0, 10**6), st.integers(0, 4))
def test_compiled_it_is_what_it_says(plainly, seed, count):
    rng = np.random.default_rng(seed)
    swings = rng.uniform(-0.1, 0.1, (count, 10))
    swings[:, 0] = np.arange(count) * 60 + rng.integers(-40, 20)
    profiles = (rng.normal(0.0, 100.0, (40, 6)), rng.normal(0.0, 100.0, (45, 6)))
    state, outcomes = rng.normal(0.0, 0.01, 4), []
    for call in (swing_kernel.react, lambda *a: plainly(swing_kernel, "react", *a)):
        own = state.copy()
        found = call(swings, *profiles, (7e-4, 0.012, 3e-4), own, (7.2, 0.005))
        outcomes.append([*np.ravel(found), *own])
    np.testing.assert_allclose(*outcomes, rtol=1e-12, atol=1e-15)


def test_compiled_a_profile_is_what_it_says(plainly):
    asked = (44, (1.04, 0.02, 0.02), 0.005)
    found, plain = swing_kernel.profile(*asked), plainly(swing_kernel, "profile", *asked)
    np.testing.assert_allclose(found, plain, rtol=1e-12, atol=1e-12)


def test_a_profile_is_that_of_minimum_jerk_and_a_smooth_bump():
    ticks, period = 44, 0.005
    table = swing_kernel.profile(ticks, (1.04, 0.02, 0.02), period)
    u = np.linspace(0.0, 1.0, ticks + 1)
    moved = np.polynomial.Polynomial([0, 0, 0, 10, -15, 6])
    height = np.polynomial.Polynomial([0, 4, -4]) ** 3
    square = (ticks * period) ** 2
    np.testing.assert_allclose(table[:, 3], moved.deriv(2)(u) / square, atol=1e-8)
    np.testing.assert_allclose(table[:, 4], height.deriv(2)(u) / square, atol=1e-8)
    np.testing.assert_allclose(table[:, 5], table[:, 4] * moved(u), atol=1e-8)
    assert (table[-1, :3] == 0.0).all()
