"""Saturation and dead zone."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from walking.clamp import clamp, dead_zone

VALUE, LIMIT = st.floats(-10.0, 10.0), st.floats(0.0, 5.0)


@given(VALUE, LIMIT)
def test_only_a_value_within_the_limit_is_kept(value, limit):
    assert (clamp(value, limit) == value) == (abs(value) <= limit)
    assert abs(clamp(value, limit)) <= limit
    assert clamp(-value, limit) == -clamp(value, limit)


@given(VALUE, LIMIT)
def test_clamped_value_and_excess_add_up(value, limit):
    assert clamp(value, limit) + dead_zone(value, limit) == pytest.approx(value, abs=1e-12)
    assert dead_zone(-value, limit) == -dead_zone(value, limit)
