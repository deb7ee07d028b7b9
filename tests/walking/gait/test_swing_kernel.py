"""The compiled reaction of the legs against the same in plain Python."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from walking.gait import swing_kernel

ZMP_OFFSET = (0.01, 0.003)


def draw(seed, count):
    """A generator, and swings that begin with one under way: the arguments of `swings`."""
    rng = np.random.default_rng(seed)
    feet = rng.uniform(-0.3, 0.3, (3 + count, 4))
    feet[:, 3] = np.arange(3 + count) % 2
    support, origin, landing = map(tuple, feet[:3].tolist())
    now, later = (int(rng.integers(-40, 20)), 0.02, count > 0), (40, 68, 0.025)
    return rng, ((support, origin, landing), feet[3:], now, later, ZMP_OFFSET)


@settings(max_examples=30)
@given(st.integers(0, 10**6), st.integers(0, 4))
def test_compiled_it_is_what_it_says(plainly, seed, count):
    rng, swings = draw(seed, count)
    profiles = (rng.normal(0.0, 100.0, (40, 6)), rng.normal(0.0, 100.0, (45, 6)))
    law = np.array([7e-4, 0.012, 3e-4, 7.2, 0.005])
    state, outcomes = rng.normal(0.0, 0.01, 4), []
    for call in (swing_kernel.react, lambda *a: plainly(swing_kernel, "react", *a)):
        own = state.copy()
        result = call(*swings, *profiles, law, own)
        outcomes.append([*np.ravel(result), *own])
    np.testing.assert_allclose(*outcomes, rtol=1e-12, atol=1e-15)


@settings(max_examples=20)
@given(st.integers(0, 10**6), st.integers(1, 4))
def test_compiled_the_swings_are_what_they_say(plainly, seed, count):
    arguments = draw(seed, count)[1]
    result = swing_kernel.swings(*arguments)
    np.testing.assert_allclose(result, plainly(swing_kernel, "swings", *arguments), atol=1e-15)


def test_every_foot_swings_from_where_it_stands_to_where_it_stands_next():
    feet, steps, _, later, zmp_offset = draw(4, 4)[1]
    support, origin, landing = feet
    table = swing_kernel.swings(feet, steps, (-3, 0.02, True), later, zmp_offset)
    assert table[:, 0].tolist() == [-3.0, 40.0, 108.0, 176.0]
    assert table[:, 1].tolist() == [0.02, 0.025, 0.025, 0.025]
    starts, goals = [origin, support, landing, *steps[1:]], [landing, *steps[1:]]
    np.testing.assert_array_equal(table[:, 2:5], np.array(starts)[:4, :3])
    np.testing.assert_array_equal(table[:, 5:8], np.array(goals)[:, :3])
    for row, (x, y, yaw, left) in zip(table, [support, landing, *steps[1:]], strict=False):
        under = complex(x, y) + np.exp(1j * yaw) * complex(
            ZMP_OFFSET[0], ZMP_OFFSET[1] * (1.0 - 2.0 * left)
        )
        assert complex(*row[8:]) == pytest.approx(under, abs=1e-15)
    held = swing_kernel.swings(feet, steps, (-3, 0.02, False), later, zmp_offset)
    np.testing.assert_array_equal(held, table[1:])


def test_compiled_a_profile_is_what_it_says(plainly):
    arguments = (44, (1.04, 0.02, 0.02), 0.005)
    result, plain = swing_kernel.profile(*arguments), plainly(swing_kernel, "profile", *arguments)
    np.testing.assert_allclose(result, plain, rtol=1e-12, atol=1e-12)


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
