"""Bounds of a value."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from walking.clamp import clamp
from walking.dead_zone import dead_zone

VALUE, MOST = st.floats(-10.0, 10.0), st.floats(0.0, 5.0)


@given(VALUE, MOST)
def test_a_value_within_the_bound_is_kept_and_no_other(value, most):
    assert (clamp(value, most) == value) == (abs(value) <= most)
    assert abs(clamp(value, most)) <= most
    assert clamp(-value, most) == -clamp(value, most)


@given(VALUE, MOST)
def test_a_dead_zone_leaves_what_the_bound_takes_off(value, most):
    assert clamp(value, most) + dead_zone(value, most) == pytest.approx(value, abs=1e-12)
