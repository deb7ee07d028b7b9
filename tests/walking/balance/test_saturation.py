"""Dead zone."""

from hypothesis import given
from hypothesis import strategies as st

from walking.balance.saturation import beyond


@given(st.floats(-10.0, 10.0), st.floats(0.0, 5.0))
def test_dead_zone_is_odd_and_takes_away_at_most_the_zone(value, zone):
    rest = beyond(value, zone)
    assert rest == -beyond(-value, zone)
    assert abs(rest) == max(0.0, abs(value) - zone)
